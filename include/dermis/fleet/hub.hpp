// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/fleet/stream_address.hpp"

namespace dermis::fleet {

class Broker;

/// The frames of a robot on the hub.
struct RobotState {
  std::string name;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  Nanos last{};           ///< The last message arrived then at the robot's server, by UTC; 0: none did.
  std::uint64_t lag = 0;  ///< Messages that the robot's server has and the hub not yet, as far as the hub knows.
};

/// The server that has copies of the streams of all robots. Thread-safe.
class Hub {
 public:
  /// Fails where the plugin is not there, and where no server answers.
  [[nodiscard]] static Result<std::unique_ptr<Hub>> connect(const BrokerAddress& address);
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;
  ~Hub();

  /// From now on the hub copies all that the robot's server has and gets. A robot that is there stays.
  [[nodiscard]] Status add_robot(const std::string& name);
  [[nodiscard]] Result<std::vector<RobotState>> robots();

 private:
  explicit Hub(std::unique_ptr<Broker> broker);
  std::unique_ptr<Broker> broker_;
};

}  // namespace dermis::fleet
