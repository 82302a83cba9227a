// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/parallel.hpp"

#if defined(__SANITIZE_THREAD__)
#include <algorithm>
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#endif

namespace dermis::learn::calibration {

#if defined(__SANITIZE_THREAD__)
// Debian's libtbb is not compiled with ThreadSanitizer, which so does not see how its threads wait for each other.
// Plain threads take its place. Neighbours run on different ones, so what they share is found.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  const std::size_t threads = std::min<std::size_t>(count, std::max(2U, std::thread::hardware_concurrency()));
  std::vector<std::jthread> workers;
  for (std::size_t first = 0; first < threads; ++first) {
    workers.emplace_back([=, &body] {
      for (std::size_t k = first; k < count; k += threads) body(k);
    });
  }
}
#else
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, count, body);
}
#endif

}  // namespace dermis::learn::calibration
