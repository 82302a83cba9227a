// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace dermis::support {

/// sensor_msgs/msg/JointState as ROS 2 serialises it. `quantities`: positions, velocities and efforts.
inline std::vector<std::uint8_t> joint_message(const std::vector<std::string>& names,
                                               const std::vector<std::vector<double>>& quantities) {
  std::vector<std::uint8_t> bytes;  // the encapsulation comes before them at the end
  const auto put = [&](auto number) {
    while (bytes.size() % sizeof number != 0) bytes.push_back(0);
    bytes.resize(bytes.size() + sizeof number);
    std::memcpy(bytes.data() + bytes.size() - sizeof number, &number, sizeof number);
  };
  const auto put_text = [&](const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
  };
  put(std::int32_t{7});
  put(std::uint32_t{9});
  put_text("base");
  put(static_cast<std::uint32_t>(names.size()));
  for (const std::string& name : names) put_text(name);
  for (const std::vector<double>& numbers : quantities) {
    put(static_cast<std::uint32_t>(numbers.size()));
    for (const double number : numbers) put(number);
  }
  bytes.insert(bytes.begin(), {0, 1, 0, 0});
  return bytes;
}

/// The same with positions alone.
inline std::vector<std::uint8_t> joint_message(const std::vector<std::pair<std::string, double>>& positions) {
  std::vector<std::string> names;
  std::vector<std::vector<double>> quantities(3);
  for (const auto& [name, position] : positions) {
    names.push_back(name);
    quantities.front().push_back(position);
  }
  return joint_message(names, quantities);
}

}  // namespace dermis::support
