// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// What bad input costs at 1 kHz: the slowest frame, and the slowest 100 frames in a row, over the median of good
// frames. A frame is timed several times, of which the least counts. So what else runs on the machine is no input.
//
// usage: worst_frames [FRAMES of each input [BEGIN of the names]]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "random_model.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

using learn::simulation::LineFaults;

constexpr std::size_t kGoodFirst = 64;
constexpr std::size_t kInARow = 100;
constexpr int kTimings = 5;
constexpr double kMostOfFrame = 100.0;  // medians
constexpr double kMostOfMean = 3.0;     // likewise
constexpr float kFullScale = 4095.0F;
constexpr std::size_t kCols = 16;

/// Frames that no good array gives.
struct BadInput {
  std::string name;
  LineFaults faults{};
  void (*spoil)(RawFrame& frame, std::size_t number, Random& random) = nullptr;
};

float any_count(Random& random) {
  return static_cast<float>(random.below(4096));
}

void set_some(RawFrame& frame, double share, Random& random) {
  for (float& count : frame.counts) {
    if (random.uniform() < share) count = any_count(random);
  }
}

void fill_row(RawFrame& frame, std::size_t row, float count) {
  std::fill_n(frame.counts.begin() + static_cast<std::ptrdiff_t>(kCols * row), kCols, count);
}

void fill_col(RawFrame& frame, std::size_t col, float count) {
  for (std::size_t taxel = col; taxel < frame.counts.size(); taxel += kCols) frame.counts[taxel] = count;
}

void saturate_row(RawFrame& frame, std::size_t, Random&) {
  fill_row(frame, 3, kFullScale);
}

