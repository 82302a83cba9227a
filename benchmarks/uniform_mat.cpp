// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A mat of 56x28 taxels under 34 uniform loads, as strangers build it: rows that float, a diode in each of them,
// resistors of 100 kohm, 8 bits, rubber that differs by 24 % from taxel to taxel and remembers. Each load is left out
// of a calibration in turn, and what dermis makes of it stands beside the fit that people make by hand:
// ln F = a + b ln counts, cell by cell. Usage: uniform_mat SEED [EVERY]   (every so many of the loads; 1)
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "need.hpp"

namespace dermis {
namespace {

constexpr std::size_t kRows = 56;
constexpr std::size_t kCols = 28;
constexpr std::size_t kUnloaded = 10;  // frames, before the loads
constexpr std::size_t kLoads = 34;
constexpr double kLightestKpa = 1.0;
constexpr double kHeaviestKpa = 50.0;
constexpr double kTaxelAreaM2 = 1e-4;
constexpr double kPascalsOfKpa = 1e3;
constexpr double kNewtonsOfKpa = kPascalsOfKpa * kTaxelAreaM2;
constexpr double kSupplyV = 5.0;
constexpr double kLoadOhm = 100e3;
constexpr double kSecondsOfLoad = 10.0;

ArrayDescription mat() {
  ArrayDescription array;
  array.rows = kRows;
  array.cols = kCols;
  array.taxel_area_m2 = kTaxelAreaM2;
  array.readout.circuit = Circuit::divider;
  array.readout.idle_rows = IdleRows::floating;
  array.readout.drive_ohm.assign(kRows, 30.0);
  array.readout.load_ohm.assign(kCols, kLoadOhm);
  array.readout.adc_bits = 8;
  return array;
}

learn::simulation::RubberOptions velostat(std::uint64_t seed) {
  learn::simulation::RubberOptions rubber;
  rubber.seed = seed;
  rubber.resistance_at_10n_ohm = 10e3;
  rubber.resistance_spread = 0.24;
  rubber.exponent_spread = 0.1;
  rubber.contact_ohm = 1e3;
  rubber.unloaded_ohm = 20e6;
  rubber.hysteresis = 0.1;
  rubber.creep = 0.1;
  rubber.pink_noise = 1e-5;
  return rubber;
}

/// What a diode between driver and row leaves of the readings of its row, which is linear in the row's voltage.
double share_left_by_diode(double ratio_of_row) {
  constexpr double kSlopeV = 0.046;        // 1.8 kT/q
  constexpr double kSaturationA = 2.5e-9;  // a small-signal diode
  double share = 0.9;
  for (int k = 0; k < 50; ++k) {
    const double ampere = share * kSupplyV * ratio_of_row / kLoadOhm;
    share = 0.5 * (share + 1.0 - kSlopeV * std::log1p(ampere / kSaturationA) / kSupplyV);
  }
  return share;
}

struct Recording {
  std::vector<RawFrame> frames;
  std::vector<double> kpa;  ///< 0 where nothing presses [frames].
};

/// The loads in an order by chance, each after a rest.
Recording record(const ArrayDescription& array, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> kpa;
  for (std::size_t k = 0; k < kLoads; ++k) {
    kpa.push_back(kLightestKpa *
                  std::pow(kHeaviestKpa / kLightestKpa, static_cast<double>(k) / static_cast<double>(kLoads - 1)));
  }
  for (std::size_t k = kLoads - 1; k > 0; --k) std::swap(kpa[k], kpa[random.below(k + 1)]);
  kpa.insert(kpa.begin(), kUnloaded, 0.0);

  auto rubber = need(learn::simulation::ConductiveRubber::create(velostat(seed), kRows, kCols, seed));
  const auto circuit = need(learn::simulation::ReadoutCircuit::create(array));
  const learn::simulation::Adc adc(array.readout, 1.0);
  Recording recording;
  recording.kpa = kpa;
  std::vector<double> siemens(array.taxel_count());
  std::vector<double> ratio(array.taxel_count());
  for (const double pressure : kpa) {
    rubber.press(std::vector<double>(array.taxel_count(), 0.0), 0.5 * kSecondsOfLoad);
    rubber.press(std::vector<double>(array.taxel_count(), kNewtonsOfKpa * pressure), kSecondsOfLoad);
    rubber.read(25.0, siemens);
    circuit.ratios(siemens, ratio);
    for (std::size_t row = 0; row < kRows; ++row) {
      double of_row = 0.0;
      for (std::size_t col = 0; col < kCols; ++col) of_row += ratio[row * kCols + col];
      const double share = share_left_by_diode(of_row);
      for (std::size_t col = 0; col < kCols; ++col) ratio[row * kCols + col] *= share;
    }
    RawFrame frame;
    frame.time = recording.frames.size() * std::chrono::seconds(15);
    frame.counts.resize(array.taxel_count());
    adc.convert(ratio, kSupplyV, random, frame.counts);
    recording.frames.push_back(std::move(frame));
  }
  return recording;
}

struct Estimate {
  double kpa = 0.0;
  std::vector<double> newtons;  // [taxels]; 0 where there is none
};

struct Score {
  double cells = 0.0;  // median relative errors
  double totals = 0.0;
};

Score score(const std::vector<Estimate>& estimates) {
  std::vector<double> cells;
  std::vector<double> totals;
  for (const Estimate& estimate : estimates) {
    const double truth = kNewtonsOfKpa * estimate.kpa;
    double sum = 0.0;
    for (const double newtons : estimate.newtons) {
      cells.push_back(std::abs(newtons / truth - 1.0));
      sum += newtons;
    }
    totals.push_back(std::abs(sum / (truth * static_cast<double>(estimate.newtons.size())) - 1.0));
  }
  return {upper_median(std::move(cells)), upper_median(std::move(totals))};
}

/// ln F = a + b ln counts of one cell, over all loads but one.
Estimate fit_by_hand(const Recording& recording, std::size_t left_out) {
  Estimate estimate{recording.kpa[left_out], std::vector<double>(kRows * kCols)};
  for (std::size_t taxel = 0; taxel < kRows * kCols; ++taxel) {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    for (std::size_t k = kUnloaded; k < recording.frames.size(); ++k) {
      const double counts = recording.frames[k].counts[taxel];
      if (k == left_out || counts <= 0.0) continue;
      const double log_counts = std::log(counts);
      const double log_newtons = std::log(kNewtonsOfKpa * recording.kpa[k]);
      n += 1.0;
      x += log_counts;
      y += log_newtons;
      xx += log_counts * log_counts;
      xy += log_counts * log_newtons;
    }
    const double b = (n * xy - x * y) / (n * xx - x * x);
    const double counts = recording.frames[left_out].counts[taxel];
    if (counts > 0.0 && std::isfinite(b)) estimate.newtons[taxel] = std::exp((y - b * x) / n + b * std::log(counts));
  }
  return estimate;
}

std::vector<Load> labels(const Recording& recording, std::size_t left_out) {
  std::vector<Load> loads;
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    if (k == left_out) continue;
    loads.push_back({k, LoadKind::pressure, {0, 0, kRows - 1, kCols - 1}, kPascalsOfKpa * recording.kpa[k]});
  }
  return loads;
}

struct Outcome {
  Estimate estimate;
  std::size_t masked_frames = 0;
  std::size_t unsolved_frames = 0;
  std::set<std::string> faults;
  std::string circuit;
  double seconds = 0.0;
  std::string networks;
};

/// Calibrated without one load; then all frames run, as a stream.
Outcome calibrate(const ArrayDescription& array, const Recording& recording, std::size_t left_out) {
  const auto start = std::chrono::steady_clock::now();
  const auto calibration = need(learn::calibration::calibrate(array, recording.frames, labels(recording, left_out)));
  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.networks = calibration.report.training.choice;
  for (const std::string& found : calibration.report.circuit) outcome.circuit += "\n    " + found;
  outcome.estimate.kpa = recording.kpa[left_out];
  auto pipeline = need(touch::pipeline::Pipeline::create(calibration.model));
  ForceFrame force;
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    pipeline.process(recording.frames[k], force);
    const bool is_masked = std::any_of(force.taxels.begin(), force.taxels.end(), [](TaxelStatus status) {
      return status == TaxelStatus::line_fault || status == TaxelStatus::invalid;
    });
    outcome.masked_frames += is_masked ? 1 : 0;
    if (has(force.status, FrameStatus::not_converged)) {
      ++outcome.unsolved_frames;
      outcome.faults.insert(fmt::format("frame {} of {:.1f} kPa cannot be solved", k, recording.kpa[k]));
    }
    for (const touch::compensation::LineFault& fault : pipeline.line_faults().faults()) {
      outcome.faults.insert(std::string(to_string(fault.kind)) + ' ' + place_name(fault, calibration.model.array));
    }
    if (k != left_out) continue;
    for (const float newtons : force.newtons) {
      outcome.estimate.newtons.push_back(std::isfinite(newtons) ? static_cast<double>(newtons) : 0.0);
    }
  }
  return outcome;
}

