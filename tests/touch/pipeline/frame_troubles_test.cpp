// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/frame_troubles.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "dermis/touch/pipeline/direct_model.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::touch::pipeline {
namespace {

/// Two taxels without a circuit.
ArrayDescription pair_of(Quantity quantity) {
  ArrayDescription array;
  array.rows = 1;
  array.cols = 2;
  array.readout.circuit = Circuit::none;
  array.readout.quantity = quantity;
  array.readout.adc_bits = quantity == Quantity::counts ? 12 : 24;
  return array;
}

/// Frames of both taxels, 10 ms apart.
std::vector<RawFrame> frames_of(const std::vector<std::vector<float>>& counts) {
  std::vector<RawFrame> frames;
  for (const std::vector<float>& of_frame : counts) {
    RawFrame frame;
    frame.time = std::chrono::milliseconds(10 * (1 + frames.size()));
    frame.counts = of_frame;
    frames.push_back(frame);
  }
  return frames;
}

/// Says that each frame stands in line 7.
class Lines final : public FrameSource {
 public:
  Result<bool> next(RawFrame& /*frame*/) override { return false; }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return std::nullopt; }
  [[nodiscard]] std::string place() const override { return "f.csv:7"; }
};

FrameTroubles troubles_of(const ArrayDescription& array, const std::vector<RawFrame>& frames,
                          const FrameSource* source = nullptr) {
  FrameTroubles troubles(array, "f.csv");
  Result<Pipeline> pipeline = Pipeline::create(direct_model(array));
  EXPECT_TRUE(pipeline) << pipeline.error().message;
  ForceFrame force;
  for (const RawFrame& frame : frames) {
    pipeline->process(frame, force);
    troubles.add(frame, force, *pipeline, source);
  }
  EXPECT_EQ(troubles.frames(), frames.size());
  return troubles;
}

TEST(FrameTroubles, has_nothing_to_say_of_good_frames) {
  const FrameTroubles troubles = troubles_of(pair_of(Quantity::force), frames_of({{0.0F, 1.0F}, {2.0F, 0.0F}}));
  EXPECT_TRUE(troubles.describe().empty());
  EXPECT_TRUE(troubles.verdict());
}

TEST(FrameTroubles, says_how_many_frames_have_a_supply_outside_of_the_calibration_and_which) {
  Model model = support::hand_made_model(1, 2);
  model.array.readout.adc_reference_v = 5.0;
  model.array.readout.supply_v = 5.0;
  Result<Pipeline> pipeline = Pipeline::create(model);
  ASSERT_TRUE(pipeline);
  FrameTroubles troubles(model.array, "f.csv");
  ForceFrame force;
  std::vector<RawFrame> frames = frames_of({{9.0F, 9.0F}, {9.0F, 9.0F}, {9.0F, 9.0F}, {9.0F, 9.0F}});
  const std::vector<double> supply_v{5.0, 6.5, 8.0, 5000.0};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].supply_v = supply_v[k];
    pipeline->process(frames[k], force);
    troubles.add(frames[k], force, *pipeline);
  }
  EXPECT_EQ(
      troubles.describe(),
      (std::vector<std::string>{
          "1 of 4 frames rejected, the first: f.csv: frame 4: a supply of 5000 V (1.67 to 15 V are possible): it "
          "looks like millivolts, give volts",
          "2 of 4 frames with a supply outside of the calibration, the first: 6.5 V, where 4 to 6 V are trusted"}));
}

FrameTroubles troubles_of_hand_made(const std::vector<RawFrame>& frames,
                                    const std::vector<TemperatureSensor>& sensors = {}) {
  Model model = support::hand_made_model(4, 4);
  model.array.temperature_sensors = sensors;
  Result<Pipeline> pipeline = Pipeline::create(model);
  EXPECT_TRUE(pipeline);
  FrameTroubles troubles(model.array, "f.csv");
  ForceFrame force;
  for (const RawFrame& frame : frames) {
    pipeline->process(frame, force);
    troubles.add(frame, force, *pipeline);
  }
  return troubles;
}

TEST(FrameTroubles, fails_where_temperatures_are_in_kelvin) {
  std::vector<RawFrame> frames = frames_of(std::vector<std::vector<float>>(3, std::vector<float>(16, 20000.0F)));
  for (RawFrame& frame : frames) frame.temperature_celsius = 298.15;
  EXPECT_EQ(troubles_of_hand_made(frames).verdict().error().message,
            "f.csv: 3 of 3 frames with a temperature that no sheet has, the first: 298.1 C: it looks like kelvin, give "
            "degrees Celsius");
  for (RawFrame& frame : frames) frame.temperature_celsius = 60.0;
  EXPECT_TRUE(troubles_of_hand_made(frames).verdict()) << "hot, but it can be";
}

TEST(FrameTroubles, fails_where_sensors_are_in_kelvin) {
  std::vector<RawFrame> frames = frames_of(std::vector<std::vector<float>>(3, std::vector<float>(16, 20000.0F)));
  for (RawFrame& frame : frames) frame.sensor_celsius = {298.0F, 299.0F};
  EXPECT_FALSE(troubles_of_hand_made(frames, {{0, 0}, {3, 3}}).verdict());
  for (RawFrame& frame : frames) frame.sensor_celsius = {60.0F, 70.0F};
  EXPECT_TRUE(troubles_of_hand_made(frames, {{0, 0}, {3, 3}}).verdict());
}

