// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "support/allocation_guard.hpp"

#include <cerrno>

namespace dermis::support {
namespace {

thread_local std::size_t allocations_of_this_thread = 0;

}  // namespace

AllocationGuard::AllocationGuard() noexcept : start_(allocations_of_this_thread) {}

std::size_t AllocationGuard::count() const noexcept {
  return allocations_of_this_thread - start_;
}

}  // namespace dermis::support

#if DERMIS_COUNTS_ALLOCATIONS
extern "C" {

// The C library's own names for what is replaced below; free() stays as it is.
void* __libc_malloc(std::size_t size) noexcept;                           // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;        // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* memory, std::size_t size) noexcept;            // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;  // NOLINT(bugprone-reserved-identifier)

void* malloc(std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++dermis::support::allocations_of_this_thread;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  void* const block = memalign(alignment, size);
  if (block == nullptr) return ENOMEM;
  *memory = block;
  return 0;
}

}  // extern "C"
#endif
