// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/raw_examination.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/healthy_arrays.hpp"
#include "support/reference_array.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::uint64_t kSeeds = 5;
constexpr FrameShape kShape{8, 8};

using Frames = std::vector<RawFrame>;

/// One taxel after another is pressed, three frames each and one frame of rest; readings have a noise of one count.
Frames presses_on_each(const std::function<float(std::size_t, std::size_t)>& reading) {
  Frames frames;
  Random random(3);
  for (std::size_t number = 0; number < 4 * kShape.taxel_count(); ++number) {
    const std::size_t pressed = number % 4 == 0 ? kShape.taxel_count() : number / 4;
    RawFrame& frame = frames.emplace_back();
    for (std::size_t taxel = 0; taxel < kShape.taxel_count(); ++taxel) {
      frame.counts.push_back(std::round(reading(taxel, pressed) + static_cast<float>(random.normal())));
    }
  }
  return frames;
}

float at_rest_or_pressed(std::size_t taxel, std::size_t pressed) {
  return taxel == pressed ? 800.0F : 100.0F;
}

RawDiagnosis examine(const Frames& frames, FrameShape shape = kShape, const std::optional<Readout>& readout = {}) {
  RawExamination examination(shape, readout);
  for (const RawFrame& frame : frames) examination.add(frame);
  return examination.diagnosis();
}

/// The only finding; empty where there are none or several.
std::string finding_of(const RawDiagnosis& diagnosis) {
  EXPECT_EQ(diagnosis.problems().size(), 1U) << testing::PrintToString(diagnosis.problems());
  return diagnosis.problems().size() == 1 ? diagnosis.problems().front() : std::string();
}

bool begins_with(const std::string& text, std::string_view words) {
  return text.starts_with(words);
}

TEST(RawExamination, doubts_nothing_where_each_taxel_answers_alone) {
  const RawDiagnosis diagnosis = examine(presses_on_each(at_rest_or_pressed));
  EXPECT_TRUE(diagnosis.problems().empty()) << diagnosis.problems().front();
  EXPECT_FALSE(diagnosis.remark);
  EXPECT_NE(describe(diagnosis, kShape).find("nothing to doubt"), std::string::npos);
}

TEST(RawExamination, has_nothing_to_say_without_a_frame) {
  const RawDiagnosis diagnosis = examine({});
  EXPECT_EQ(diagnosis.frames, 0U);
  EXPECT_TRUE(diagnosis.problems().empty());
}

TEST(RawExamination, names_the_address_line_that_does_not_switch) {
  for (std::size_t bit = 0; bit < 3; ++bit) {
    const std::size_t weight = std::size_t{1} << bit;
    const auto columns = examine(presses_on_each([&](std::size_t taxel, std::size_t pressed) {
      return at_rest_or_pressed(taxel & ~weight, pressed);  // low: a column is the lowest three bits of a taxel
    }));
    EXPECT_TRUE(begins_with(finding_of(columns), "columns 0 and " + std::to_string(weight))) << finding_of(columns);
    EXPECT_NE(finding_of(columns).find("address line " + std::to_string(bit)), std::string::npos);
    const auto rows = examine(presses_on_each([&](std::size_t taxel, std::size_t pressed) {
      return at_rest_or_pressed(taxel | 8 * weight, pressed);  // high
    }));
    EXPECT_TRUE(begins_with(finding_of(rows), "rows 0 and " + std::to_string(weight))) << finding_of(rows);
  }
}

TEST(RawExamination, names_both_of_two_address_lines) {
  const auto diagnosis = examine(presses_on_each(
      [&](std::size_t taxel, std::size_t pressed) { return at_rest_or_pressed(taxel & ~std::size_t{5}, pressed); }));
  ASSERT_EQ(diagnosis.problems().size(), 2U);
  EXPECT_TRUE(begins_with(diagnosis.problems()[0], "columns 0 and 1"));
  EXPECT_TRUE(begins_with(diagnosis.problems()[1], "columns 0 and 4"));
}

TEST(RawExamination, names_a_multiplexer_that_never_switches) {
  const auto diagnosis = examine(presses_on_each(
      [&](std::size_t taxel, std::size_t pressed) { return at_rest_or_pressed(taxel & ~std::size_t{7}, pressed); }));
  EXPECT_TRUE(begins_with(finding_of(diagnosis), "all columns read the same"));
}