TEST(FrameTroubles, says_where_frames_have_other_sensors_than_the_array) {
  std::vector<RawFrame> frames = frames_of(std::vector<std::vector<float>>(2, std::vector<float>(16, 20000.0F)));
  for (RawFrame& frame : frames) frame.sensor_celsius = {20.0F, 21.0F, 22.0F};
  EXPECT_EQ(troubles_of_hand_made(frames, {{0, 0}, {3, 3}}).describe().back(),
            "2 of 2 frames with temperatures of 3 sensors, where array.temperature_sensors has 2 places");
  EXPECT_TRUE(troubles_of_hand_made(frames, {{0, 0}, {3, 3}, {0, 3}}).describe().empty());
}

TEST(FrameTroubles, fails_where_all_readings_are_0_and_untouched_taxels_read_more) {
  const std::vector<float> silence(16, 0.0F);
  const std::vector<float> readings(16, 20000.0F);
  const std::string line = "with all readings 0, where untouched taxels read more: is the array connected and powered?";
  EXPECT_EQ(troubles_of_hand_made(frames_of({silence, readings, silence, silence})).verdict().error().message,
            "f.csv: 3 of 4 frames " + line);
  const FrameTroubles few = troubles_of_hand_made(frames_of({readings, silence, readings}));
  EXPECT_TRUE(few.verdict());
  EXPECT_EQ(few.describe().back(), "1 of 3 frames " + line);
}

TEST(FrameTroubles, takes_zeros_of_an_array_that_reads_nothing_where_nothing_presses) {
  const FrameTroubles troubles = troubles_of(pair_of(Quantity::counts), frames_of({{0.0F, 0.0F}, {0.0F, 0.0F}}));
  EXPECT_TRUE(troubles.verdict());
  EXPECT_FALSE(troubles.impossible());
  EXPECT_EQ(troubles.describe(),
            std::vector<std::string>{
                "all readings of all 2 frames are 0: nothing touches the array, or it is not connected"});
  EXPECT_FALSE(troubles_of(pair_of(Quantity::counts), frames_of({{0.0F, 0.0F}, {0.0F, 1.0F}})).silence());
  EXPECT_FALSE(troubles_of(pair_of(Quantity::force), frames_of({{0.0F, 0.0F}})).silence());
}

TEST(FrameTroubles, says_how_many_frames_were_rejected_and_where_the_first_stands) {
  std::vector<RawFrame> frames = frames_of({{1.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 1.0F}});
  frames[2].time = frames[0].time;
  const ArrayDescription array = pair_of(Quantity::force);
  EXPECT_EQ(troubles_of(array, frames).describe(),
            std::vector<std::string>{"1 of 4 frames rejected, the first: f.csv: frame 3: time going backwards"});
  const Lines lines;
  EXPECT_EQ(troubles_of(array, frames, &lines).describe(),
            std::vector<std::string>{"1 of 4 frames rejected, the first: f.csv:7: time going backwards"});
  EXPECT_TRUE(troubles_of(array, frames).verdict());
}

TEST(FrameTroubles, counts_the_frames_that_are_skipped) {
  FrameTroubles troubles(pair_of(Quantity::force), "");
  Result<Pipeline> pipeline = Pipeline::create(direct_model(pair_of(Quantity::force)));
  ASSERT_TRUE(pipeline);
  ForceFrame force;
  const RawFrame frame = frames_of({{NAN, NAN}}).front();
  pipeline->process(frame, force);
  troubles.skip();
  troubles.add(frame, force, *pipeline);
  EXPECT_EQ(troubles.frames(), 1U);
  ASSERT_EQ(troubles.describe().size(), 1U);
  EXPECT_NE(troubles.describe().front().find("the first: frame 2: "), std::string::npos) << troubles.describe().front();
}

TEST(FrameTroubles, says_which_taxels_had_no_reading) {
  const FrameTroubles troubles = troubles_of(pair_of(Quantity::force), frames_of({{0.0F, 1.0F}, {0.0F, NAN}}));
  ASSERT_EQ(troubles.describe().size(), 1U);
  EXPECT_NE(troubles.describe().front().find("r0c1 in 1 of 2 frames"), std::string::npos)
      << troubles.describe().front();
}

TEST(FrameTroubles, fails_where_more_than_half_of_the_frames_have_no_force) {
  const ArrayDescription array = pair_of(Quantity::force);
  EXPECT_TRUE(troubles_of(array, frames_of({{0.0F, 1.0F}, {NAN, NAN}})).verdict());
  const Status verdict = troubles_of(array, frames_of({{NAN, NAN}, {0.0F, 1.0F}, {NAN, NAN}})).verdict();
  ASSERT_FALSE(verdict);
  EXPECT_EQ(verdict.error().kind, ErrorKind::failed);
  EXPECT_EQ(verdict.error().message,
            "f.csv: 2 of 3 frames have no force: the first is rejected, f.csv: frame 1: more than half of the readings "
            "are missing or outside the ADC range");
}

TEST(FrameTroubles, names_readings_that_no_ADC_of_so_many_bits_gives) {
  const Status verdict =
      troubles_of(pair_of(Quantity::counts), frames_of({{0.0F, 10.0F}, {5000.0F, 5000.0F}, {9000.0F, 8000.0F}}))
          .verdict();
  ASSERT_FALSE(verdict);
  EXPECT_EQ(verdict.error().message,
            "f.csv: 2 of 3 frames have no force: readings of 0 to 9000, but the ADC gives 0 to 4095 (adc_bits = 12)");
}

}  // namespace
}  // namespace dermis::touch::pipeline
