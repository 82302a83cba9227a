// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/ros_messages/ros_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "bytes/ros_messages/read_by_definition.hpp"
#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/joint_messages.hpp"
#include "support/simd_targets.hpp"

namespace dermis::bytes::ros_messages {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <typename T>
bool has_same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

RawFrame frame_of(std::vector<float> counts, Nanos time = Nanos(1'700'000'000'123'456'789)) {
  RawFrame frame;
  frame.time = time;
  frame.counts = std::move(counts);
  return frame;
}

/// The text of an Image's encoding stands behind stamp, frame_id, height and width.
bool holds(const Bytes& message, const std::string& text) {
  return std::search(message.begin(), message.end(), text.begin(), text.end()) != message.end();
}

TEST(Image, is_laid_out_as_ros_lays_it_out) {
  Bytes message;
  encode_image(frame_of({1, 2, 258, 4, 5, 65535}, Nanos(7'000'000'009)), {2, 3}, "a", message);
  const Bytes expected{
      0, 1, 0, 0,                                                                    //
      7, 0, 0, 0, 9,  0, 0, 0, 2, 0, 0, 0, 'a', 0,   0,   0,                         // stamp, frame_id
      2, 0, 0, 0, 3,  0, 0, 0, 6, 0, 0, 0, '1', '6', 'U', 'C', '1', 0, 0,    0,      // height, width, encoding
      6, 0, 0, 0, 12, 0, 0, 0, 1, 0, 2, 0, 2,   1,   4,   0,   5,   0, 0xFF, 0xFF};  // step, data
  EXPECT_EQ(message, expected);
}

TEST(Image, all_counts_read_back_with_their_bits) {
  support::for_each_simd_target([] {
    Random random(1);
    for (std::size_t size = 1; size < 200; ++size) {
      std::vector<float> counts(size);
      for (float& count : counts) count = static_cast<float>(random.below(65536));
      counts[random.below(size)] = random.below(2) == 0 ? 65535.0F : 0.0F;
      const RawFrame frame = frame_of(counts);
      Bytes message;
      encode_image(frame, {1, size}, "array", message);
      EXPECT_TRUE(holds(message, "16UC1"));
      RawFrame again;
      const Result<FrameShape> shape = decode_image(message, again);
      ASSERT_TRUE(shape);
      EXPECT_EQ(*shape, (FrameShape{1, size}));
      EXPECT_TRUE(has_same_bits(again.counts, counts));
      EXPECT_EQ(again.time, frame.time);
    }
  });
}

TEST(Image, one_count_that_is_no_word_makes_all_floats) {
  const auto signalling = std::bit_cast<float>(0x7FA00001U);
  for (const float odd : {kNan, -kNan, signalling, kInfinity, -kInfinity, -0.0F, -1.0F, 0.5F, 65535.5F, 65536.0F, 3e9F,
                          -3e9F, 1e-45F, 4294967296.0F}) {
    support::for_each_simd_target([odd] {
      for (const std::size_t size : {1U, 3U, 16U, 33U, 67U}) {
        for (std::size_t place = 0; place < size; ++place) {
          std::vector<float> counts(size, 4095.0F);
          counts[place] = odd;
          Bytes message;
          encode_image(frame_of(counts), {size, 1}, "array", message);
          EXPECT_TRUE(holds(message, "32FC1"));
          RawFrame again;
          ASSERT_TRUE(decode_image(message, again));
          EXPECT_TRUE(has_same_bits(again.counts, counts)) << odd;
        }
      }
    });
  }
}

TEST(Image, values_of_taxels_keep_their_bits) {
  const std::vector<float> newtons = {
      0.5F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.0F, 1e-30F, 7.0F};
  Bytes message;
  encode_value_image(newtons, Nanos(7), {2, 3}, "pad", message);
  EXPECT_TRUE(holds(message, "32FC1"));
  RawFrame frame;
  EXPECT_EQ(decode_image(message, frame).value(), (FrameShape{2, 3}));
  EXPECT_EQ(frame.time, Nanos(7));
  EXPECT_TRUE(has_same_bits(frame.counts, newtons));
}

TEST(Image, times_beyond_a_stamp_take_its_ends) {
  const auto stamp_of = [](Nanos time) {
    Bytes message;
    encode_image(frame_of({1}, time), {1, 1}, "", message);
    RawFrame again;
    EXPECT_TRUE(decode_image(message, again));
    return again.time;
  };
  EXPECT_EQ(stamp_of(Nanos(-1)), Nanos(-1));
  EXPECT_EQ(stamp_of(Nanos(0)), Nanos(0));
  EXPECT_EQ(stamp_of(Nanos::max()), Nanos(2'147'483'647'999'999'999));
  EXPECT_EQ(stamp_of(Nanos::min()), Nanos(-2'147'483'648'000'000'000));
}

Bytes image_with(const char* encoding, std::uint8_t is_bigendian, std::uint32_t height, std::uint32_t width,
                 std::uint32_t step, const Bytes& data);

TEST(Image, decodes_big_endian_and_padded_rows) {
  RawFrame frame;
  ASSERT_TRUE(decode_image(image_with("mono16", 1, 2, 2, 5, {1, 2, 0, 3, 99, 0, 4, 255, 255, 99}), frame));
  EXPECT_EQ(frame.counts, (std::vector<float>{258, 3, 4, 65535}));
  ASSERT_TRUE(decode_image(image_with("32FC1", 1, 1, 1, 4, {0x3F, 0x80, 0, 0}), frame));
  EXPECT_EQ(frame.counts, std::vector<float>{1.0F});
}

TEST(Image, decodes_every_number_of_one_channel) {
  RawFrame frame;
  ASSERT_TRUE(decode_image(image_with("mono8", 0, 1, 2, 2, {0, 255}), frame));
  EXPECT_EQ(frame.counts, (std::vector<float>{0, 255}));
  ASSERT_TRUE(decode_image(image_with("16SC1", 0, 1, 2, 4, {0xFF, 0xFF, 0, 0x80}), frame));
  EXPECT_EQ(frame.counts, (std::vector<float>{-1, -32768}));
  ASSERT_TRUE(decode_image(image_with("64FC1", 1, 1, 1, 8, {0x3F, 0xF8, 0, 0, 0, 0, 0, 0}), frame));
  EXPECT_EQ(frame.counts, std::vector<float>{1.5F});
}

TEST(Image, what_is_no_image_is_refused) {
  RawFrame frame;
  const auto refusal = [&](const Bytes& message) {
    const Result<FrameShape> decoded = decode_image(message, frame);
    return decoded ? std::string("decoded") : decoded.error().message;
  };
  EXPECT_NE(refusal(image_with("rgb8", 0, 1, 1, 3, {1, 2, 3})).find("rgb8"), std::string::npos);
  EXPECT_NE(refusal(image_with("16UC1", 0, 0, 1, 2, {})).find("0x1"), std::string::npos);
  EXPECT_NE(refusal(image_with("16UC1", 0, 1, 0, 0, {})).find("1x0"), std::string::npos);
  EXPECT_NE(refusal(image_with("16UC1", 0, 1025, 1, 2, Bytes(2050))).find("1025x1"), std::string::npos);
  EXPECT_NE(refusal(image_with("16UC1", 0, 2, 2, 4, Bytes(7))).find("shorter"), std::string::npos);
  EXPECT_NE(refusal(image_with("16UC1", 0, 2, 2, 3, Bytes(8))).find("shorter"), std::string::npos);
  EXPECT_NE(refusal(image_with("16UC1", 0, 2, 2, 0xFFFFFFFF, Bytes(8))).find("shorter"), std::string::npos);
  EXPECT_NE(refusal({}).find("no whole"), std::string::npos);
}

TEST(Temperature, reads_back) {
  for (const double celsius : {23.456, -40.0, 0.0}) {
    Bytes message;
    encode_temperature(celsius, Nanos(5), "array", message);
    const Result<double> again = decode_temperature(message);
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, celsius);
  }
  EXPECT_FALSE(decode_temperature(Bytes{0, 1, 0, 0}));
}

RawFrame random_frame(std::size_t taxels, Random& random) {
  RawFrame frame;
  frame.time = Nanos(static_cast<std::int64_t>(random.bits()));
  if (random.below(2) == 0) frame.acquisition.sequence = random.bits();
  if (random.below(2) == 0) frame.acquisition.device_time = Nanos(static_cast<std::int64_t>(random.bits()));
  frame.acquisition.arrival_steady = Nanos(static_cast<std::int64_t>(random.bits()));
  frame.acquisition.arrival_utc = Nanos(static_cast<std::int64_t>(random.bits()));
  frame.acquisition.lost_before = static_cast<std::uint32_t>(random.bits());
  frame.acquisition.held_taxels = static_cast<std::uint32_t>(random.bits());
  if (random.below(2) == 0) frame.supply_v = random.normal();
  if (random.below(2) == 0) frame.temperature_celsius = random.normal();
  for (std::size_t k = random.below(4); k > 0; --k) frame.sensor_celsius.push_back(static_cast<float>(random.normal()));
  for (std::size_t i = 0; i < taxels; ++i) {
    frame.counts.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random.bits())));
  }
  return frame;
}

