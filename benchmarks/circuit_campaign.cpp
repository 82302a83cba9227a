// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// How well `circuit = "auto"` finds the circuit of random arrays that are calibrated by what the guide asks for, and
// what that costs: the median error of several presses at once, over that of the same calibration with the true
// circuit. Where the frames cannot tell, the presses that the fit names are added and it is fitted again. Usage:
// circuit_campaign FIRST_SEED LAST_SEED
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/calibration/calibrate.hpp"
#include "dermis/calibration/calibration_plan.hpp"
#include "dermis/calibration/evaluation.hpp"
#include "dermis/calibration/sample_database.hpp"
#include "dermis/core/random.hpp"
#include "dermis/simulation/adc.hpp"
#include "dermis/simulation/readout_circuit.hpp"
#include "dermis/simulation/rubber.hpp"

namespace dermis {
namespace {

constexpr double kCelsius = 25.0;
constexpr int kFramesOfMean = 25;     // a quarter of a second
constexpr int kUnloadedFrames = 100;  // single ones, as the guide keeps them
constexpr int kTestFrames = 150;

template <typename T>
T need(Result<T> result) {
  if (result) return *std::move(result);
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}

struct Kind {
  Circuit circuit;
  IdleRows idle_rows;
  IdleColumns idle_columns;
};

constexpr Kind kKinds[] = {{Circuit::divider, IdleRows::grounded, IdleColumns::loaded},
                           {Circuit::divider, IdleRows::floating, IdleColumns::loaded},
                           {Circuit::divider, IdleRows::grounded, IdleColumns::floating},
                           {Circuit::transimpedance, IdleRows::grounded, IdleColumns::loaded},
                           {Circuit::flexitac, IdleRows::grounded, IdleColumns::loaded}};

std::size_t lines(Random& random) {
  return static_cast<std::size_t>(std::lround(random.log_uniform(4.0, 32.0)));
}

std::vector<double> resistors(std::size_t count, double ohm, Random& random) {
  constexpr double kSpread = 0.03;
  std::vector<double> ohms(count);
  for (double& value : ohms) value = ohm * std::exp(kSpread * random.normal());
  return ohms;
}

/// An array and its rubber.
struct Specimen {
  ArrayDescription array;
  simulation::RubberOptions rubber;
};

Specimen draw_specimen(std::uint64_t seed) {
  Random random(seed);
  const Kind& kind = kKinds[seed % std::size(kKinds)];
  Specimen specimen;
  ArrayDescription& array = specimen.array;
  array.rows = lines(random);
  array.cols = lines(random);
  Readout& readout = array.readout;
  readout.circuit = kind.circuit;
  readout.idle_rows = kind.idle_rows;
  readout.idle_columns = kind.idle_columns;
  readout.drive_ohm = resistors(array.driven_lines(), random.log_uniform(5.0, 100.0), random);
  readout.load_ohm = resistors(array.sensed_lines(), random.log_uniform(100.0, 10e3), random);
  readout.adc_bits = 10 + 2 * static_cast<int>(random.below(4));
  simulation::RubberOptions& rubber = specimen.rubber;
  rubber.seed = seed;
  rubber.resistance_at_10n_ohm = random.log_uniform(500.0, 10e3);
  rubber.unloaded_ohm = random.log_uniform(5.0 * rubber.resistance_at_10n_ohm, 100e3);
  rubber.contact_ohm = std::min(random.uniform(0.0, 200.0), 0.4 * rubber.resistance_at_10n_ohm);
  return specimen;
}

struct Recording {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

struct Press {
  std::size_t taxel;
  double newtons;
};

class Rig {
 public:
  Rig(const Specimen& specimen, std::uint64_t seed)
      : array_(specimen.array),
        rubber_(need(simulation::ConductiveRubber::create(specimen.rubber, array_.rows, array_.cols, seed))),
        circuit_(need(simulation::ReadoutCircuit::create(array_))),
        adc_(array_.readout, 1.0),
        random_(seed) {}