std::vector<BadInput> bad_inputs() {
  std::vector<BadInput> inputs;
  const auto add = [&](const char* name, auto spoil) { inputs.push_back({.name = name, .spoil = spoil}); };
  const auto add_fault = [&](const char* name, const auto& set) {
    for (const bool is_saturated : {false, true}) {
      inputs.push_back({.name = std::string(name) + (is_saturated ? ", a saturated row" : "")});
      set(inputs.back().faults);
      if (is_saturated) inputs.back().spoil = saturate_row;
    }
  };
  add("a saturated row", saturate_row);
  add("a row near its end", [](RawFrame& frame, std::size_t, Random& random) {
    for (std::size_t col = 0; col < kCols; ++col) {
      frame.counts[48 + col] = kFullScale - static_cast<float>(random.below(64));
    }
  });
  add("a saturated column", [](RawFrame& frame, std::size_t, Random&) { fill_col(frame, 3, kFullScale); });
  add_fault("an open row", [](LineFaults& faults) { faults.rows.open = {8}; });
  add_fault("a grounded row", [](LineFaults& faults) { faults.rows.grounded = {8}; });
  add_fault("a supplied row", [](LineFaults& faults) { faults.rows.supplied = {8}; });
  add_fault("shorted rows", [](LineFaults& faults) { faults.rows.shorted = {8}; });
  add_fault("an open column", [](LineFaults& faults) { faults.columns.open = {8}; });
  add_fault("a grounded column", [](LineFaults& faults) { faults.columns.grounded = {8}; });
  add_fault("a supplied column", [](LineFaults& faults) { faults.columns.supplied = {8}; });
  add_fault("shorted columns", [](LineFaults& faults) { faults.columns.shorted = {8}; });
  add_fault("a shorted crossing", [](LineFaults& faults) { faults.shorted_taxels = {"r8c8"}; });
  add_fault("an open row and shorted rows", [](LineFaults& faults) {
    faults.rows.open = {8};
    faults.rows.shorted = {11};
  });
  add_fault("two crossings and an open column", [](LineFaults& faults) {
    faults.shorted_taxels = {"r8c8", "r12c2"};
    faults.columns.open = {5};
  });
  add("two faults in turn", [](RawFrame& frame, std::size_t number, Random&) {
    number % 2 == 0 ? fill_row(frame, 3, kFullScale) : fill_row(frame, 9, 0.0F);
  });
  add("two saturated rows in turn",
      [](RawFrame& frame, std::size_t number, Random&) { fill_row(frame, number % 2 == 0 ? 3 : 9, kFullScale); });
  add("a saturated row that moves",
      [](RawFrame& frame, std::size_t number, Random&) { fill_row(frame, number % 16, kFullScale); });
  add("lines that come and go", [](RawFrame& frame, std::size_t, Random& random) {
    const float count = random.below(2) == 0 ? kFullScale : 0.0F;
    random.below(2) == 0 ? fill_row(frame, random.below(16), count) : fill_col(frame, random.below(16), count);
  });
  add("faults for twenty frames each", [](RawFrame& frame, std::size_t number, Random&) {
    const std::size_t which = number / 20;
    const float count = which % 3 == 0 ? kFullScale : 0.0F;
    which % 2 == 0 ? fill_row(frame, which % 16, count) : fill_col(frame, which * 5 % 16, count);
  });
  add("random counts", [](RawFrame& frame, std::size_t, Random& random) { set_some(frame, 1.0, random); });
  add("a third of them random", [](RawFrame& frame, std::size_t, Random& random) { set_some(frame, 0.33, random); });
  add("a tenth of them random", [](RawFrame& frame, std::size_t, Random& random) { set_some(frame, 0.1, random); });
  add("spikes in 1 %", [](RawFrame& frame, std::size_t, Random& random) { set_some(frame, 0.01, random); });
  add("random counts in turn with good ones", [](RawFrame& frame, std::size_t number, Random& random) {
    if (number % 2 == 0) set_some(frame, 1.0, random);
  });
  add("a random frame among twenty", [](RawFrame& frame, std::size_t number, Random& random) {
    if (number % 20 == 0) set_some(frame, 0.2, random);
  });
  add("large counts", [](RawFrame& frame, std::size_t, Random& random) {
    for (float& count : frame.counts) count = 2000.0F + 0.5F * any_count(random);
  });
  add("small counts", [](RawFrame& frame, std::size_t, Random& random) {
    for (float& count : frame.counts) count = any_count(random) / 16.0F;
  });
  add("all saturated",
      [](RawFrame& frame, std::size_t, Random&) { std::fill(frame.counts.begin(), frame.counts.end(), kFullScale); });
  add("all zero",
      [](RawFrame& frame, std::size_t, Random&) { std::fill(frame.counts.begin(), frame.counts.end(), 0.0F); });
  add("zero and full by turns", [](RawFrame& frame, std::size_t number, Random&) {
    std::fill(frame.counts.begin(), frame.counts.end(), number % 2 == 0 ? 0.0F : kFullScale);
  });
  add("a tenth not a number", [](RawFrame& frame, std::size_t, Random& random) {
    for (float& count : frame.counts) {
      if (random.uniform() < 0.1) count = std::numeric_limits<float>::quiet_NaN();
    }
  });
  add("a tenth negative", [](RawFrame& frame, std::size_t, Random& random) {
    for (float& count : frame.counts) {
      if (random.uniform() < 0.1) count = -any_count(random);
    }
  });
  add("alternating spikes", [](RawFrame& frame, std::size_t number, Random&) {
    for (std::size_t taxel = 0; number % 2 == 1 && taxel < frame.counts.size(); taxel += 7) {
      frame.counts[taxel] = kFullScale;
    }
  });
  add("one stuck taxel", [](RawFrame& frame, std::size_t, Random&) { frame.counts[37] = 3500.0F; });
  add("one taxel of any count",
      [](RawFrame& frame, std::size_t, Random& random) { frame.counts[37] = any_count(random); });
  return inputs;
}

std::vector<RawFrame> frames_of(const ArrayDescription& array, const LineFaults& faults, std::size_t count) {
  constexpr std::size_t kFrom = 150;  // something presses
  learn::simulation::SimulationOptions options;
  options.faults = faults;
  options.faults.from_frame = kFrom + kGoodFirst;
  auto simulator = learn::simulation::Simulator::create(array, options, "contacts", 1, kFrom + kGoodFirst + count);
  std::vector<RawFrame> frames(kFrom + kGoodFirst + count);
  for (RawFrame& frame : frames) {
    if (!simulator || !simulator.value()->next(frame)) std::abort();
  }
  frames.erase(frames.begin(), frames.begin() + kFrom);
  for (std::size_t k = 0; k < frames.size(); ++k) frames[k].time = std::chrono::milliseconds(k);
  return frames;
}

