// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Messages of others that hold readings of tactile arrays, such as those of robot hands (docs/hands.md).
namespace dermis::bytes::ros_messages {

/// One of the arrays in such a message.
struct TouchArray {
  std::string name;    ///< Empty where it is the only one.
  FrameShape shape{};  ///< 0x0: each message tells it.
};

/// The readings of one array in one message.
struct TouchReading {
  FrameShape shape{};  ///< 0x0: the message does not hold the array.
  RawFrame frame{};    ///< Counts, temperature and, where the message has it, device_time. All where it is a RawFrame.
};

/// A type of such messages.
struct TouchType {
  std::string name;      ///< "unitree_hg/msg/HandState"
  std::string dds_name;  ///< "unitree_hg::msg::dds_::HandState_"
  std::vector<TouchArray> arrays;
  /// Reads any bytes as a message in CDR. `readings`: one for each array. Errors name the problem, but no place.
  Status (*decode)(std::span<const std::uint8_t> message, std::span<TouchReading> readings);
  bool is_raw_frame = false;  ///< Messages are frames of another dermis, with their times and numbers.
};

/// unitree_hg/msg/HandState, inspire/inspire_hand_touch, dermis_msgs/msg/RawFrame, sensor_msgs/msg/Image, and
/// std_msgs/msg/Float32MultiArray, UInt16MultiArray and those of all other numbers of 8 to 32 bits and Float64.
[[nodiscard]] const std::vector<TouchType>& touch_types();

/// By its name, also without "/msg", or by its name in DDS. Fails on others, with the names that are known.
[[nodiscard]] Result<const TouchType*> find_touch_type(std::string_view name);

}  // namespace dermis::bytes::ros_messages
