// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>

#include "dermis/learn/calibration/parallel.hpp"

namespace dermis::paper {

/// Threads that are worth waking for so many multiply-adds. Measured on two cores: a frame of half a million parameters
/// (34 us) gains nothing from the second core. One of two million (118 us) takes 0.6 times as long.
[[nodiscard]] inline std::size_t worker_count(std::size_t multiply_adds) {
  constexpr std::size_t kWorthSharing = std::size_t{1} << 21U;
  return multiply_adds < kWorthSharing ? 1 : std::max(1U, std::thread::hardware_concurrency());
}

/// Calls body(item, worker) for all items. A worker, of which there are `workers`, takes one item after the other and
/// has its work space to itself. With one, allocates nothing.
template <class Body>
void share_among_workers(std::size_t items, std::size_t workers, const Body& body) {
  if (workers == 1) {
    for (std::size_t item = 0; item < items; ++item) body(item, std::size_t{0});
    return;
  }
  const std::size_t stride = std::max<std::size_t>(1, items / (16 * workers));
  std::atomic<std::size_t> next = 0;
  const auto work = [&](std::size_t worker) {
    for (std::size_t first = next.fetch_add(stride); first < items; first = next.fetch_add(stride)) {
      for (std::size_t item = first; item < std::min(first + stride, items); ++item) body(item, worker);
    }
  };
  learn::calibration::parallel_for(workers, std::ref(work));
}

}  // namespace dermis::paper