TEST(AcquisitionMessage, every_field_reads_back) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const RawFrame frame = random_frame(0, random);
    Bytes message;
    encode_acquisition(frame, message);
    RawFrame again;
    again.supply_v = 1.0;
    again.acquisition.sequence = 1;
    again.acquisition.device_time = Nanos(1);
    ASSERT_TRUE(decode_acquisition(message, again));
    EXPECT_EQ(again.acquisition, frame.acquisition);
    EXPECT_EQ(again.time, frame.time);
    EXPECT_EQ(again.supply_v, frame.supply_v);
  }
}

TEST(RawFrameMessage, every_field_reads_back_with_its_bits) {
  Random random(3);
  for (std::size_t i = 0; i < 300; ++i) {
    const FrameShape shape{1 + i % 7, 1 + i % 13};
    const RawFrame frame = random_frame(shape.taxel_count(), random);
    Bytes message;
    encode_raw_frame(frame, shape, "chest", message);
    RawFrame again = random_frame(3, random);
    EXPECT_EQ(decode_raw_frame(message, again).value(), shape);
    EXPECT_TRUE(has_same_bits(again.counts, frame.counts));
    EXPECT_EQ(again.time, frame.time);
    EXPECT_EQ(again.acquisition, frame.acquisition);
    EXPECT_EQ(again.supply_v, frame.supply_v);
    EXPECT_EQ(again.temperature_celsius, frame.temperature_celsius);
    EXPECT_EQ(again.sensor_celsius, frame.sensor_celsius);
  }
}

