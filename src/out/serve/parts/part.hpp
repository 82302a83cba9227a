// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/learn/recognition/classes.hpp"
#include "dermis/live/fleet/robot_health.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// A parameter with its handlers. Clients can set it where one of the setters is there.
struct LiveParameter {
  std::string name;  ///< "/stream/rate_hz"
  std::function<websocket::ParameterValue()> value;
  std::function<Status(double)> set_number{};
  std::function<Status(bool, const std::string& client)> set_switch{};
};

/// One subject of the server in one place: its offers to clients, its use of frames, and its response to changes. Parts
/// know nothing of each other (Host). Ticks and requests each come from one thread, the frames of an array from one at
/// a time.
class Part {
 public:
  static constexpr int kTicksPerSecond = 30;

  Part() = default;
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;
  virtual ~Part() = default;

  /// The server asks for these once, before it begins.
  [[nodiscard]] virtual std::vector<websocket::Service> services() { return {}; }
  [[nodiscard]] virtual std::vector<LiveParameter> parameters() { return {}; }
  /// Does the rest of the work before clients come. Errors end the session.
  [[nodiscard]] virtual Status prepare() { return Done{}; }

  /// Takes every frame of every array when it has come, before it is processed.
  virtual void keep(std::size_t /*array*/, const RawFrame& /*frame*/) {}
  /// Takes every frame of every array with its results, but those for which the machine had no time.
  virtual void hear(const live::suits::ArrayResult& /*result*/) {}
  virtual void tick(std::int64_t /*tick*/) {}
  /// The array has another model, which is in Host::models.
  virtual void model_changed(std::size_t /*array*/) {}
  /// Classes for an array, from its next frame on. Errors: they do not fit.
  [[nodiscard]] virtual Status use_classes(std::size_t /*array*/, const learn::recognition::Classes& /*classes*/) {
    return Done{};
  }
  /// Adds the problems of the arrays.
  virtual void diagnose(std::vector<bytes::ros_messages::Diagnosis>& /*diagnoses*/) const {}
  /// Fills in what the part knows of the arrays, which are all there.
  virtual void report(live::fleet::RobotHealth& /*health*/) const {}
  /// After the last frame.
  virtual void finish() {}
};

}  // namespace dermis::out::serve
