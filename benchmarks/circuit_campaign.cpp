// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// How well `circuit = "auto"` finds the circuit of random arrays, and what that costs: the median error of several
// presses at once, over that of the same calibration with the true circuit. Arrays differ in size, circuit,
// resistances, bits, rubber and unloaded readings. They are calibrated by what the guide keeps (means, at one
// temperature), by single presses, or by these and uniform loads (single frames, at five temperatures). Where the
// frames do not tell the circuit or its drivers, the presses that the fit names are added and it is fitted again.
// Usage: circuit_campaign FIRST_SEED LAST_SEED
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/calibration_plan.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/random.hpp"
#include "need.hpp"

namespace dermis {
namespace {

constexpr double kSupply = 5.0;
constexpr double kMostRatio = 1.15;   // of a median error to that with the true circuit
constexpr int kFramesOfMean = 50;     // half a second
constexpr int kUnloadedFrames = 100;  // single ones, as the guide keeps them
constexpr std::size_t kTestFrames = 200;

struct Kind {
  const char* name;
  Circuit circuit;
  IdleRows idle_rows;
  IdleColumns idle_columns;
};

constexpr Kind kKinds[] = {{"grounded rows", Circuit::divider, IdleRows::grounded, IdleColumns::loaded},
                           {"floating rows", Circuit::divider, IdleRows::floating, IdleColumns::loaded},
                           {"floating columns", Circuit::divider, IdleRows::grounded, IdleColumns::floating},
                           {"transimpedance", Circuit::transimpedance, IdleRows::grounded, IdleColumns::loaded},
                           {"flexitac", Circuit::flexitac, IdleRows::grounded, IdleColumns::loaded}};

enum class Frames { guided, single_presses, with_uniform_loads };
constexpr const char* kFramesNames[] = {"guided", "single presses", "presses and uniform loads"};

std::size_t lines(Random& random, double most) {
  return static_cast<std::size_t>(std::lround(random.log_uniform(4.0, most)));
}

std::vector<double> resistors(std::size_t count, double ohm, double spread, Random& random) {
  std::vector<double> ohms(count);
  for (double& value : ohms) value = ohm * std::exp(spread * random.normal());
  return ohms;
}

/// An array, its rubber, and how it is calibrated.
struct Specimen {
  const Kind* kind = nullptr;
  ArrayDescription array;
  learn::simulation::SimulationOptions physics;
  Frames frames = Frames::guided;
  double kept = 1.0;          ///< Share of the single presses.
  double celsius = 25.0;      ///< Of presses by hand.
  double idle_counts = 0.0;   ///< Reading of an unloaded taxel, at 20 C and without crosstalk.
  double drive_spread = 0.0;  ///< Relative.
};

void draw_readout(Random& random, Specimen& specimen) {
  constexpr double kMostSpread = 0.1;
  constexpr double kMostGain = 0.2;  // of an amplifier: a taxel at 10 N leaves room for 50 N
  Readout& readout = specimen.array.readout;
  readout.circuit = specimen.kind->circuit;
  readout.idle_rows = specimen.kind->idle_rows;
  readout.idle_columns = specimen.kind->idle_columns;
  readout.adc_bits = 8 + 2 * static_cast<int>(random.below(5));
  specimen.drive_spread = random.uniform(0.0, kMostSpread);
  double load_ohm = random.log_uniform(100.0, 10e3);
  if (readout.circuit == Circuit::transimpedance) {
    load_ohm = std::min(load_ohm, kMostGain * specimen.physics.rubber.resistance_at_10n_ohm);
  }
  readout.drive_ohm =
      resistors(specimen.array.driven_lines(), random.log_uniform(5.0, 100.0), specimen.drive_spread, random);
  readout.load_ohm = resistors(specimen.array.sensed_lines(), load_ohm, random.uniform(0.0, kMostSpread), random);
}

/// Unloaded: from 20 kohm to 10 Mohm; half of the arrays by what then is read, 0 to 5 counts.
void draw_unloaded(Random& random, Specimen& specimen) {
  constexpr double kLeastOhm = 20e3;
  constexpr double kMostOhm = 10e6;
  constexpr double kLeastRatio = 5.0;  // to a taxel at 10 N
  const Readout& readout = specimen.array.readout;
  learn::simulation::RubberOptions& rubber = specimen.physics.rubber;
  const double count_ohm = readout.load_ohm[0] * (std::exp2(readout.adc_bits) - 1.0);  // reads one count
  const double least = std::max(kLeastOhm, kLeastRatio * rubber.resistance_at_10n_ohm);
  const double by_ohm = random.log_uniform(least, kMostOhm);
  const double by_counts = count_ohm / random.uniform(0.0, 5.0);
  rubber.unloaded_ohm = std::clamp(random.below(2) == 0 ? by_ohm : by_counts, least, kMostOhm);
  specimen.idle_counts = count_ohm / rubber.unloaded_ohm;
}

Specimen draw_specimen(std::uint64_t seed) {
  constexpr double kTaxelAreaM2 = 40e-6;
  Random random(seed);
  Specimen specimen;
  specimen.kind = &kKinds[seed % std::size(kKinds)];
  specimen.frames = static_cast<Frames>(random.below(std::size(kFramesNames)));
  ArrayDescription& array = specimen.array;
  const double most_lines = specimen.frames == Frames::guided ? 32.0 : 12.0;
  array.rows = lines(random, most_lines);
  array.cols = lines(random, most_lines);
  array.taxel_area_m2 = kTaxelAreaM2;
  array.readout.supply_v = array.readout.adc_reference_v = kSupply;
  learn::simulation::RubberOptions& rubber = specimen.physics.rubber;
  rubber.seed = seed;
  rubber.resistance_at_10n_ohm = random.log_uniform(500.0, 10e3);
  if (random.below(2) == 0)
    rubber.contact_ohm = std::min(random.uniform(0.0, 200.0), 0.4 * rubber.resistance_at_10n_ohm);
  draw_readout(random, specimen);
  draw_unloaded(random, specimen);
  specimen.kept = random.uniform(0.2, 0.7);
  specimen.celsius = random.uniform(10.0, 40.0);
  return specimen;
}

struct Recording {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;

