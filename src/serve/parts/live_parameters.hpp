// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/serve/served_suit.hpp"
#include "dermis/stream/server.hpp"
#include "serve/topics/broadcaster.hpp"
#include "serve/recording/suit_recorder.hpp"
#include "serve/health/tares.hpp"

namespace dermis::serve {

/// The parameters of docs/stream.md. set() by one thread, the rest by any.
class LiveParameters {
 public:
  /// All must outlive it.
  LiveParameters(const ServedSuit& suit, live::LiveSuit& live, Broadcaster& broadcaster, SuitRecorder& recorder);

  [[nodiscard]] std::vector<stream::Parameter> all() const;

  /// Errors: an unknown name, a value that it cannot have; those of a recording.
  [[nodiscard]] Status set(const stream::Parameter& parameter, const std::string& client);

  [[nodiscard]] Tares& tares() noexcept { return tares_; }

 private:
  [[nodiscard]] Status set_number(const std::string& name, double value);
  [[nodiscard]] Status set_switch(const std::string& name, bool value, const std::string& client);
  [[nodiscard]] Status switch_recording(bool on);

  live::LiveSuit& live_;
  Broadcaster& broadcaster_;
  SuitRecorder& recorder_;
  Tares tares_;
};

}  // namespace dermis::serve