struct Times {
  std::vector<double> seconds;  // of each frame
  double solved = 0.0;          // share of the frames after the good ones
};

Times time_frames(const touch::pipeline::Model& model, const std::vector<RawFrame>& frames) {
  using Clock = std::chrono::steady_clock;
  Times times{.seconds = std::vector<double>(frames.size(), 1.0)};
  ForceFrame force;
  for (int timing = 0; timing < kTimings; ++timing) {
    auto pipeline = touch::pipeline::Pipeline::create(model);
    std::size_t solved = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const auto start = Clock::now();
      pipeline->process(frames[k], force);
      times.seconds[k] = std::min(times.seconds[k], std::chrono::duration<double>(Clock::now() - start).count());
      solved += k >= kGoodFirst && !has(force.status, FrameStatus::not_converged) ? 1 : 0;
    }
    times.solved = static_cast<double>(solved) / static_cast<double>(frames.size() - kGoodFirst);
  }
  return times;
}

double slowest_mean(const std::vector<double>& seconds) {
  double sum = 0.0;
  double slowest = 0.0;
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    sum += seconds[k] - (k >= kInARow ? seconds[k - kInARow] : 0.0);
    if (k + 1 >= kInARow) slowest = std::max(slowest, sum / kInARow);
  }
  return slowest;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Whether the frames are fast enough.
bool report(const std::string& name, const Times& times, double median) {
  const std::vector<double> bad(times.seconds.begin() + kGoodFirst, times.seconds.end());
  const double slowest = *std::max_element(bad.begin(), bad.end()) / median;
  const double mean = slowest_mean(times.seconds) / median;
  const bool is_fast = slowest <= kMostOfFrame && mean <= kMostOfMean;
  fmt::print("{:<52}{:>10.1f}{:>10.2f}{:>10.2f}{:>9.1f}%{}\n", name, slowest, mean, median_of(bad) / median,
             100.0 * times.solved, is_fast ? "" : "  SLOW");
  return is_fast;
}

/// The frame that takes longest after good ones, of counts that are changed few at a time as long as that makes it
/// slower.
Times search_slowest(const touch::pipeline::Model& model, const std::vector<RawFrame>& good, std::size_t steps) {
  constexpr std::size_t kMostChanged = 8;
  Random random(1);
  Times slowest{.seconds = {0.0}};
  std::vector<RawFrame> frames(good.begin(), good.begin() + kGoodFirst + 1);
  RawFrame best = frames.back();
  for (std::size_t step = 0; step < steps; ++step) {
    frames.back().counts = best.counts;
    for (std::size_t k = 0; k <= random.below(kMostChanged); ++k) {
      frames.back().counts[random.below(best.counts.size())] = any_count(random);
    }
    Times times = time_frames(model, frames);
    if (times.seconds.back() <= slowest.seconds.back()) continue;
    slowest = std::move(times);
    best.counts = frames.back().counts;
  }
  return slowest;
}

int run(std::size_t count, const std::string& part) {
  const ArrayDescription array = support::reference_array(kCols, kCols);
  const touch::pipeline::Model model = random_model(array);
  const std::vector<RawFrame> good = frames_of(array, {}, count);
  const double median = median_of(time_frames(model, good).seconds);
  fmt::print("medians of a good frame, {:.2f} us; {} frames of each input\n", 1e6 * median, count);
  fmt::print("{:<52}{:>10}{:>10}{:>10}{:>10}\n", "input", "slowest", "of 100", "median", "solved");
  Random random(1);
  bool are_fast = true;
  for (const BadInput& input : bad_inputs()) {
    if (!input.name.starts_with(part)) continue;
    std::vector<RawFrame> frames = input.faults.any() ? frames_of(array, input.faults, count) : good;
    for (std::size_t k = kGoodFirst; k < frames.size() && input.spoil != nullptr; ++k) {
      input.spoil(frames[k], k, random);
    }
    are_fast = report(input.name, time_frames(model, frames), median) && are_fast;
  }
  if (part.empty()) are_fast = report("searched", search_slowest(model, good, count / 10), median) && are_fast;
  return are_fast ? 0 : 1;
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  return dermis::run(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 2000, argc > 2 ? argv[2] : "");
}