TEST(RawFrameMessage, one_whose_counts_are_not_its_taxels_is_refused) {
  Bytes message;
  encode_raw_frame(frame_of({1, 2, 3, 4, 5, 6}), {2, 3}, "chest", message);
  RawFrame frame;
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_FALSE(decode_raw_frame(std::span(message).first(size), frame)) << size;
  }
  constexpr std::size_t kBehindRows = 4 + 4 + 6 * 4;  // columns, number of counts, counts
  message[message.size() - kBehindRows - 4] = 3;
  EXPECT_EQ(decode_raw_frame(message, frame).error().message,
            "the message has 6 counts of 3x3 taxels; all of 1x1 to 1024x1024 can be read");
}

TEST(RawFrameMessage, one_with_more_temperatures_than_an_array_may_have_is_refused) {
  const auto decoded = [](const FrameShape& shape, std::size_t sensors) {
    RawFrame frame = frame_of(std::vector<float>(shape.taxel_count(), 1.0F));
    frame.sensor_celsius.assign(sensors, 20.0F);
    Bytes message;
    encode_raw_frame(frame, shape, "chest", message);
    return decode_raw_frame(message, frame);
  };
  EXPECT_TRUE(decoded({2, 3}, 64));
  EXPECT_TRUE(decoded({10, 10}, 100)) << "one of each taxel";
  for (const std::size_t sensors : {65U, 99U, 2'000'000U}) {
    EXPECT_EQ(decoded({10, 10}, sensors).error().message, "the message has " + std::to_string(sensors) +
                                                              " temperatures; 64 of an array, or one of each taxel, "
                                                              "can be read");
  }
}

