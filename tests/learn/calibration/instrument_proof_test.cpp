// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// More presses never make a calibration worse: presses on several taxels of healthy arrays, in any order.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/reference_array.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLines = 5;
constexpr std::size_t kTaxels = kLines * kLines;
constexpr std::size_t kUnloaded = 20;

struct Pressed {
  std::vector<std::size_t> taxels;
  double newtons = 0.0;
};

/// A healthy array drawn by chance: its circuit, the law of its rubber, what it remembers, its temperatures.
class World {
 public:
  explicit World(std::uint64_t seed) : random_(seed), array_(described(seed)), adc_(array_.readout, 0.7) {
    saturates_ = random_.uniform() < 0.5;
    creep_ = random_.uniform() < 0.5 ? 0.0 : 0.02;
    per_celsius_ = random_.uniform() < 0.5 ? 0.0 : 0.004;
    for (Taxel& taxel : taxels_) {
      taxel.ohm = 900.0 * std::exp(0.15 * random_.normal());
      taxel.exponent = 0.9 + 0.04 * random_.normal();
      taxel.contact_ohm = 60.0 * std::exp(0.2 * random_.normal());
    }
  }

  [[nodiscard]] const ArrayDescription& array() const { return array_; }
  [[nodiscard]] Random& random() { return random_; }

  RawFrame press(const Pressed& pressed) {
    std::vector<double> siemens(kTaxels, 1.0 / 300e3);
    const double celsius = 22.0 + 6.0 * random_.uniform();
    for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
      const auto is_pressed = std::find(pressed.taxels.begin(), pressed.taxels.end(), taxel) != pressed.taxels.end();
      taxels_[taxel].lag += 0.4 * ((is_pressed ? pressed.newtons : 0.0) - taxels_[taxel].lag);
      if (is_pressed) siemens[taxel] += conductance(taxels_[taxel], pressed.newtons, celsius);
    }
    RawFrame frame;
    frame.time = std::chrono::milliseconds(500 * frames_++);
    if (per_celsius_ > 0.0) frame.temperature_celsius = celsius;
    frame.counts.resize(kTaxels);
    std::vector<double> ratio(kTaxels);
    const auto circuit = simulation::ReadoutCircuit::create(array_);
    circuit->ratios(siemens, ratio);
    adc_.convert(ratio, 5.0, random_, frame.counts);
    return frame;
  }

 private:
  struct Taxel {
    double ohm = 0.0;
    double exponent = 0.0;
    double contact_ohm = 0.0;
    double lag = 0.0;
  };

  static ArrayDescription described(std::uint64_t seed) {
    const bool has_amplifiers = seed % 3 == 1;
    ArrayDescription array =
        support::reference_circuit(kLines, kLines, has_amplifiers ? Circuit::transimpedance : Circuit::divider);
    if (seed % 3 == 2) array.readout.idle_rows = IdleRows::floating;
    array.readout.drive_ohm.assign(kLines, 30.0);
    array.readout.load_ohm.assign(kLines, has_amplifiers ? 150.0 : seed % 3 == 2 ? 1000.0 : 220.0);
    array.readout.adc_bits = 12;
    array.readout.adc_reference_v = 5.0;
    array.readout.supply_v = 5.0;
    return array;
  }

  [[nodiscard]] double conductance(const Taxel& taxel, double newtons, double celsius) {
    const double felt = (1.0 - creep_) * newtons + creep_ * taxel.lag;
    const double pressed = saturates_ ? 12.0 * (1.0 - std::exp(-felt / 12.0)) : felt;
    const double ohm = taxel.contact_ohm + taxel.ohm * std::pow(10.0 / pressed, taxel.exponent);
    return std::exp(0.003 * random_.normal()) * (1.0 + per_celsius_ * (celsius - 25.0)) / ohm;
  }

  Random random_;
  ArrayDescription array_;
  simulation::Adc adc_;
  std::vector<Taxel> taxels_ = std::vector<Taxel>(kTaxels);
  bool saturates_ = false;
  double creep_ = 0.0;
  double per_celsius_ = 0.0;
  int frames_ = 0;
};

struct Labelled {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;

  void add(World& world, const Pressed& pressed) {
    for (const std::size_t taxel : pressed.taxels) {
      const std::size_t row = taxel / kLines;
      const std::size_t col = taxel % kLines;
      loads.push_back({frames.size(), LoadKind::force, {row, col, row, col}, pressed.newtons});
    }
    if (pressed.taxels.empty()) {
      loads.push_back({frames.size(), LoadKind::force, {0, 0, kLines - 1, kLines - 1}, 0.0});
    }
    frames.push_back(world.press(pressed));
  }
};

Pressed pair_in_a_row(Random& random) {
  const std::size_t first = random.below(kLines) * kLines + random.below(kLines - 1);
  return {{first, first + 1}, std::exp(std::log(1.5) + random.uniform() * std::log(8.0))};
}

/// Each taxel alone, once or more often, in the order of a person or by chance.
std::vector<Pressed> single_presses(World& world, std::size_t repetitions, bool in_order) {
  std::vector<Pressed> presses;
  for (std::size_t repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
      for (const double newtons : {0.6, 1.0, 1.7, 2.8, 4.7, 7.8, 13.0, 20.0}) presses.push_back({{taxel}, newtons});
    }
  }
  for (std::size_t k = presses.size() - 1; !in_order && k > 0; --k) {
    std::swap(presses[k], presses[world.random().below(k + 1)]);
  }
  return presses;
}

double median_error(const touch::pipeline::Model& model, const Labelled& touches) {
  auto pipeline = touch::pipeline::Pipeline::create(model);
  ForceFrame force;
  std::vector<double> errors;
  for (const RawFrame& frame : touches.frames) {
    pipeline->process(frame, force);
    for (const Load& load : touches.loads) {
      if (&touches.frames[load.frame] != &frame || load.value == 0.0) continue;
      const auto newtons = static_cast<double>(force.newtons[load.where.first_row * kLines + load.where.first_col]);
      if (std::isfinite(newtons)) errors.push_back(std::abs(newtons / load.value - 1.0));
    }
  }
  return quantile(errors, 0.5);
}

TEST(InstrumentProof, presses_on_several_taxels_leave_a_healthy_array_as_it_is_described) {
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    World world(seed);
    Labelled with;
    for (std::size_t k = 0; k < kUnloaded; ++k) with.add(world, {});
    for (const Pressed& press : single_presses(world, 1 + seed % 2, seed % 4 < 2)) with.add(world, press);
    Labelled without = with;
    for (std::size_t k = 0; k < 60; ++k) with.add(world, pair_in_a_row(world.random()));
    Labelled touches;
    for (std::size_t k = 0; k < 100; ++k) {
      touches.add(world, {});
      touches.add(world, pair_in_a_row(world.random()));
    }

    const auto proven = calibrate(world.array(), with.frames, with.loads);
    const auto plain = calibrate(world.array(), without.frames, without.loads);
    ASSERT_TRUE(proven && plain);
    EXPECT_TRUE(proven->report.doubts.empty()) << proven->report.doubts.front();
    EXPECT_FALSE(proven->model.array.readout.adc_errors.any());
    EXPECT_FALSE(proven->model.array.readout.supply_ohm);
    EXPECT_EQ(proven->report.uncertainty.unexplained_share, 0.0);
    EXPECT_LE(median_error(proven->model, touches), 1.05 * median_error(plain->model, touches));
  }
}

}  // namespace
}  // namespace dermis::learn::calibration
