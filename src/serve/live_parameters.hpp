// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/serve/served_suit.hpp"
#include "dermis/stream/server.hpp"
#include "serve/broadcaster.hpp"
#include "serve/suit_recorder.hpp"
#include "serve/tare_log.hpp"

namespace dermis::serve {

/// The parameters of docs/stream.md. set() by one thread, the rest by any.
class LiveParameters {
 public:
  /// All must outlive it.
  LiveParameters(const ServedSuit& suit, live::LiveSuit& live, Broadcaster& broadcaster, SuitRecorder& recorder);

  [[nodiscard]] std::vector<stream::Parameter> all() const;

  /// Errors: an unknown name, a value that it cannot have; those of a recording.
  [[nodiscard]] Status set(const stream::Parameter& parameter);
  /// Says who has set a tare; returns the line for others.
  std::string log_tare(const stream::Parameter& tare, const std::string& who);

  /// The array has another model, which begins at its own zero.
  void forget_tare(std::size_t array) { tared_[array] = false; }

 private:
  [[nodiscard]] Status set_number(const std::string& name, double value);
  [[nodiscard]] Status set_switch(const std::string& name, bool value);
  [[nodiscard]] Status set_tare(const std::string& name, bool value);
  [[nodiscard]] Status switch_recording(bool on);

  const ServedSuit& suit_;
  live::LiveSuit& live_;
  Broadcaster& broadcaster_;
  SuitRecorder& recorder_;
  std::vector<std::atomic<bool>> tared_;  // Of each array.
  TareLog tare_log_;
};

}  // namespace dermis::serve
