// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/conversion.hpp"

#include <gtest/gtest.h>

#include "dermis/bytes/files/array_toml.hpp"
#include "support/random_frames.hpp"
#include "support/reference_array.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

using Names = std::vector<std::string>;

constexpr FrameShape kShape{3, 4};

/// A recording of five frames with all that a frame can have.
class Conversion : public testing::Test {
 protected:
  void SetUp() override {
    frames_.resize(5);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      frames_[k].time = std::chrono::milliseconds(10 * k);
      frames_[k].temperature_celsius = 20.0;
      frames_[k].supply_v = 5.0;
      frames_[k].acquisition.sequence = k;
      frames_[k].counts.assign(kShape.taxel_count(), static_cast<float>(k));
    }
    const auto sink = create_frames(in_, kShape, {"hand", {}, {}});
    ASSERT_TRUE(sink);
    ASSERT_TRUE(support::write_all(**sink, frames_));
  }

  support::TemporaryFolder folder_;
  std::string in_ = folder_.file("in.mcap");
  std::vector<RawFrame> frames_;
};

TEST_F(Conversion, a_format_that_holds_all_leaves_nothing_out) {
  const std::string out = folder_.file("out.h5");
  const Result<Names> left_out = convert_frames(in_, out);
  ASSERT_TRUE(left_out) << left_out.error().message;
  EXPECT_EQ(*left_out, Names{});
  const auto source = open_frames(out);
  ASSERT_TRUE(source);
  support::expect_same_frames(**source, frames_);
  EXPECT_EQ(read_frame_notes(out)->name, "hand");
}

TEST_F(Conversion, what_the_format_has_no_place_for_is_named) {
  EXPECT_EQ(*convert_frames(in_, folder_.file("out.csv")), Names{"numbers, device times and arrivals of the frames"});
  EXPECT_EQ(*convert_frames(in_, folder_.file("out.npy")),
            (Names{"times", "temperature", "supply", "numbers, device times and arrivals of the frames"}));
}

TEST_F(Conversion, sensors_of_temperature_that_the_first_frame_lacks_are_kept_or_named) {
  frames_[3].sensor_celsius = {20.5F, 21.5F};
  const std::string in = folder_.file("late.mcap");
  const auto sink = create_frames(in, kShape);
  ASSERT_TRUE(sink);
  ASSERT_TRUE(support::write_all(**sink, frames_));
  const std::string numbers = "numbers, device times and arrivals of the frames";
  EXPECT_EQ(*convert_frames(in, folder_.file("out.csv")),
            (Names{"temperatures of the sensors that the first frame lacks", numbers}));
  EXPECT_EQ(*convert_frames(in, folder_.file("out.h5")), Names{});
  EXPECT_EQ(read_frames(folder_.file("out.h5"))->at(3).sensor_celsius, frames_[3].sensor_celsius);

  ArrayDescription array = support::reference_array(kShape.rows, kShape.cols);
  array.name = "hand";
  array.temperature_sensors = {{0, 0}, {2, 3}};
  EXPECT_EQ(*convert_frames(in, folder_.file("described.csv"), {.array = &array}),
            (Names{numbers, "the description of the array"}));
  EXPECT_EQ(read_frames(folder_.file("described.csv"))->at(3).sensor_celsius, frames_[3].sensor_celsius);
}

TEST_F(Conversion, a_file_without_times_has_none_to_leave_out) {
  const std::string npy = folder_.file("f.npy");
  ASSERT_TRUE(convert_frames(in_, npy));
  EXPECT_EQ(*convert_frames(npy, folder_.file("g.npy")), Names{});
  EXPECT_FALSE(convert_frames(npy, folder_.file("g.csv"))) << "whose frames need times";
  EXPECT_EQ(*convert_frames(npy, folder_.file("g.csv"), {.input = {.rate_hz = 100.0}}), Names{});
}

TEST_F(Conversion, the_array_is_kept_where_there_is_a_place_for_it) {
  ArrayDescription array;
  array.name = "left hand";
  array.rows = kShape.rows;
  array.cols = kShape.cols;
  const std::string out = folder_.file("out.mcap");
  EXPECT_EQ(*convert_frames(in_, out, {.array = &array}), Names{});
  EXPECT_EQ(read_frame_notes(out)->name, "left hand");
  EXPECT_EQ(read_frame_notes(out)->array_toml, files::array_to_toml(array));
  EXPECT_EQ(convert_frames(in_, folder_.file("out.npy"), {.array = &array})->back(), "the description of the array");
}

TEST_F(Conversion, frames_of_another_shape_are_refused) {
  EXPECT_FALSE(convert_frames(in_, folder_.file("out.csv"), {.input = {.shape = FrameShape{4, 3}}}));
  EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_F(Conversion, a_recording_that_was_cut_is_converted_as_far_as_it_goes_and_said_to_be_cut) {
  const std::string cut = folder_.file("cut.mcap");
  const std::string bytes = support::read_bytes(in_);
  support::write_bytes(cut, std::string_view(bytes).substr(0, bytes.size() - 10));
  Names losses;
  ASSERT_TRUE(convert_frames(cut, folder_.file("out.csv"),
                             {.input = {.loss = [&](const std::string& text) { losses.push_back(text); }}}));
  EXPECT_EQ(losses, Names{cut + ": was not written to its end, so that its last frames may be missing; recovery "
                                "makes it complete"});
  EXPECT_EQ(read_frames(folder_.file("out.csv"))->size(), 5U);
}

TEST_F(Conversion, a_conversion_that_is_stopped_writes_nothing) {
  const std::atomic<bool> stop = true;
  const Result<Names> stopped = convert_frames(in_, folder_.file("out.csv"), {.stop = &stop});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "stopped; nothing is written");
  EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_F(Conversion, names_of_no_known_format_are_refused) {
  EXPECT_FALSE(convert_frames(in_, folder_.file("out.xyz")));
  EXPECT_FALSE(convert_frames(folder_.file("none.csv"), folder_.file("out.csv")));
  EXPECT_EQ(folder_.file_count(), 1U);
}

}  // namespace
}  // namespace dermis::bytes::recordings