TEST(RawExamination, takes_two_lines_that_are_shorted_for_no_address_line) {
  const auto diagnosis = examine(presses_on_each([&](std::size_t taxel, std::size_t pressed) {
    return at_rest_or_pressed(taxel % 8 == 3 ? taxel - 1 : taxel, pressed);
  }));
  EXPECT_TRUE(diagnosis.problems().empty());
}

TEST(RawExamination, takes_a_load_on_all_of_an_even_array_for_no_fault) {
  Frames frames = presses_on_each([](std::size_t, std::size_t pressed) { return pressed == 64 ? 100.0F : 700.0F; });
  EXPECT_TRUE(examine(frames).problems().empty());
}

/// A share of the reading before stays, in the order of the scan.
void settle(Frames& frames, float share, const std::function<std::size_t(std::size_t)>& taxel_at) {
  for (RawFrame& frame : frames) {
    for (std::size_t step = 1; step < frame.counts.size(); ++step) {
      float& reading = frame.counts[taxel_at(step)];
      reading += share * (frame.counts[taxel_at(step - 1)] - reading);
    }
  }
}

TEST(RawExamination, measures_what_readings_keep_of_the_one_before) {
  Frames frames = presses_on_each(at_rest_or_pressed);
  settle(frames, 0.2F, [](std::size_t step) { return step; });
  const std::string said = finding_of(examine(frames));
  // The press itself reads less by this share.
  EXPECT_TRUE(begins_with(said, "readings keep about 20 % of the one scanned before them, along rows:")) << said;
}

TEST(RawExamination, finds_the_direction_of_the_scan) {
  Frames by_columns = presses_on_each(at_rest_or_pressed);
  settle(by_columns, 0.2F, [](std::size_t step) { return step % 8 * 8 + step / 8; });
  EXPECT_NE(finding_of(examine(by_columns)).find("along columns:"), std::string::npos);
  Frames backwards = presses_on_each(at_rest_or_pressed);
  settle(backwards, 0.2F, [](std::size_t step) { return 63 - step; });
  EXPECT_NE(finding_of(examine(backwards)).find("along rows from the last to the first:"), std::string::npos);
}

TEST(RawExamination, takes_the_crosstalk_of_pressed_lines_for_no_trail) {
  const auto diagnosis = examine(presses_on_each([&](std::size_t taxel, std::size_t pressed) {
    const bool shares_line = taxel / 8 == pressed / 8 || taxel % 8 == pressed % 8;
    return at_rest_or_pressed(taxel, pressed) + (pressed < 64 && shares_line && taxel != pressed ? 200.0F : 0.0F);
  }));
  EXPECT_TRUE(diagnosis.problems().empty());
}

TEST(RawExamination, names_readings_of_two_values) {
  Frames frames = presses_on_each([](std::size_t taxel, std::size_t pressed) {
    return taxel == pressed ? 4110.0F : -20.0F;  // cut off below
  });
  for (RawFrame& frame : frames) {
    for (float& reading : frame.counts) reading = std::clamp(reading, 0.0F, 4095.0F);
  }
  EXPECT_TRUE(begins_with(finding_of(examine(frames)), "readings are 0 or 4095 and nothing between"));
}

TEST(RawExamination, takes_few_values_in_the_noise_for_no_missing_resistor) {
  EXPECT_TRUE(examine(presses_on_each([](std::size_t, std::size_t) { return 3.0F; })).problems().empty());
}

TEST(RawExamination, remarks_on_zeros_and_doubts_them_where_an_array_at_rest_reads_high) {
  Frames frames(40);
  for (RawFrame& frame : frames) frame.counts.assign(64, 0.0F);
  const RawDiagnosis unknown = examine(frames);
  EXPECT_TRUE(unknown.problems().empty());
  ASSERT_TRUE(unknown.remark);
  EXPECT_TRUE(begins_with(*unknown.remark, "every reading of 40 frames is 0")) << *unknown.remark;
  Readout lowers;
  lowers.pressure_raises_reading = false;
  EXPECT_TRUE(begins_with(finding_of(examine(frames, kShape, lowers)), "every reading of 40 frames is 0"));
}