void print(const char* what, const Score& found, const Score& by_hand) {
  fmt::print("{:<28} cells {:6.2f} % = {:4.2f} x, totals {:6.2f} % = {:4.2f} x\n", what, 100.0 * found.cells,
             found.cells / by_hand.cells, 100.0 * found.totals, found.totals / by_hand.totals);
}

int run(std::uint64_t seed, std::size_t every) {
  ArrayDescription array = mat();
  const Recording recording = record(array, seed);
  std::vector<std::size_t> left_out;
  for (std::size_t k = kUnloaded; k < recording.frames.size(); k += every) left_out.push_back(k);

  std::vector<Estimate> fits;
  for (const std::size_t frame : left_out) fits.push_back(fit_by_hand(recording, frame));
  const Score by_hand = score(fits);
  print("ln F = a + b ln counts", by_hand, by_hand);
  array.readout.drive_ohm.clear();
  array.readout.load_ohm.clear();
  array.readout.idle_rows = IdleRows::grounded;
  for (const Circuit circuit : {Circuit::none, Circuit::automatic}) {
    array.readout.circuit = circuit;
    std::vector<Estimate> estimates;
    std::size_t masked = 0;
    std::size_t unsolved = 0;
    double seconds = 0.0;
    std::string networks;
    for (const std::size_t frame : left_out) {
      Outcome outcome = calibrate(array, recording, frame);
      estimates.push_back(std::move(outcome.estimate));
      masked += outcome.masked_frames;
      unsolved += outcome.unsolved_frames;
      for (const std::string& fault : outcome.faults) fmt::print("  without frame {}: {}\n", frame, fault);
      if (outcome.masked_frames > 0) fmt::print("  without frame {}:{}\n", frame, outcome.circuit);
      seconds += outcome.seconds;
      networks = std::move(outcome.networks);
    }
    print(to_string(circuit), score(estimates), by_hand);
    fmt::print("  {} masked frames of {}, {} of them unsolved; {:.1f} s a calibration; {}\n", masked,
               left_out.size() * recording.frames.size(), unsolved, seconds / static_cast<double>(left_out.size()),
               networks);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  const std::size_t every = argc == 3 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if ((argc != 2 && argc != 3) || every == 0) {
    fmt::print(stderr, "usage: uniform_mat SEED [EVERY]\n");
    return 2;
  }
  return dermis::run(std::strtoull(argv[1], nullptr, 10), every);
}