  /// Means of `means` frames each under the presses.
  void record(const std::vector<Press>& presses, int frames, int means, Recording& recording) {
    std::vector<double> newtons(array_.taxel_count());
    for (const Press& press : presses) newtons[press.taxel] = press.newtons;
    rubber_.press(std::vector<double>(array_.taxel_count()), 1.0);
    rubber_.press(newtons, 1.0);
    for (int k = 0; k < frames; ++k) {
      label(presses, recording);
      recording.frames.push_back(mean_frame(means));
    }
  }

 private:
  void label(const std::vector<Press>& presses, Recording& recording) const {
    const std::size_t frame = recording.frames.size();
    if (presses.empty()) {
      recording.loads.push_back({frame, LoadKind::force, {0, 0, array_.rows - 1, array_.cols - 1}, 0.0});
    }
    for (const Press& press : presses) {
      const std::size_t row = press.taxel / array_.cols;
      const std::size_t col = press.taxel % array_.cols;
      recording.loads.push_back({frame, LoadKind::force, {row, col, row, col}, press.newtons});
    }
  }

  RawFrame mean_frame(int means) {
    std::vector<double> siemens(array_.taxel_count());
    std::vector<double> ratio(array_.taxel_count());
    std::vector<float> counts(array_.taxel_count());
    RawFrame frame;
    frame.counts.assign(array_.taxel_count(), 0.0F);
    rubber_.read(kCelsius, siemens);
    circuit_.ratios(siemens, ratio);
    for (int k = 0; k < means; ++k) {
      adc_.convert(ratio, 5.0, random_, counts);
      for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) {
        frame.counts[taxel] += counts[taxel] / static_cast<float>(means);
      }
    }
    time_ += std::chrono::milliseconds(500);
    frame.time = time_;
    frame.supply_v = 5.0;
    return frame;
  }

