// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

// Counts what this thread allocates, by taking the place of malloc and its relatives in the test binary: operator new,
// Eigen's and Highway's own allocators and the C library all end there. Works with glibc; where a sanitizer owns
// malloc, kAllocationsAreCounted is false and tests skip with a message.

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

/// Allocations of this thread since it was made. Not inline: g++ takes it that malloc changes no variable.
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  [[nodiscard]] std::size_t count() const noexcept;

 private:
  std::size_t start_;
};

}  // namespace dermis::support