  void add(RawFrame frame, std::vector<Load> labels) {
    for (Load& label : labels) label.frame = frames.size();
    loads.insert(loads.end(), labels.begin(), labels.end());
    frame.time = std::chrono::seconds(frames.size());
    frames.push_back(std::move(frame));
  }
};

/// A scene of the simulator, and of the frames that press a share.
void play(const Specimen& specimen, std::string_view scene, std::uint64_t seed, double kept, Recording& recording,
          std::optional<std::size_t> frames = {}) {
  const auto simulator =
      need(learn::simulation::Simulator::create(specimen.array, specimen.physics, scene, seed, frames));
  Random random(seed);
  RawFrame frame;
  while (need(simulator->next(frame))) {
    const std::vector<Load>& loads = simulator->loads();
    const bool presses = std::any_of(loads.begin(), loads.end(), [](const Load& load) { return load.value > 0.0; });
    if (!presses || random.uniform() < kept) recording.add(frame, loads);
  }
}

struct Press {
  std::size_t taxel;
  double newtons;
};

/// Presses by hand, at one temperature; a guided calibration takes no notice of it.
class Hand {
 public:
  Hand(const Specimen& specimen, std::uint64_t seed)
      : array_(specimen.array),
        celsius_(specimen.celsius),
        reports_celsius_(specimen.frames != Frames::guided),
        rubber_(
            need(learn::simulation::ConductiveRubber::create(specimen.physics.rubber, array_.rows, array_.cols, seed))),
        circuit_(need(learn::simulation::ReadoutCircuit::create(array_))),
        adc_(array_.readout, specimen.physics.environment.adc_noise_lsb),
        random_(seed) {}

  /// Means of `means` frames each under the presses.
  void record(const std::vector<Press>& presses, int frames, int means, Recording& recording) {
    std::vector<double> newtons(array_.taxel_count());
    for (const Press& press : presses) newtons[press.taxel] = press.newtons;
    rubber_.press(std::vector<double>(array_.taxel_count()), 1.0);
    rubber_.press(newtons, 1.0);
    for (int k = 0; k < frames; ++k) recording.add(mean_frame(means), labels(presses));
  }

 private:
  [[nodiscard]] std::vector<Load> labels(const std::vector<Press>& presses) const {
    if (presses.empty()) return {{0, LoadKind::force, {0, 0, array_.rows - 1, array_.cols - 1}, 0.0}};
    std::vector<Load> loads;
    for (const Press& press : presses) {
      const std::size_t row = press.taxel / array_.cols;
      const std::size_t col = press.taxel % array_.cols;
      loads.push_back({0, LoadKind::force, {row, col, row, col}, press.newtons});
    }
    return loads;
  }

