// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/bank_reproduction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/simulation/reference_array.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/paper/structured_start.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"

namespace dermis::paper {
namespace {

using learn::calibration::SampleDatabase;

constexpr std::uint64_t kCalibrationSeed = 1;
constexpr std::uint64_t kPointsSeed = 3;
constexpr std::uint64_t kBankSeed = 1;
constexpr float kDescentRate = 2.0F;

struct Recording {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

Result<Recording> record(const ArrayDescription& array, const char* scene, std::uint64_t seed) {
  auto simulator = learn::simulation::Simulator::create(array, {}, scene, seed);
  if (!simulator) return simulator.error();
  Recording recording;
  RawFrame frame;
  for (std::size_t k = 0; k < (*simulator)->frame_count(); ++k) {
    const Result<bool> more = (*simulator)->next(frame);
    if (!more) return more.error();
    recording.frames.push_back(frame);
    const std::vector<Load>& loads = (*simulator)->loads();
    recording.loads.insert(recording.loads.end(), loads.begin(), loads.end());
  }
  return recording;
}

/// Largest deviation of eq. (7) to (10), or of the rows of eq. (12): `off` and `on` are the least and the greatest
/// input.
double deviation(const GridWeights& weights, std::size_t neighbours, std::size_t others, double off, double on) {
  const auto b = static_cast<double>(neighbours);
  const auto c = static_cast<double>(others);
  const auto sum = [&](double same, double neighbour, double other_sum) {
    return weights.same * same + weights.neighbour * b * neighbour + weights.other * other_sum + weights.threshold;
  };
  const double ln3 = std::log(3.0);
  return std::max({std::abs(sum(on, on, c * on) - ln3), std::abs(sum(on, off, c * off) - ln3),
                   std::abs(sum(off, off, (c - 1.0) * off + on) + ln3), std::abs(sum(off, off, c * off) + ln3)});
}

/// Eq. (11) and (12) at a place in the middle, at an edge and in a corner, and eq. (15).
std::vector<StartSystem> start_systems(std::size_t taxels) {
  std::vector<StartSystem> systems;
  const std::array<std::pair<const char*, std::size_t>, 3> places{{{"centre", 8}, {"edge", 5}, {"corner", 3}}};
  for (const auto& [where, neighbours] : places) {
    const std::size_t others = taxels - 1 - neighbours;
    const GridWeights first = first_layer_weights(neighbours, others, 1.0);
    const GridWeights second = second_layer_weights(neighbours, others);
    systems.push_back({"(11)", where, neighbours, first.same, first.neighbour, first.other, first.threshold,
                       deviation(first, neighbours, others, 0.0, 1.0)});
    systems.push_back({"(12)", where, neighbours, second.same, second.neighbour, second.other, second.threshold,
                       deviation(second, neighbours, others, 0.25, 0.75)});
  }
  const OutputWeights output = output_layer_weights(taxels);
  const auto count = static_cast<double>(taxels);
  const double off = std::abs(count * 0.25 * output.weight + output.threshold + std::log(3.0));
  const double on = std::abs(count * 0.75 * output.weight + output.threshold - std::log(3.0));
  systems.push_back(
      {"(15)", "output", 0, output.weight, std::nullopt, std::nullopt, output.threshold, std::max(off, on)});
  return systems;
}

TrainingCurve descend(BankTraining& training, BankStart start, const char* name, std::size_t steps,
                      const std::function<void(double)>& progress) {
  TrainingCurve curve{name, {}, {}};
  BankStep step;
  step.rate = kDescentRate;
  training.start(start);
  for (std::size_t k = 1; k <= steps; ++k) {
    curve.step.push_back(static_cast<double>(k));
    curve.value.push_back(training.step(step));
    progress(static_cast<double>(k) / static_cast<double>(steps));
  }
  return curve;
}

/// The voltage that the calibration gives for a taxel and a force: between its presses, straight in logarithms.
double calibration_volts(const SampleDatabase& database, std::size_t taxel, double newtons, double supply_v) {
  std::vector<std::pair<double, double>> presses;  // ln force, ln ratio
  for (const learn::calibration::Sample& sample : database.samples) {
    const double force = sample.known_newtons[taxel];
    const auto ratio = static_cast<double>(sample.ratio[taxel]);
    if (force > 0.0 && ratio > 0.0) presses.emplace_back(std::log(force), std::log(ratio));
  }
  std::sort(presses.begin(), presses.end());
  const auto above = std::lower_bound(presses.begin(), presses.end(), std::pair{std::log(newtons) - 1e-9, -1e300});
  if (above == presses.end()) return std::numeric_limits<double>::quiet_NaN();
  if (above == presses.begin()) return supply_v * std::exp(above->second);
  const auto below = std::prev(above);
  const double share = (std::log(newtons) - below->first) / (above->first - below->first);
  return supply_v * std::exp(below->second + share * (above->second - below->second));
}

std::vector<PaperPoint> list_points(const ArrayDescription& array, const SampleDatabase& database,
                                    const Recording& points, const learn::calibration::Evaluation& evaluation) {
  std::vector<PaperPoint> listed;
  touch::preprocessing::Conditioner conditioner(array);
  std::vector<ConditionedFrame> conditioned(points.frames.size());
  for (std::size_t k = 0; k < conditioned.size(); ++k) conditioner.process(points.frames[k], conditioned[k]);
  for (const learn::calibration::JudgedTaxel& judged : evaluation.taxels) {
    listed.push_back({array.taxel_name(judged.taxel), judged.true_newtons,
                      *array.readout.supply_v * conditioned[judged.frame].ratio[judged.taxel],
                      calibration_volts(database, judged.taxel, judged.true_newtons, *array.readout.supply_v),
                      double{judged.newtons.back()}, double{judged.newtons.front()}});
  }
  return listed;
}

void note_curve(const std::vector<double>& errors, TrainingCurve& curve) {
  curve.name = "Adam from the paper's start";
  for (std::size_t k = 0; k < errors.size(); ++k) {
    curve.step.push_back(static_cast<double>(k + 1));
    curve.value.push_back(errors[k]);
  }
}

/// Gradient descent from the paper's start and from two of today.
Status descend_from_each_start(BankTraining& training, const BankEffort& effort,
                               const std::function<void(const std::string&, double)>& progress,
                               PaperReproduction& found) {
  const std::array<std::pair<BankStart, const char*>, 3> starts{{{BankStart::structured, "the paper's start"},
                                                                 {BankStart::nguyen_widrow, "Nguyen-Widrow"},
                                                                 {BankStart::xavier, "Xavier"}}};
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const auto on_share = [&](double share) {
      progress("convergence", (static_cast<double>(k) + share) / static_cast<double>(starts.size()));
    };
    found.convergence.push_back(
        descend(training, starts[k].first, starts[k].second, effort.convergence_steps, on_share));
    if (!std::isfinite(found.convergence.back().value.back())) return failed("gradient descent of the bank diverged");
  }
  return Done{};
}

}  // namespace

ArrayDescription paper_array(std::size_t rows, std::size_t cols) {
  ArrayDescription array = learn::simulation::reference_array({rows, cols});
  array.name = "paper";
  return array;
}

Status reproduce_bank(const ArrayDescription& array, const BankEffort& effort,
                      const std::function<void(const std::string&, double)>& progress, PaperReproduction& found) {
  found.rows = array.rows;
  found.cols = array.cols;
  found.start = start_systems(array.taxel_count());
  const Result<Recording> presses = record(array, "paper_calibration", kCalibrationSeed);
  if (!presses) return presses.error();
  const Result<SampleDatabase> database =
      learn::calibration::build_sample_database(array, presses->frames, presses->loads);
  if (!database) return database.error();
  auto calibrated = learn::calibration::calibrate(*database);
  if (!calibrated) return calibrated.error();

  Result<BankTraining> training = BankTraining::create(*database, kBankSeed);
  if (!training) return training.error();
  found.unknowns = training->bank().networks().parameter_count();
  if (Status descended = descend_from_each_start(*training, effort, progress, found); !descended) return descended;

  Result<TrainedBank> trained = train_paper_bank(
      *database,
      {.steps = effort.training_steps, .seed = kBankSeed, .progress = [&](double share) { progress("bank", share); }});
  if (!trained) return trained.error();
  note_curve(trained->report.curve, found.bank_training);
  found.bank_samples = database->samples.size();
  found.own_samples = static_cast<std::size_t>(
      std::count_if(database->samples.begin(), database->samples.end(),
                    [](const learn::calibration::Sample& sample) { return sample.known_newtons.front() > 0.0F; }));

  const Result<Recording> points = record(array, "paper", kPointsSeed);
  if (!points) return points.error();
  Result<learn::calibration::Evaluation> evaluation =
      learn::calibration::evaluate(calibrated->model, points->frames, points->loads, &trained->bank);
  if (!evaluation) return evaluation.error();
  found.points = list_points(array, *database, *points, *evaluation);
  found.evaluation = std::move(*evaluation);
  found.model = std::move(calibrated->model);
  return Done{};
}

}  // namespace dermis::paper