TEST(RawExamination, names_a_missing_supply_where_pressing_lowers_readings) {
  Readout lowers;
  lowers.pressure_raises_reading = false;
  const auto zeros = [](std::size_t taxel, std::size_t) { return taxel == 9 ? 40.0F : -20.0F; };
  Frames frames = presses_on_each(zeros);
  for (RawFrame& frame : frames) {
    for (float& reading : frame.counts) reading = std::max(reading, 0.0F);
  }
  EXPECT_TRUE(begins_with(finding_of(examine(frames, kShape, lowers)), "98 % of the readings are 0"));
}

TEST(RawExamination, names_a_line_at_its_rail) {
  Frames frames = presses_on_each(at_rest_or_pressed);
  for (RawFrame& frame : frames) {
    for (std::size_t row = 0; row < 8; ++row) frame.counts[8 * row + 5] = 1023.0F;
  }
  EXPECT_TRUE(begins_with(finding_of(examine(frames)), "column 5 reads 1023 in all 256 frames"));
  for (RawFrame& frame : frames) {
    for (std::size_t row = 0; row < 8; ++row) frame.counts[8 * row + 5] = 0.0F;
  }
  EXPECT_TRUE(begins_with(finding_of(examine(frames)), "column 5 reads 0 in all 256 frames"));
}

/// Touches of 12 frames on one taxel after another, 20 ms apart; an idle reading of 20 counts.
Frames touches_of_12_frames() {
  Frames frames;
  Random random(5);
  for (std::size_t number = 0; number < 600; ++number) {
    RawFrame& frame = frames.emplace_back();
    frame.time = number * std::chrono::milliseconds(20);
    for (std::size_t taxel = 0; taxel < kShape.taxel_count(); ++taxel) {
      const bool is_pressed = number % 15 >= 3 && taxel == number / 15 * 7 % 64;
      frame.counts.push_back(std::round((is_pressed ? 700.0F : 20.0F) + 1.5F * static_cast<float>(random.normal())));
    }
  }
  return frames;
}

/// Writes a reading into some columns, from a frame on.
void put(Frames& frames, std::size_t from, std::size_t first_col, std::size_t end_col, float reading) {
  for (std::size_t number = from; number < frames.size(); ++number) {
    for (std::size_t row = 0; row < 8; ++row) {
      for (std::size_t col = first_col; col < end_col; ++col) {
        const bool is_near_end = reading > 1000.0F;
        frames[number].counts[8 * row + col] = reading - (is_near_end ? static_cast<float>((number + row) % 3) : 0.0F);
      }
    }
  }
}

TEST(RawExamination, names_each_line_of_a_half_that_breaks_with_its_time) {
  Frames frames = touches_of_12_frames();
  put(frames, 240, 4, 8, 0.0F);
  const std::vector<std::string> problems = examine(frames).problems();
  ASSERT_EQ(problems.size(), 4U) << testing::PrintToString(problems);
  EXPECT_TRUE(begins_with(problems[0], "column 4 reads 0 from 4.80 s (frame 240) to the end")) << problems[0];
  EXPECT_TRUE(begins_with(problems[3], "column 7 reads 0 from 4.80 s (frame 240) to the end")) << problems[3];
}

TEST(RawExamination, names_a_line_that_stands_nearly_at_full_scale) {
  for (const std::size_t from : {0U, 300U}) {
    Frames frames = touches_of_12_frames();
    put(frames, from, 3, 4, 1022.0F);
    const std::string words = from == 0 ? "column 3 reads 1020 to 1022 in all 600 frames"
                                        : "column 3 reads 1020 to 1022 from 6.00 s (frame 300) to the end";
    EXPECT_TRUE(begins_with(finding_of(examine(frames)), words)) << from;
  }
}

TEST(RawExamination, takes_a_load_that_is_removed_for_no_break_where_the_readout_cuts_off) {
  Frames frames = touches_of_12_frames();
  for (std::size_t number = 0; number < frames.size(); ++number) {
    for (std::size_t taxel = 0; taxel < 64; ++taxel) {
      float& reading = frames[number].counts[taxel];
      if (number < 300 && taxel % 8 >= 4) reading += 200.0F;
      if (reading < 60.0F) reading = 0.0F;
    }
  }
  EXPECT_TRUE(examine(frames).problems().empty()) << examine(frames).problems().front();
}