  RawFrame mean_frame(int means) {
    std::vector<double> siemens(array_.taxel_count());
    std::vector<double> ratio(array_.taxel_count());
    std::vector<float> counts(array_.taxel_count());
    RawFrame frame;
    frame.counts.assign(array_.taxel_count(), 0.0F);
    rubber_.read(celsius_, siemens);
    circuit_.ratios(siemens, ratio);
    for (int k = 0; k < means; ++k) {
      adc_.convert(ratio, kSupply, random_, counts);
      for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) {
        frame.counts[taxel] += counts[taxel] / static_cast<float>(means);
      }
    }
    frame.supply_v = kSupply;
    if (reports_celsius_) frame.temperature_celsius = celsius_;
    return frame;
  }

  ArrayDescription array_;
  double celsius_;
  bool reports_celsius_;
  learn::simulation::ConductiveRubber rubber_;
  learn::simulation::ReadoutCircuit circuit_;
  learn::simulation::Adc adc_;
  Random random_;
};

Recording calibration_frames(const Specimen& specimen, std::uint64_t seed, Hand& hand) {
  constexpr double kUniformShare = 0.1;
  Recording recording;
  if (specimen.frames != Frames::guided) {
    play(specimen, "calibration", seed, specimen.kept, recording);
    if (specimen.frames == Frames::with_uniform_loads) play(specimen, "uniform", seed, kUniformShare, recording);
    return recording;
  }
  const learn::calibration::CalibrationPlan plan = learn::calibration::default_plan(specimen.array);
  hand.record({}, kUnloadedFrames, 1, recording);
  for (std::size_t k = 0; k < plan.press_count(); ++k) {
    const std::size_t taxel = plan.taxels[k % plan.taxels.size()];
    hand.record({{taxel, plan.weights_n[k / plan.taxels.size()]}}, static_cast<int>(plan.frames_per_press()),
                kFramesOfMean, recording);
  }
  return recording;
}

/// Several presses at once; of a guided calibration on taxels that the guide asked for.
Recording test_frames(const Specimen& specimen, std::uint64_t seed, Hand& hand) {
  Recording recording;
  if (specimen.frames != Frames::guided) {
    play(specimen, "multitouch", seed, 1.0, recording, kTestFrames);
    return recording;
  }
  const learn::calibration::CalibrationPlan plan = learn::calibration::default_plan(specimen.array);
  Random random(seed);
  for (std::size_t k = 0; k < kTestFrames; ++k) {
    std::vector<Press> presses;
    for (std::uint64_t count = 3 + random.below(4); count > 0; --count) {
      const std::size_t taxel = plan.taxels[random.below(plan.taxels.size())];
      const double newtons = random.log_uniform(1.0, 19.0);
      const bool is_new =
          std::none_of(presses.begin(), presses.end(), [&](const Press& press) { return press.taxel == taxel; });
      if (is_new) presses.push_back({taxel, newtons});
    }
    hand.record(presses, 1, 1, recording);
  }
  return recording;
}

struct Outcome {
  std::string circuit;  // the kind that was taken, or why there is no model
  bool is_right = false;
  bool is_none = false;
  bool is_distinguishable = true;
  double median = 1.0;
  double seconds = 0.0;
  learn::calibration::Coverage coverage;
  std::vector<learn::calibration::PressPair> presses;  // that are asked for
};

bool is_kind(const Readout& readout, const Kind& kind) {
  return readout.circuit == kind.circuit && readout.idle_rows == kind.idle_rows &&
         readout.idle_columns == kind.idle_columns;
}

std::string name_of(const Readout& readout) {
  const auto* const kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                        [&](const Kind& candidate) { return is_kind(readout, candidate); });
  return kind == std::end(kKinds) ? to_string(readout.circuit) : kind->name;
}

