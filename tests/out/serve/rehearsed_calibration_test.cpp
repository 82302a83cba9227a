// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The guide and the hand of sim:rehearsal, which knows of the guide only what is said to a person, in simulated time.
#include <gtest/gtest.h>

#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"
#include "learn/calibration/guided/press_recogniser.hpp"
#include "live/sources/rehearsal.hpp"
#include "out/serve/calibration/calibration_services.hpp"
#include "out/serve/part_calls.hpp"

namespace dermis::out::serve {
namespace {

using learn::calibration::GuideHint;
using learn::calibration::GuideStage;
using learn::calibration::GuideState;

constexpr double kRateHz = 100.0;
constexpr std::uint64_t kSeeds = 20;
constexpr double kMostSeconds = 1800.0;  // by the clock of the frames

struct Kind {
  const char* name;
  Circuit circuit;
  IdleRows idle_rows;
  IdleColumns idle_columns;
};

constexpr Kind kKinds[] = {{"grounded divider", Circuit::divider, IdleRows::grounded, IdleColumns::loaded},
                           {"floating divider", Circuit::divider, IdleRows::floating, IdleColumns::loaded},
                           {"loaded column", Circuit::divider, IdleRows::grounded, IdleColumns::floating},
                           {"transimpedance", Circuit::transimpedance, IdleRows::grounded, IdleColumns::loaded},
                           {"flexitac", Circuit::flexitac, IdleRows::grounded, IdleColumns::loaded}};

/// An array of a circuit that the guide is not told.
ArrayDescription random_array(const Kind& kind, std::uint64_t seed) {
  Random random(seed);
  ArrayDescription array;
  array.name = "hand";
  array.rows = 4 + random.below(3);
  array.cols = 4 + random.below(3);
  array.taxel_area_m2 = 38.48e-6;
  array.readout.circuit = kind.circuit;
  array.readout.idle_rows = kind.idle_rows;
  array.readout.idle_columns = kind.idle_columns;
  array.readout.adc_bits = random.below(2) == 0 ? 10 : 12;
  array.readout.drive_ohm.assign(array.driven_lines(), random.log_uniform(5.0, 50.0));
  array.readout.load_ohm.assign(array.sensed_lines(), random.log_uniform(100.0, 1000.0));
  return array;
}

ArrayDescription without_circuit(const ArrayDescription& array) {
  ArrayDescription unknown = array;
  unknown.readout = {};
  unknown.readout.circuit = Circuit::automatic;
  unknown.readout.adc_bits = array.readout.adc_bits;
  return unknown;
}

struct Walk {
  GuideState state;
  std::set<GuideHint> pair_hints;  ///< What was said while two taxels were asked for.
};

/// Rehearses a calibration until nothing is asked for any more.
Walk rehearse(const ArrayDescription& array, std::uint64_t seed) {
  const auto voice = std::make_shared<live::sources::GuideVoice>();
  CalibrationServices services(
      ServiceArrays({{"hand", without_circuit(array), ""}}),
      [](std::size_t, const std::shared_ptr<const touch::pipeline::Model>&) { return Done{}; }, voice);
  EXPECT_TRUE(call(services, "/calibration/start",
                   R"({"taxels": {"stride": 2}, "weights_n": [2, 6, 20], "unloaded_s": 1, "hold_s": 0.4})"));
  live::sources::Rehearsal rehearsal = *live::sources::Rehearsal::create(array, seed, kRateHz, voice);
  RawFrame frame;
  Walk walk;
  for (std::uint64_t number = 0; static_cast<double>(number) < kMostSeconds * kRateHz;) {
    walk.state = services.progress()->state;
    if (walk.state.stage == GuideStage::done || walk.state.stage == GuideStage::failed) return walk;
    if (walk.state.stage == GuideStage::fitting) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    if (walk.state.together_with) walk.pair_hints.insert(walk.state.hint);
    rehearsal.read(number, frame);
    frame.time = Nanos(static_cast<std::int64_t>(1e9 * static_cast<double>(++number) / kRateHz));
    services.feed(0, frame);
  }
  return walk;
}

TEST(RehearsedCalibration, of_an_unknown_circuit_ends_by_itself_for_twenty_seeds) {
  std::set<GuideHint> pair_hints;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Kind& kind = kKinds[seed % std::size(kKinds)];
    SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
    const Walk walk = rehearse(random_array(kind, seed), seed);
    EXPECT_EQ(walk.state.stage, GuideStage::done) << walk.state.message;
    EXPECT_EQ(walk.state.presses_done, walk.state.presses_total);
    pair_hints.insert(walk.pair_hints.begin(), walk.pair_hints.end());
  }
  for (const GuideHint hint : {GuideHint::other_taxel, GuideHint::several, GuideHint::one_of_two}) {
    EXPECT_TRUE(pair_hints.contains(hint)) << "no pair was begun with this mistake: " << static_cast<int>(hint);
  }
}

/// The recogniser of the guide and the hand, without the fits between presses.
class Presses {
 public:
  Presses(const ArrayDescription& array, std::uint64_t seed)
      : rehearsal_(*live::sources::Rehearsal::create(array, seed, kRateHz, voice_)), conditioner_(array) {
    const double ratio_per_count = 1.0 / array.readout.full_scale_counts();
    learn::calibration::QuietWindow quiet(std::chrono::seconds(1), ratio_per_count);
    while (!quiet.is_done()) {
      read();
      quiet.feed(frame_, conditioned_.ratio);
    }
    recogniser_.emplace(learn::calibration::TouchSense(quiet.mean(), ratio_per_count), kHold);
  }

