// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

// Counts what this thread allocates, by taking the place of malloc and its relatives in the test binary: operator new,
// Eigen's and Highway's own allocators and the C library all end there. Weak, so that several sources may include it.
// Works with glibc; where a sanitizer owns malloc, kAllocationsAreCounted is false and tests skip with a message.

#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DERMIS_SANITIZER_OWNS_MALLOC 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define DERMIS_SANITIZER_OWNS_MALLOC 1
#endif
#endif

#if defined(__GLIBC__) && !defined(DERMIS_SANITIZER_OWNS_MALLOC)
#define DERMIS_COUNTS_ALLOCATIONS 1
#else
#define DERMIS_COUNTS_ALLOCATIONS 0
#endif

namespace dermis::support {

inline constexpr bool kAllocationsAreCounted = DERMIS_COUNTS_ALLOCATIONS == 1;
inline thread_local std::size_t allocations_of_this_thread = 0;

/// Allocations of this thread since it was made.
class AllocationGuard {
 public:
  [[nodiscard]] std::size_t count() const noexcept { return allocations_of_this_thread - start_; }

 private:
  std::size_t start_ = allocations_of_this_thread;
};

}  // namespace dermis::support

#if DERMIS_COUNTS_ALLOCATIONS
extern "C" {

// The C library's own names for what is replaced below; free() stays as it is.
void* __libc_malloc(std::size_t size) noexcept;                           // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;        // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* memory, std::size_t size) noexcept;            // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;  // NOLINT(bugprone-reserved-identifier)

[[gnu::weak]] void* malloc(std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_malloc(size);
}

[[gnu::weak]] void* calloc(std::size_t count, std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_calloc(count, size);
}

[[gnu::weak]] void* realloc(void* memory, std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_realloc(memory, size);
}

[[gnu::weak]] void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_memalign(alignment, size);
}

[[gnu::weak]] void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}

[[gnu::weak]] int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  void* const block = memalign(alignment, size);
  if (block == nullptr) return ENOMEM;
  *memory = block;
  return 0;
}

}  // extern "C"
#endif