Outcome calibrate(const ArrayDescription& array, const Kind& truth, const Recording& recording,
                  const Recording& judged) {
  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  const auto database = learn::calibration::build_sample_database(array, recording.frames, recording.loads);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!database) {
    outcome.circuit = database.error().message;
    return outcome;
  }
  if (database->circuit_fit) {
    const learn::calibration::CircuitFit& fit = *database->circuit_fit;
    outcome.is_distinguishable = std::none_of(fit.candidates.begin(), fit.candidates.end(),
                                              [](const auto& candidate) { return candidate.indistinguishable; });
    outcome.presses = outcome.is_distinguishable ? fit.driver_presses : fit.discriminating_presses;
  }
  outcome.circuit = name_of(database->array.readout);
  outcome.is_right = is_kind(database->array.readout, truth);
  outcome.is_none = database->array.readout.circuit == Circuit::none;
  const auto model = learn::calibration::calibrate(*database);
  if (!model) {
    outcome.circuit += ": " + model.error().message;
    return outcome;
  }
  const auto evaluation = need(learn::calibration::evaluate(model->model, judged.frames, judged.loads));
  outcome.median = evaluation.estimators.front().relative_error.median.value_or(1.0);
  outcome.coverage = evaluation.coverage;
  return outcome;
}

struct Tally {
  int arrays = 0;
  int right = 0;
  int doubted = 0;
  int wrong = 0;
  int none = 0;
  int over = 0;  // of those that are told
};

void count(const Outcome& found, const Outcome& known, Tally& tally) {
  ++tally.arrays;
  if (found.is_none) ++tally.none;
  if (!found.is_distinguishable) {
    ++tally.doubted;
    return;
  }
  ++(found.is_right ? tally.right : tally.wrong);
  if (found.median > kMostRatio * known.median) ++tally.over;
}

void print(std::uint64_t seed, const Specimen& specimen, const Outcome& found, const Outcome& known, bool asked) {
  const ArrayDescription& truth = specimen.array;
  const learn::simulation::RubberOptions& rubber = specimen.physics.rubber;
  const std::string verdict = !found.is_distinguishable ? "cannot tell"
                              : found.is_right          ? "right"
                                                        : "WRONG: " + found.circuit;
  fmt::print(
      "seed {}: {}x{} {}, {}, drivers {:.0f} ohm +- {:.0f} %, loads {:.0f} ohm, {} bit, rubber {:.0f} ohm at 10 N, "
      "{:.0f} "
      "unloaded ({:.1f} counts), contact {:.0f}: {}{}, median {:.2f} % = {:.2f} x, coverage {:.0f} / {:.0f} %, {:.1f} "
      "s\n",
      seed, truth.rows, truth.cols, specimen.kind->name, kFramesNames[static_cast<std::size_t>(specimen.frames)],
      truth.readout.drive_ohm[0], 100.0 * specimen.drive_spread, truth.readout.load_ohm[0], truth.readout.adc_bits,
      rubber.resistance_at_10n_ohm, rubber.unloaded_ohm, specimen.idle_counts, rubber.contact_ohm, verdict,
      asked ? " after further presses" : "", 100.0 * found.median, found.median / known.median,
      100.0 * found.coverage.share_68.value_or(0.0), 100.0 * found.coverage.share_95.value_or(0.0), found.seconds);
  std::fflush(stdout);
}

void judge(std::uint64_t seed, Tally& tally) {
  const Specimen specimen = draw_specimen(seed);
  Hand hand(specimen, seed);
  Recording recording = calibration_frames(specimen, seed, hand);
  const Recording judged = test_frames(specimen, seed, hand);
  ArrayDescription unknown = specimen.array;
  unknown.readout = {};
  unknown.readout.circuit = Circuit::automatic;
  unknown.readout.adc_bits = specimen.array.readout.adc_bits;
  unknown.readout.supply_v = specimen.array.readout.supply_v;
  unknown.readout.adc_reference_v = specimen.array.readout.adc_reference_v;
  Outcome found = calibrate(unknown, *specimen.kind, recording, judged);
  const bool asks = !found.presses.empty();
  if (asks) {
    for (const learn::calibration::PressPair& pair : found.presses) {
      hand.record({{pair.first, pair.newtons}, {pair.second, pair.newtons}}, 2, kFramesOfMean, recording);
    }
    found = calibrate(unknown, *specimen.kind, recording, judged);
  }
  const Outcome known = calibrate(specimen.array, *specimen.kind, recording, judged);
  count(found, known, tally);
  print(seed, specimen, found, known, asks);
}

int run(std::uint64_t first, std::uint64_t last) {
  Tally tally;
  for (std::uint64_t seed = first; seed <= last; ++seed) judge(seed, tally);
  fmt::print(
      "{} arrays: right {}, cannot tell {}, wrong {}; \"none\" in {}; of {} that were told, the median error is over "
      "{} x that with the true circuit in {}\n",
      tally.arrays, tally.right, tally.doubted, tally.wrong, tally.none, tally.right + tally.wrong, kMostRatio,
      tally.over);
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
