// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>

namespace dermis::bytes::ros_messages {

/// sensor_msgs/PointField.
enum class PointFieldType : std::uint8_t { int8 = 1, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PointField {
  const char* name;
  std::uint32_t offset;
  PointFieldType type;
};

}  // namespace dermis::bytes::ros_messages
