// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/bytes/ros_messages/touch_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace messages = dermis::bytes::ros_messages;
  const std::span<const std::uint8_t> message(data, size);
  dermis::RawFrame frame;
  if (const auto shape = messages::decode_tactile_state(message, frame)) {
    if (shape->taxel_count() != frame.counts.size()) std::abort();
  }
  if (const auto shape = messages::decode_image(message, frame)) {
    if (frame.counts.size() != shape->taxel_count()) std::abort();
  }
  if (const auto shape = messages::decode_raw_frame(message, frame)) {
    if (frame.counts.size() != shape->taxel_count()) std::abort();
  }
  dermis::ForceFrame force;
  if (const auto shape = messages::decode_grid(message, force)) {
    if (force.newtons.size() != shape->taxel_count() || force.taxels.size() != shape->taxel_count()) std::abort();
  }
  static_cast<void>(messages::decode_mark(message));
  static_cast<void>(messages::decode_text(message));
  static_cast<void>(messages::decode_acquisition(message, frame));
  static_cast<void>(messages::decode_temperature(message));
  if (messages::JointNumbers joints; messages::decode_joint_state(message, joints)) {
    if (joints.names.size() != joints.numbers.size()) std::abort();
  }
  for (const messages::TouchType& type : messages::touch_types()) {
    std::vector<messages::TouchReading> readings(type.arrays.size());
    if (!type.decode(message, readings)) continue;
    for (const messages::TouchReading& reading : readings) {
      if (reading.frame.counts.size() != reading.shape.taxel_count()) std::abort();
    }
  }
  return 0;
}
