// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/ros_messages/touch_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bytes/ros_messages/cdr.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"

namespace dermis::bytes::ros_messages {
namespace {

// What other vendors' writers send: tests/live/buses/hands_test.py.

const TouchType& type_of(const std::string& name) {
  return **find_touch_type(name);
}

std::vector<TouchReading> readings_of(const TouchType& type) {
  return std::vector<TouchReading>(type.arrays.size());
}

float pressure_of(int module, int taxel) {
  return 100000.0F + 100.0F * static_cast<float>(module) + static_cast<float>(taxel);
}

std::vector<std::uint8_t> hand_state(std::uint32_t motors, std::uint32_t modules) {
  std::vector<std::uint8_t> message;
  CdrWriter writer(message);
  writer.write(motors);
  for (std::uint32_t k = 0; k < motors; ++k) {
    writer.write(std::uint8_t{1});
    for (int j = 0; j < 4; ++j) writer.write(0.5F);
    for (int j = 0; j < 2; ++j) writer.write(std::int16_t{30});
    writer.write(24.0F);
    for (int j = 0; j < 7; ++j) writer.write(std::uint32_t{7});
  }
  writer.write(modules);
  for (std::uint32_t k = 0; k < modules; ++k) {
    for (int j = 0; j < 12; ++j) writer.write(j == 11 ? 30000.0F : pressure_of(static_cast<int>(k), j));
    for (int j = 0; j < 12; ++j) writer.write(j == 11 ? 90.0F : 20.0F + static_cast<float>(j));
    for (int j = 0; j < 2; ++j) writer.write(std::uint32_t{0});
  }
  for (int j = 0; j < 13; ++j) writer.write(1.0F);
  writer.write(std::int16_t{40});
  for (int j = 0; j < 4; ++j) writer.write(24.0F);
  for (int j = 0; j < 4; ++j) writer.write(std::uint32_t{0});
  return message;
}

TEST(TouchMessages, modules_of_a_hand_have_pressures_and_the_mean_of_their_temperatures) {
  const TouchType& type = type_of("unitree_hg/msg/HandState");
  std::vector<TouchReading> readings = readings_of(type);
  ASSERT_EQ(readings.size(), 9U);
  ASSERT_TRUE(type.decode(hand_state(7, 9), readings));
  EXPECT_EQ(readings[8].shape, (FrameShape{3, 4}));
  EXPECT_EQ(readings[8].frame.counts[10], pressure_of(8, 10));
  EXPECT_TRUE(std::isnan(readings[8].frame.counts[11])) << "there is no sensor";
  EXPECT_DOUBLE_EQ(*readings[8].frame.temperature_celsius, 25.0) << "of 20 ... 30 C";
  ASSERT_EQ(readings[8].frame.sensor_celsius.size(), 12U);
  EXPECT_EQ(readings[8].frame.sensor_celsius[10], 30.0F);
  EXPECT_TRUE(std::isnan(readings[8].frame.sensor_celsius[11]));
}

TEST(TouchMessages, modules_that_a_message_lacks_have_no_shape) {
  const TouchType& type = type_of("unitree_hg/HandState");
  std::vector<TouchReading> readings = readings_of(type);
  ASSERT_TRUE(type.decode(hand_state(7, 9), readings));
  ASSERT_TRUE(type.decode(hand_state(7, 7), readings));
  EXPECT_EQ(readings[6].shape, (FrameShape{3, 4}));
  EXPECT_EQ(readings[7].shape, FrameShape{});
}

TEST(TouchMessages, regions_of_a_hand_have_1062_taxels) {
  const TouchType& type = type_of("inspire::inspire_hand_touch");
  std::vector<std::uint8_t> message;
  CdrWriter writer(message);
  std::int16_t value = 0;
  for (const TouchArray& array : type.arrays) {
    writer.write(static_cast<std::uint32_t>(array.shape.taxel_count()));
    for (std::size_t k = 0; k < array.shape.taxel_count(); ++k) writer.write(value++);
  }
  EXPECT_EQ(value, 1062);
  std::vector<TouchReading> readings = readings_of(type);
  ASSERT_TRUE(type.decode(message, readings));
  EXPECT_EQ(type.arrays.back().name, "palm");
  EXPECT_EQ(readings.back().frame.counts.front(), 950.0F);
  EXPECT_EQ(readings.back().frame.counts.back(), 1061.0F);
  message[4] = 8;
  EXPECT_EQ(type.decode(message, readings).error().message, "the message has 8 readings of little_tip, not 9");
}

TEST(TouchMessages, images_tell_their_shape_and_time) {
  std::vector<std::uint8_t> message;
  RawFrame frame;
  frame.time = Nanos(5'000'000'007);
  frame.counts = {1.0F, 2.0F, 3.0F, 4.5F, 5.0F, 6.0F};
  encode_image(frame, {2, 3}, "chest", message);
  const TouchType& type = type_of("sensor_msgs/msg/Image");
  std::vector<TouchReading> readings = readings_of(type);
  ASSERT_TRUE(type.decode(message, readings));
  EXPECT_EQ(readings.front().shape, (FrameShape{2, 3}));
  EXPECT_EQ(readings.front().frame.counts, frame.counts);
  EXPECT_EQ(readings.front().frame.acquisition.device_time, frame.time);
}

std::vector<std::uint8_t> float_array(const std::vector<std::uint32_t>& sizes, std::uint32_t values) {
  std::vector<std::uint8_t> message;
  CdrWriter writer(message);
  writer.write(static_cast<std::uint32_t>(sizes.size()));
  for (const std::uint32_t size : sizes) {
    writer.write_text("rows");
    writer.write(size);
    writer.write(std::uint32_t{1});
  }
  writer.write(std::uint32_t{0});
  writer.write(values);
  for (std::uint32_t k = 0; k < values; ++k) writer.write(0.5F * static_cast<float>(k));
  return message;
}

TEST(TouchMessages, arrays_of_floats_have_rows_and_columns) {
  const TouchType& type = type_of("std_msgs/msg/Float32MultiArray");
  std::vector<TouchReading> readings = readings_of(type);
  ASSERT_TRUE(type.decode(float_array({2, 3}, 6), readings));
  EXPECT_EQ(readings.front().shape, (FrameShape{2, 3}));
  EXPECT_EQ(readings.front().frame.counts[5], 2.5F);
  ASSERT_TRUE(type.decode(float_array({2, 3, 1}, 6), readings));
  EXPECT_EQ(readings.front().shape, (FrameShape{2, 3}));
  ASSERT_TRUE(type.decode(float_array({}, 6), readings));
  EXPECT_EQ(readings.front().shape, (FrameShape{1, 6}));
  EXPECT_EQ(type.decode(float_array({2, 4}, 6), readings).error().message,
            "the message has 6 values, which its dimensions do not give");
  ASSERT_TRUE(type.decode(float_array({}, 0), readings));  // some nodes begin with nothing
  EXPECT_EQ(readings.front().shape, FrameShape{});
}

TEST(TouchMessages, arrays_of_other_numbers_may_begin_behind_an_offset) {
  std::vector<std::uint8_t> message;
  CdrWriter writer(message);
  writer.write(std::uint32_t{0});
  writer.write(std::uint32_t{1});  // data_offset
  writer.write(std::uint32_t{4});
  for (const int value : {99, -1, 300, 5}) writer.write(static_cast<std::int16_t>(value));
  const TouchType& type = type_of("std_msgs/Int16MultiArray");
  std::vector<TouchReading> readings = readings_of(type);
  ASSERT_TRUE(type.decode(message, readings));
  EXPECT_EQ(readings.front().shape, (FrameShape{1, 3}));
  EXPECT_EQ(readings.front().frame.counts, (std::vector<float>{-1, 300, 5}));
  EXPECT_EQ(type_of("std_msgs/msg/UInt16MultiArray").dds_name, "std_msgs::msg::dds_::UInt16MultiArray_");
}

TEST(TouchMessages, no_bytes_are_trusted) {
  for (const TouchType& type : touch_types()) {
    std::vector<TouchReading> readings = readings_of(type);
    EXPECT_FALSE(type.decode({}, readings)) << type.name;
    for (const std::uint8_t filler : {std::uint8_t{0}, std::uint8_t{0xFF}}) {
      std::vector<std::uint8_t> message(40, filler);
      message[0] = 0;
      message[1] = 1;
      EXPECT_FALSE(type.decode(message, readings) && readings.front().shape != FrameShape{}) << type.name;
    }
  }
  const TouchType& hand = type_of("unitree_hg/msg/HandState");
  const std::vector<std::uint8_t> whole = hand_state(7, 9);
  std::vector<TouchReading> readings = readings_of(hand);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(hand.decode(std::span(whole).first(size), readings)) << size;
  }
}

TEST(TouchMessages, an_unknown_type_is_answered_with_the_nearest) {
  EXPECT_EQ(find_touch_type("sensor_msgs/msg/Imag").error().message,
            "type=sensor_msgs/msg/Imag: did you mean 'sensor_msgs/msg/Image'?");
  EXPECT_NE(find_touch_type("x").error().message.find("known are dermis_msgs/msg/RawFrame, inspire/"),
            std::string::npos);
}

}  // namespace
}  // namespace dermis::bytes::ros_messages