/// Sixteen channels in a row.
RawDiagnosis examine_channels(const std::function<float(std::size_t, std::size_t)>& reading) {
  Frames frames;
  Random random(7);
  for (std::size_t number = 0; number < 500; ++number) {
    RawFrame& frame = frames.emplace_back();
    frame.time = number * std::chrono::milliseconds(20);
    for (std::size_t channel = 0; channel < 16; ++channel) {
      frame.counts.push_back(std::round(reading(number, channel) + 2.0F * static_cast<float>(random.normal())));
    }
  }
  return examine(frames, {1, 16});
}

TEST(RawExamination, names_channels_that_fall_together) {
  const std::string one_after_another = finding_of(
      examine_channels([](std::size_t, std::size_t channel) { return 400.0F - 13.0F * static_cast<float>(channel); }));
  EXPECT_TRUE(begins_with(one_after_another, "the 16 channels fall together, one after another from 400 to 205"))
      << one_after_another;
  EXPECT_NE(one_after_another.find("multiplexer"), std::string::npos);
  const std::string in_time = finding_of(examine_channels([](std::size_t number, std::size_t) {
    return 400.0F - 200.0F * std::abs(std::sin(0.02F * static_cast<float>(number)));
  }));
  EXPECT_TRUE(begins_with(in_time, "the 16 channels rise and fall together")) << in_time;
}

TEST(RawExamination, takes_channels_of_which_one_answers_for_right) {
  const RawDiagnosis diagnosis = examine_channels([](std::size_t number, std::size_t channel) {
    return 400.0F - 13.0F * static_cast<float>(channel) + (channel == 5 && number % 50 > 25 ? 90.0F : 0.0F);
  });
  EXPECT_TRUE(diagnosis.problems().empty()) << diagnosis.problems().front();
}

TEST(RawExamination, says_at_which_frequency_hum_shows) {
  Frames frames = touches_of_12_frames();  // 50 frames a second
  for (std::size_t number = 0; number < frames.size(); ++number) {
    const double hum = 5.0 * std::sin(2.0 * 3.14159265 * 60.0 * 0.02 * static_cast<double>(number));
    for (float& reading : frames[number].counts)
      reading = std::max(std::round(reading + static_cast<float>(hum)), 0.0F);
  }
  const std::string said = finding_of(examine(frames));
  constexpr std::string_view kAt = "hum of ";
  ASSERT_TRUE(begins_with(said, kAt)) << said;
  EXPECT_NEAR(std::stod(said.substr(kAt.size())), 5.0, 1.0);
  EXPECT_NE(said.find("at 10.0"), std::string::npos) << said;
  EXPECT_NE(said.find("60 Hz of the mains"), std::string::npos) << said;
  EXPECT_NE(said.find("charger"), std::string::npos) << said;
}

TEST(RawExamination, takes_touches_in_the_rhythm_of_a_hand_for_no_hum) {
  Frames frames = touches_of_12_frames();
  Random random(9);
  for (std::size_t number = 0; number < frames.size();) {
    const std::size_t end = number + 8 + random.below(12);
    for (; number < std::min(end, frames.size()); ++number) {
      for (float& reading : frames[number].counts) reading += 8.0F;  // crosstalk of a press
    }
    number += 8 + random.below(12);
  }
  EXPECT_TRUE(examine(frames).problems().empty()) << examine(frames).problems().front();
}

TEST(RawExamination, names_milliseconds_by_touches_that_last_many_frames) {
  Frames frames = touches_of_12_frames();
  for (RawFrame& frame : frames) frame.time *= 1000;
  const std::string said = finding_of(examine(frames));
  EXPECT_NE(said.find("the times look like milliseconds"), std::string::npos) << said;
}

/// 1,200 frames at 0.05 Hz by their time, in which each of 16 taxels is loaded for 60 frames.
Frames slow_frames(const std::function<double(double)>& course) {
  Frames frames;
  Random random(11);
  for (std::size_t number = 0; number < 1200; ++number) {
    RawFrame& frame = frames.emplace_back();
    frame.time = number * std::chrono::seconds(20);
    for (std::size_t taxel = 0; taxel < kShape.taxel_count(); ++taxel) {
      const bool is_pressed = taxel == number / 75 * 7 % 64 && number % 75 < 60;
      const double load = is_pressed ? 700.0 * course(static_cast<double>(number % 75) / 60.0) : 0.0;
      frame.counts.push_back(std::round(static_cast<float>(20.0 + load + 0.7 * random.normal())));
    }
  }
  return frames;
}

