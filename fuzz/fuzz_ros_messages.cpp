// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/bytes/ros_messages/touch_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace messages = dermis::messages;
  const std::span<const std::uint8_t> message(data, size);
  dermis::RawFrame frame;
  if (const auto shape = bytes::ros_messages::decode_tactile_state(message, frame)) {
    if (shape->taxel_count() != frame.counts.size()) std::abort();
  }
  if (const auto shape = bytes::ros_messages::decode_image(message, frame)) {
    if (frame.counts.size() != shape->taxel_count()) std::abort();
  }
  if (const auto shape = bytes::ros_messages::decode_raw_frame(message, frame)) {
    if (frame.counts.size() != shape->taxel_count()) std::abort();
  }
  static_cast<void>(bytes::ros_messages::decode_acquisition(message, frame));
  static_cast<void>(bytes::ros_messages::decode_temperature(message));
  if (bytes::ros_messages::JointNumbers joints; bytes::ros_messages::decode_joint_state(message, joints)) {
    if (joints.names.size() != joints.numbers.size()) std::abort();
  }
  for (const bytes::ros_messages::TouchType& type : bytes::ros_messages::touch_types()) {
    std::vector<bytes::ros_messages::TouchReading> readings(type.arrays.size());
    if (!type.decode(message, readings)) continue;
    for (const bytes::ros_messages::TouchReading& reading : readings) {
      if (reading.frame.counts.size() != reading.shape.taxel_count()) std::abort();
    }
  }
  return 0;
}