  ArrayDescription array_;
  simulation::ConductiveRubber rubber_;
  simulation::ReadoutCircuit circuit_;
  simulation::Adc adc_;
  Random random_;
  Nanos time_{0};
};

Recording guided(Rig& rig, const calibration::CalibrationPlan& plan) {
  Recording recording;
  rig.record({}, kUnloadedFrames, 1, recording);
  for (std::size_t k = 0; k < plan.press_count(); ++k) {
    rig.record({{plan.taxel_of(k), plan.weight_of(k)}}, static_cast<int>(plan.frames_per_press()), 2 * kFramesOfMean,
               recording);
  }
  return recording;
}

/// Several presses at once on taxels that the guide asked for.
Recording test(Rig& rig, const calibration::CalibrationPlan& plan, std::uint64_t seed) {
  Random random(seed);
  Recording recording;
  for (int k = 0; k < kTestFrames; ++k) {
    std::vector<Press> presses;
    for (std::uint64_t count = 3 + random.below(4); count > 0; --count) {
      const std::size_t taxel = plan.taxels[random.below(plan.taxels.size())];
      const double newtons = random.log_uniform(1.0, 19.0);
      const bool is_new =
          std::none_of(presses.begin(), presses.end(), [&](const Press& press) { return press.taxel == taxel; });
      if (is_new) presses.push_back({taxel, newtons});
    }
    rig.record(presses, 1, 1, recording);
  }
  return recording;
}

struct Outcome {
  std::string circuit;
  bool is_right = false;
  bool is_told = true;
  double median = 1.0;
  double seconds = 0.0;
  calibration::Coverage coverage;
  std::vector<std::string> statements;
  std::optional<calibration::CircuitFit> fit;
};

Outcome calibrate(const ArrayDescription& array, const ArrayDescription& truth, const Recording& recording,
                  const Recording& judged) {
  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  const auto database = calibration::build_sample_database(array, recording.frames, recording.loads);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!database) {
    outcome.statements = {database.error().message};
    return outcome;
  }
  if (database->circuit_fit) {
    outcome.fit = database->circuit_fit;
    outcome.statements = database->circuit_fit->statements;
    for (const auto& candidate : database->circuit_fit->candidates) {
      if (candidate.chosen) outcome.circuit = candidate.name;
      if (candidate.indistinguishable) outcome.is_told = false;
    }
  }
  const Readout& found = database->array.readout;
  outcome.is_right = found.circuit == truth.readout.circuit && found.idle_rows == truth.readout.idle_rows &&
                     found.idle_columns == truth.readout.idle_columns;
  const auto model = calibration::calibrate(*database);
  if (!model) {
    outcome.statements.push_back(model.error().message);
    return outcome;
  }
  const auto evaluation = need(calibration::evaluate(model->model, judged.frames, judged.loads));
  outcome.median = evaluation.estimators.front().relative_error.median.value_or(1.0);
  outcome.coverage = evaluation.coverage;
  return outcome;
}

struct Tally {
  int arrays = 0;
  int right = 0;
  int doubted = 0;
  int wrong = 0;
  int within = 0;
};

void print(const char* what, const Outcome& outcome, double best) {
  fmt::print("    {:<8} {:<32} {:<5} {:<11} median {:6.2f} % = {:5.2f} x, coverage {:2.0f} / {:2.0f} %, {:.1f} s\n",
             what, outcome.circuit, outcome.is_right ? "right" : "WRONG", outcome.is_told ? "" : "cannot tell",
             100.0 * outcome.median, outcome.median / best, 100.0 * outcome.coverage.share_68.value_or(0.0),
             100.0 * outcome.coverage.share_95.value_or(0.0), outcome.seconds);
  for (const std::string& statement : outcome.statements) fmt::print("      {}\n", statement);
}

void judge(std::uint64_t seed, Tally& tally) {
  const Specimen specimen = draw_specimen(seed);
  const ArrayDescription& truth = specimen.array;
  const Readout& readout = truth.readout;
  fmt::print(
      "seed {}: {}x{} {}{}{}, drivers {:.0f} ohm, loads {:.0f} ohm, {} bit, rubber {:.0f} ohm at 10 N, {:.0f} "
      "unloaded, contact {:.0f}\n",
      seed, truth.rows, truth.cols, to_string(readout.circuit),
      readout.idle_rows == IdleRows::floating ? ", floating rows" : "",
      readout.idle_columns == IdleColumns::floating ? ", floating columns" : "", readout.drive_ohm[0],
      readout.load_ohm[0], readout.adc_bits, specimen.rubber.resistance_at_10n_ohm, specimen.rubber.unloaded_ohm,
      specimen.rubber.contact_ohm);
  Rig rig(specimen, seed);
  const calibration::CalibrationPlan plan = calibration::default_plan(truth);
  Recording recording = guided(rig, plan);
  const Recording judged = test(rig, plan, seed);
  ArrayDescription unknown = truth;
  unknown.readout = {};
  unknown.readout.circuit = Circuit::automatic;
  unknown.readout.adc_bits = readout.adc_bits;
  Outcome known = calibrate(truth, truth, recording, judged);
  print("true", known, known.median);
  Outcome found = calibrate(unknown, truth, recording, judged);
  print("auto", found, known.median);
  if (!found.is_told && !found.fit->telling_presses.empty()) {
    for (const calibration::PressPair& pair : found.fit->telling_presses) {
      rig.record({{pair.first, pair.newtons}, {pair.second, pair.newtons}}, 2, 2 * kFramesOfMean, recording);
    }
    known = calibrate(truth, truth, recording, judged);
    found = calibrate(unknown, truth, recording, judged);
    print("again", found, known.median);
  }
  ++tally.arrays;
  if (!found.is_told) {
    ++tally.doubted;
  } else {
    ++(found.is_right ? tally.right : tally.wrong);
  }
  if (found.median <= 1.15 * known.median) ++tally.within;
  std::fflush(stdout);
}

int run(std::uint64_t first, std::uint64_t last) {
  Tally tally;
  for (std::uint64_t seed = first; seed <= last; ++seed) judge(seed, tally);
  fmt::print("{} arrays: right {}, cannot tell {}, wrong {}; median error within 1.15 x of the true circuit's in {}\n",
             tally.arrays, tally.right, tally.doubted, tally.wrong, tally.within);
  return 0;
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: circuit_campaign FIRST_SEED LAST_SEED\n");
    return 2;
  }
  return dermis::run(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10));
}