ForceFrame random_forces(std::size_t taxel_count, std::uint64_t seed) {
  Random random(seed);
  ForceFrame frame;
  frame.time = Nanos(1'000'000'007);
  frame.status = FrameStatus::saturated | FrameStatus::supply_implausible;
  for (std::size_t i = 0; i < taxel_count; ++i) {
    frame.newtons.push_back(random.below(5) == 0 ? kNan : static_cast<float>(random.uniform(0.0, 40.0)));
    frame.sigma_newtons.push_back(random.below(5) == 0 ? kInfinity : static_cast<float>(random.uniform(0.0, 1.0)));
    frame.taxels.push_back(static_cast<TaxelStatus>(random.below(6)));
  }
  return frame;
}

/// The fields of the cells, as the message places them.
template <typename T>
std::vector<T> cells_of(const nlohmann::json& grid, const std::string& name) {
  const auto bytes = grid.at("data").get<Bytes>();
  const auto stride = grid.at("cell_stride").get<std::size_t>();
  std::size_t offset = stride;
  for (const auto& field : grid.at("fields")) {
    if (field.at("name") == name) offset = field.at("offset");
  }
  std::vector<T> values(bytes.size() / stride);
  for (std::size_t i = 0; i < values.size(); ++i) std::memcpy(&values[i], &bytes.at(i * stride + offset), sizeof(T));
  return values;
}

TEST(Grid, holds_forces_with_their_bits) {
  for (const FrameShape shape : {FrameShape{1, 1}, {3, 5}, {64, 160}}) {
    const ForceFrame frame = random_forces(shape.taxel_count(), 3);
    Bytes message;
    encode_grid(frame, shape, {0.005, 0.004}, "array", message);
    const nlohmann::json grid = read_by_definition(grid_type(), message);
    EXPECT_EQ(grid.at("timestamp"), nlohmann::json({{"sec", 1}, {"nanosec", 7}}));
    EXPECT_EQ(grid.at("column_count"), shape.cols);
    EXPECT_EQ(grid.at("row_stride"), 9 * shape.cols);
    EXPECT_EQ(grid.at("cell_size"), nlohmann::json({{"x", 0.004}, {"y", 0.005}}));
    EXPECT_TRUE(has_same_bits(cells_of<float>(grid, "newtons"), frame.newtons));
    EXPECT_TRUE(has_same_bits(cells_of<float>(grid, "sigma_newtons"), frame.sigma_newtons));
    EXPECT_EQ(cells_of<TaxelStatus>(grid, "status"), frame.taxels);
    encode_frame_status(frame, message);
    EXPECT_EQ(read_by_definition(frame_status_type(), message),
              nlohmann::json({{"time_ns", 1'000'000'007}, {"status", static_cast<std::uint16_t>(frame.status)}}));
  }
}

TEST(Messages, any_damage_is_a_value_or_an_error) {
  RawFrame raw = frame_of({1, 2, 3, 4, 5, 6});
  std::vector<Bytes> messages(4);
  encode_image(raw, {2, 3}, "array", messages[0]);
  encode_acquisition(raw, messages[1]);
  encode_temperature(20.0, Nanos(1), "array", messages[2]);
  encode_raw_frame(raw, {2, 3}, "array", messages[3]);
  Random random(5);
  RawFrame frame;
  for (int i = 0; i < 20000; ++i) {
    Bytes message = messages[random.below(messages.size())];
    for (int k = 0; k < 3; ++k) message[random.below(message.size())] = static_cast<std::uint8_t>(random.bits());
    message.resize(random.below(message.size() + 1));
    if (const auto shape = decode_image(message, frame)) {
      ASSERT_EQ(frame.counts.size(), shape->taxel_count());
    }
    if (const auto shape = decode_raw_frame(message, frame)) {
      ASSERT_EQ(frame.counts.size(), shape->taxel_count());
    }
    static_cast<void>(decode_acquisition(message, frame));
    static_cast<void>(decode_temperature(message));
  }
}

TEST(Messages, a_warm_buffer_is_reused) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  const FrameShape shape{64, 160};
  const ForceFrame forces = random_forces(shape.taxel_count(), 6);
  const RawFrame raw = frame_of(std::vector<float>(shape.taxel_count(), 17.0F));
  Bytes message;
  RawFrame again;
  const auto use_all = [&] {
    encode_temperature(20.0, Nanos(1), "array", message);
    encode_acquisition(raw, message);
    encode_grid(forces, shape, {}, "array", message);
    encode_image(raw, shape, "array", message);
    EXPECT_TRUE(decode_image(message, again));
    encode_raw_frame(raw, shape, "array", message);
    EXPECT_TRUE(decode_raw_frame(message, again));
  };
  use_all();
  const support::AllocationGuard guard;
  use_all();
  EXPECT_EQ(guard.count(), 0U);
}

TEST(MessageTypes, definitions_name_every_type_that_they_use) {
  for (const MessageType* type : {&image_type(), &temperature_type(), &grid_type(), &acquisition_type(),
                                  &frame_status_type(), &raw_frame_type()}) {
    std::size_t begin = 0;
    while (begin < type->definition.size()) {
      const std::size_t end = type->definition.find('\n', begin);
      ASSERT_NE(end, std::string::npos);
      const std::string line = type->definition.substr(begin, end - begin);
      begin = end + 1;
      std::string used = line.substr(0, line.find_first_of(" ["));
      if (used.find('/') == std::string::npos) continue;
      EXPECT_NE(type->definition.find("\nMSG: " + used + "\n"), std::string::npos) << line;
    }
  }
}

Bytes tactile_state(const std::vector<std::vector<float>>& sensors) {
  Bytes message;
  CdrWriter writer(message);
  writer.write(std::int32_t{7});
  writer.write(std::uint32_t{9});
  writer.write_text("hand");
  writer.write(static_cast<std::uint32_t>(sensors.size()));
  for (const std::vector<float>& values : sensors) {
    writer.write_text("tip");
    writer.write(static_cast<std::uint32_t>(values.size()));
    for (const float value : values) writer.write(value);
  }
  return message;
}

TEST(TactileState, sensors_of_as_many_values_are_rows) {
  RawFrame frame;
  EXPECT_EQ(decode_tactile_state(tactile_state({{1, 2, 3}, {4, 5, 0.5F}}), frame).value(), (FrameShape{2, 3}));
  EXPECT_EQ(frame.counts, (std::vector<float>{1, 2, 3, 4, 5, 0.5F}));
  EXPECT_EQ(frame.time, Nanos(7'000'000'009));
  EXPECT_EQ(decode_tactile_state(tactile_state({{1, 2, 3}, {4}}), frame).value(), (FrameShape{1, 4}));
  EXPECT_EQ(frame.counts, (std::vector<float>{1, 2, 3, 4}));
}

TEST(TactileState, one_that_is_cut_or_has_no_value_is_refused) {
  RawFrame frame;
  const Bytes whole = tactile_state({{1, 2}, {3, 4}});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode_tactile_state(std::span(whole).first(size), frame).error().message,
              "the message is no whole tactile_msgs/msg/TactileState in CDR");
  }
  EXPECT_EQ(decode_tactile_state(tactile_state({}), frame).error().message,
            "the sensors have 0x0 values; 1x1 to 1024x1024 can be read");
}

TEST(JointState, has_positions_or_else_velocities_or_efforts) {
  JointNumbers joints;
  ASSERT_TRUE(decode_joint_state(support::joint_message({"elbow", "wrist"}, {{0.5, -1}, {2, 3}, {4, 5}}), joints));
  EXPECT_EQ(joints.names, (std::vector<std::string>{"elbow", "wrist"}));
  EXPECT_EQ(joints.numbers, (std::vector<double>{0.5, -1}));
  ASSERT_TRUE(decode_joint_state(support::joint_message({"elbow"}, {{}, {2}, {4}}), joints));
  EXPECT_EQ(joints.numbers, (std::vector<double>{2}));
  ASSERT_TRUE(decode_joint_state(support::joint_message({"elbow"}, {{}, {}, {4}}), joints));
  EXPECT_EQ(joints.numbers, (std::vector<double>{4}));
  ASSERT_TRUE(decode_joint_state(support::joint_message({"elbow"}, {{}, {}, {}}), joints));
  EXPECT_TRUE(joints.names.empty());
  EXPECT_TRUE(joints.numbers.empty());
}

TEST(JointState, one_that_is_cut_or_has_other_numbers_than_names_is_refused) {
  JointNumbers joints;
  const Bytes whole = support::joint_message({"elbow"}, {{0.5}, {}, {}});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode_joint_state(std::span(whole).first(size), joints).error().message,
              "the message is no whole sensor_msgs/msg/JointState in CDR");
  }
  EXPECT_EQ(decode_joint_state(support::joint_message({"elbow"}, {{1, 2}, {}, {}}), joints).error().message,
            "the message names 1 joints and has numbers of 2");
}

/// As ROS 2 prints them ("ros2 topic info --verbose"), from recordings and programs of others.
TEST(MessageTypes, hashes_are_those_of_ros) {
  EXPECT_STREQ(image_type().hash, "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47");
  EXPECT_STREQ(point_cloud_type().hash, "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5");
  EXPECT_STREQ(transforms_type().hash, "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087");
  EXPECT_STREQ(diagnostics_type().hash, "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e");
  EXPECT_STREQ(wrench_type().hash, "RIHS01_8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77");
}

void put(Bytes& bytes, std::uint32_t value) {
  while ((bytes.size() - 4) % 4 != 0) bytes.push_back(0);
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8U * static_cast<unsigned>(i))));
}