  /// Whether the press is held and released within a minute, whatever the hand does wrong first.
  bool comes_to_an_end(const std::vector<std::size_t>& taxels, double newtons) {
    recogniser_->expect(taxels);
    GuideState state;
    state.stage = GuideStage::pressing;
    state.taxel = taxels.front();
    if (taxels.size() > 1) state.together_with = taxels.back();
    state.weight_n = newtons;
    for (const std::uint64_t end = number_ + static_cast<std::uint64_t>(60.0 * kRateHz); number_ < end;) {
      state.hint = recogniser_->hint();
      hints.insert(state.hint);
      voice_->speak(words_of(state, kHold));
      read();
      using Event = learn::calibration::PressRecogniser::Event;
      const Event event = recogniser_->feed(frame_, conditioned_.ratio, 1.0 / kRateHz);
      if (event == Event::held) (void)recogniser_->keep_hold(1);
      if (event == Event::released) return true;
    }
    return false;
  }

  std::set<GuideHint> hints{};

 private:
  static constexpr Nanos kHold = std::chrono::milliseconds(400);

  void read() {
    rehearsal_.read(number_, frame_);
    frame_.time = Nanos(static_cast<std::int64_t>(1e9 * static_cast<double>(++number_) / kRateHz));
    conditioner_.process(frame_, conditioned_);
  }

  std::shared_ptr<live::sources::GuideVoice> voice_ = std::make_shared<live::sources::GuideVoice>();
  live::sources::Rehearsal rehearsal_;
  touch::preprocessing::Conditioner conditioner_;
  std::optional<learn::calibration::PressRecogniser> recogniser_;
  RawFrame frame_;
  ConditionedFrame conditioned_;
  std::uint64_t number_ = 0;
};

TEST(RehearsedPresses, of_random_taxels_and_pairs_end_in_every_circuit) {
  for (const Kind& kind : kKinds) {
    std::set<GuideHint> hints;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
      const ArrayDescription array = random_array(kind, seed);
      Presses presses(array, seed);
      Random random(seed);
      for (int press = 0; press < 8; ++press) {
        const std::size_t taxel = random.below(array.taxel_count());
        const std::size_t other = (taxel + 2 * array.cols) % array.taxel_count();
        const double newtons = random.below(2) == 0 ? 6.0 : 20.0;
        if (press % 2 == 0) {
          EXPECT_TRUE(presses.comes_to_an_end({taxel}, newtons)) << array.taxel_name(taxel);
        } else {
          EXPECT_TRUE(presses.comes_to_an_end({taxel, other}, newtons))
              << array.taxel_name(taxel) << " and " << array.taxel_name(other);
        }
      }
      hints.insert(presses.hints.begin(), presses.hints.end());
    }
    for (const GuideHint hint : {GuideHint::other_taxel, GuideHint::several, GuideHint::one_of_two}) {
      EXPECT_TRUE(hints.contains(hint)) << kind.name << ": " << static_cast<int>(hint);
    }
  }
}

}  // namespace
}  // namespace dermis::out::serve