TEST(RawExamination, names_milliseconds_of_slow_touches_but_not_of_loads_that_stand) {
  const std::string said = finding_of(examine(slow_frames([](double share) { return std::sin(3.14159265 * share); })));
  EXPECT_NE(said.find("the times look like milliseconds"), std::string::npos) << said;
  const RawDiagnosis loads = examine(slow_frames([](double share) { return 1.0 - 0.2 * share; }));
  EXPECT_TRUE(loads.problems().empty()) << loads.problems().front();
}

TEST(RawExamination, names_a_clock_that_restarts_and_a_rate_that_jumps) {
  Frames frames = touches_of_12_frames();
  for (std::size_t number = 250; number < frames.size(); ++number) frames[number].time -= std::chrono::seconds(4);
  EXPECT_TRUE(begins_with(finding_of(examine(frames)), "the clock restarts at frame 250"));
  frames = touches_of_12_frames();
  for (std::size_t number = 250; number < frames.size(); ++number) {
    frames[number].time += (number - 250) * std::chrono::milliseconds(20);
  }
  EXPECT_TRUE(begins_with(finding_of(examine(frames)), "the rate jumps from 50 to 25 frames a second"));
}

TEST(RawExamination, survives_readings_that_are_no_numbers) {
  Frames frames = presses_on_each(at_rest_or_pressed);
  frames[0].counts[3] = std::numeric_limits<float>::quiet_NaN();
  frames[9].counts[4] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(examine(frames).problems().empty());
}

// ---- Simulated arrays

/// A scene on 12x10 taxels, with a fault.
Frames simulated(std::uint64_t seed, const char* scene, const ArrayDescription& array) {
  const auto simulator = simulation::Simulator::create(array, {}, scene, seed, 1500).value();
  Frames frames;
  RawFrame raw;
  while (simulator->next(raw).value()) frames.push_back(raw);
  return frames;
}

TEST(RawExaminationOfSimulatedArrays, names_equal_columns) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Frames frames = simulated(seed, "multitouch", support::reference_array(12, 10));
    Random noise(seed);
    for (RawFrame& frame : frames) {
      for (std::size_t taxel = 0; taxel < 120; ++taxel) {
        const std::size_t column = taxel % 10;
        if (column % 4 >= 2)
          frame.counts[taxel] = std::round(frame.counts[taxel - 2] + static_cast<float>(noise.normal()));
      }
    }
    EXPECT_TRUE(begins_with(finding_of(examine(frames, {12, 10})), "columns 0 and 2, 1 and 3, 4 and 6, ...")) << seed;
  }
}

TEST(RawExaminationOfSimulatedArrays, names_settling_of_20_percent) {
  ArrayDescription array = support::reference_array(12, 10);
  array.readout.adc_errors.settling = 0.2;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const std::string said = finding_of(examine(simulated(seed, "multitouch", array), {12, 10}));
    constexpr std::string_view kBeginning = "readings keep about ";
    ASSERT_TRUE(begins_with(said, kBeginning)) << seed << ": " << said;
    EXPECT_NEAR(std::stod(said.substr(kBeginning.size())), 20.0, 3.0) << seed;
  }
}

TEST(RawExaminationOfSimulatedArrays, names_a_missing_resistor) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Frames frames = simulated(seed, "multitouch", support::reference_array(12, 10));
    for (RawFrame& frame : frames) {
      for (float& reading : frame.counts) reading = reading > 40.0F ? 4095.0F : 0.0F;
    }
    EXPECT_TRUE(begins_with(finding_of(examine(frames, {12, 10})), "readings are 0 or 4095")) << seed;
  }
}

TEST(RawExaminationOfSimulatedArrays, doubts_no_healthy_one) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const support::HealthyArray healthy = support::random_healthy_array(seed);
    const RawDiagnosis diagnosis = examine(support::stream_of(healthy, 500), {healthy.array.rows, healthy.array.cols});
    EXPECT_TRUE(diagnosis.problems().empty()) << healthy.words << ": " << diagnosis.problems().front();
  }
}

}  // namespace
}  // namespace dermis::learn::health
