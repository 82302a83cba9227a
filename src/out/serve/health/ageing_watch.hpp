// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>

#include "dermis/learn/health/ageing_monitor.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::serve {

/// Watches the calibration of each array while it works. Thread-safe: each array on a thread of its own.
class AgeingWatch {
 public:
  explicit AgeingWatch(const ServedSuit& suit);

  void add(const live::suits::ArrayResult& result);

  /// The evidence of touches since the array got its model.
  [[nodiscard]] learn::health::AgeingEvidence evidence(std::size_t array) const;

  /// The array has another model.
  void begin_anew(std::size_t array, const touch::pipeline::Model& model);

 private:
  struct Watched {
    mutable std::mutex mutex;
    learn::health::AgeingMonitor monitor;

    explicit Watched(const touch::pipeline::Model& model) : monitor(model) {}
  };

  std::deque<Watched> arrays_;
};

}  // namespace dermis::out::serve
