// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>

#include "dermis/health/ageing_monitor.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/serve/served_suit.hpp"

namespace dermis::serve {

/// Watches the calibration of each array while it works. Thread-safe: each array on a thread of its own.
class AgeingWatch {
 public:
  explicit AgeingWatch(const ServedSuit& suit);

  void add(const live::ArrayResult& result);

  /// The evidence of touches since the array got its model.
  [[nodiscard]] health::AgeingEvidence evidence(std::size_t array) const;

  /// The array has another model.
  void begin_anew(std::size_t array, const pipeline::Model& model);

 private:
  struct Watched {
    mutable std::mutex mutex;
    health::AgeingMonitor monitor;

    explicit Watched(const pipeline::Model& model) : monitor(model) {}
  };

  std::deque<Watched> arrays_;
};

}  // namespace dermis::serve