/// Written by hand, from the definition of the message.
Bytes image_with(const char* encoding, std::uint8_t is_bigendian, std::uint32_t height, std::uint32_t width,
                 std::uint32_t step, const Bytes& data) {
  Bytes bytes{0, 1, 0, 0};
  for (const std::uint32_t field : {0U, 0U, 1U}) put(bytes, field);  // stamp, empty frame_id
  bytes.push_back(0);
  put(bytes, height);
  put(bytes, width);
  put(bytes, static_cast<std::uint32_t>(std::strlen(encoding) + 1));
  bytes.insert(bytes.end(), encoding, encoding + std::strlen(encoding) + 1);
  bytes.push_back(is_bigendian);
  put(bytes, step);
  put(bytes, static_cast<std::uint32_t>(data.size()));
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

TEST(RosMessages, a_grid_of_forces_reads_back_with_the_same_bits) {
  for (const FrameShape shape : {FrameShape{1, 1}, FrameShape{3, 5}, FrameShape{64, 40}}) {
    const ForceFrame frame = random_forces(shape.taxel_count(), 7);
    Bytes message;
    encode_grid(frame, shape, {0.005, 0.004}, "array", message);
    ForceFrame read;
    const Result<FrameShape> found = decode_grid(message, read);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(*found, shape);
    EXPECT_TRUE(has_same_bits(read.newtons, frame.newtons));
    EXPECT_TRUE(has_same_bits(read.sigma_newtons, frame.sigma_newtons));
    EXPECT_EQ(read.taxels, frame.taxels);
    for (std::size_t size = 0; size < message.size(); size += 7) {
      EXPECT_FALSE(decode_grid(std::span(message).first(size), read)) << size;
    }
  }
}

TEST(RosMessages, a_grid_of_conductances_holds_no_forces) {
  ConductanceFrame frame;
  frame.siemens = frame.sigma_siemens = {1.0, 2.0};
  frame.taxels.resize(2);
  Bytes message;
  encode_conductance_grid(frame, {1, 2}, {}, "array", message);
  ForceFrame read;
  EXPECT_FALSE(decode_grid(message, read));
}

TEST(RosMessages, a_mark_reads_back_as_it_was_set) {
  const Mark mark{Nanos(1'700'000'000'123'456'789), "grasp", "anna", "tare"};
  Bytes message;
  encode_mark(mark, "suit", message);
  const Result<Mark> read = decode_mark(message);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, mark);
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_FALSE(decode_mark(std::span(message).first(size))) << size;
  }
}

}  // namespace
}  // namespace dermis::bytes::ros_messages
