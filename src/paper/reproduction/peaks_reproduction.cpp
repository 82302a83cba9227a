// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/peaks_reproduction.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/paper/initialisation.hpp"
#include "dermis/paper/peaks.hpp"
#include "dermis/paper/training.hpp"
#include "dermis/touch/frames/random.hpp"
#include "paper/training/levenberg_marquardt.hpp"

namespace dermis::paper {
namespace {

constexpr double kGoal = 0.001;  // epsilon of eq. (2)
constexpr std::size_t kPaperHidden = 5;
constexpr std::size_t kStartsAtOnce = 8;
constexpr double kStartRange = 3.0;  // wide starts find better minima than Nguyen-Widrow's, by trial

/// Fig. 5: log-sigmoid hidden units, purelin output.
NetworkShape peaks_shape(std::size_t hidden) {
  return {2, {{hidden, Activation::log_sigmoid}, {1, Activation::linear}}};
}

/// One trained network.
struct Fit {
  double mse = std::numeric_limits<double>::infinity();  // eq. (2)
  std::vector<double> parameters;
};

std::uint64_t seed(std::size_t hidden, std::size_t start) {
  return Random::stream(hidden, start).bits();
}

class PeaksExperiment {
 public:
  PeaksExperiment() : peaks_(peaks_samples()) {
    const auto [least, greatest] = std::minmax_element(peaks_.targets.begin(), peaks_.targets.end());
    range_ = *greatest - *least;
  }

  [[nodiscard]] const PeaksSamples& peaks() const { return peaks_; }
  [[nodiscard]] double range() const { return range_; }
  /// The goal for targets scaled to [0, 1], in the units of the function.
  [[nodiscard]] double normalised_goal() const { return kGoal * range_ * range_; }

  [[nodiscard]] double variance() const {
    const auto count = static_cast<double>(PeaksSamples::kCount);
    const double mean = std::accumulate(peaks_.targets.begin(), peaks_.targets.end(), 0.0) / count;
    const double square =
        std::inner_product(peaks_.targets.begin(), peaks_.targets.end(), peaks_.targets.begin(), 0.0) / count;
    return square - mean * mean;
  }

  [[nodiscard]] std::vector<double> output(const NetworkShape& shape, const std::vector<double>& parameters) const {
    std::vector<double> output(PeaksSamples::kCount);
    FeedForward<double>(shape).evaluate(parameters, peaks_.inputs, output);
    return output;
  }

  /// Levenberg-Marquardt from one random start.
  [[nodiscard]] Fit levenberg_marquardt(std::size_t hidden, std::size_t start, int iterations) const {
    const NetworkShape shape = peaks_shape(hidden);
    FeedForward<double> engine(shape);
    const PackedSamples<double> packed(shape, samples());
    Fit fit;
    fit.parameters = uniform_start<double>(shape, kStartRange, seed(hidden, start));
    touch::network::LevenbergMarquardtOptions options;
    options.max_iterations = iterations;
    options.error_goal = 0.5 * kGoal * static_cast<double>(PeaksSamples::kCount);  // eq. (2) in terms of eq. (6)
    options.relative_reduction = 1e-7;
    options.initial_damping = 1.0;
    const auto report = minimise(engine, packed, fit.parameters, options);
    fit.mse = 2.0 * report.final_error / static_cast<double>(PeaksSamples::kCount);
    return fit;
  }

  /// The paper's algorithm from one random start, Nguyen-Widrow's as in MATLAB.
  [[nodiscard]] TrainingState<double> adaptive_rate(std::size_t start, std::uint64_t epochs) const {
    TrainingOptions options;
    options.epochs = epochs;
    options.error_goal = kGoal;
    const NetworkShape shape = peaks_shape(kPaperHidden);
    const std::vector<InputRange> ranges = input_ranges(samples(), shape.inputs);
    auto state = start_training(shape, nguyen_widrow_start<double>(shape, ranges, seed(kPaperHidden, start)), options);
    // The samples are Peaks itself: train() has nothing to refuse.
    static_cast<void>(train(state, samples(), options));
    return state;
  }

 private:
  [[nodiscard]] Samples<double> samples() const { return {PeaksSamples::kCount, peaks_.inputs, peaks_.targets, {}}; }

  PeaksSamples peaks_;
  double range_ = 0.0;
};

void note(const Fit& best, const PeaksExperiment& experiment, HiddenLayerFit& result) {
  result.best_mse = best.mse;
  result.best_mse_normalised = best.mse / (experiment.range() * experiment.range());
}

/// The best of random starts first ... last - 1; ends early once one has reached the goal.
void try_starts(const PeaksExperiment& experiment, std::size_t first, std::size_t last, int iterations, double goal,
                HiddenLayerFit& result, Fit& best) {
  for (; first < last && best.mse > goal; first += kStartsAtOnce) {
    std::vector<Fit> fits(std::min(kStartsAtOnce, last - first));
    learn::calibration::parallel_for(fits.size(), [&](std::size_t k) {
      fits[k] = experiment.levenberg_marquardt(result.hidden, first + k, iterations);
    });
    result.starts += fits.size();
    for (Fit& fit : fits) {
      if (fit.mse < best.mse) best = std::move(fit);
    }
  }
  note(best, experiment, result);
}

struct SizeSearch {
  std::vector<HiddenLayerFit> fits;  // from kPaperHidden on, one by one
  std::vector<Fit> best;
};

std::optional<std::size_t> smallest(const SizeSearch& search, double goal) {
  for (const HiddenLayerFit& fit : search.fits) {
    if (fit.best_mse <= goal) return fit.hidden;
  }
  return std::nullopt;
}

/// The sizes just below the smallest that reached a goal are given further starts, as long as that brings it down.
void try_harder_below(double goal, const PeaksExperiment& experiment, const PeaksEffort& effort, SizeSearch& search) {
  for (std::optional<std::size_t> reached = smallest(search, goal); reached && *reached > kPaperHidden;) {
    const std::size_t below = *reached - 1 - kPaperHidden;
    HiddenLayerFit& fit = search.fits[below];
    const std::size_t starts = effort.starts_times_size_squared / (fit.hidden * fit.hidden);
    try_starts(experiment, fit.starts, starts, effort.iterations, goal, fit, search.best[below]);
    if (fit.best_mse > goal) return;
    reached = smallest(search, goal);
  }
}

SizeSearch search_sizes(const PeaksExperiment& experiment, const PeaksEffort& effort,
                        const std::function<void(double)>& progress) {
  SizeSearch search;
  for (std::size_t hidden = kPaperHidden; hidden <= effort.most_hidden; ++hidden) {
    search.fits.push_back({hidden, 0, 0.0, 0.0});
    search.best.emplace_back();
    const std::size_t starts = hidden == kPaperHidden ? effort.paper_size_starts : effort.starts;
    try_starts(experiment, 0, starts, effort.iterations, kGoal, search.fits.back(), search.best.back());
    progress(static_cast<double>(hidden) / static_cast<double>(effort.most_hidden));
    if (search.fits.back().best_mse <= kGoal) break;
  }
  try_harder_below(experiment.normalised_goal(), experiment, effort, search);
  try_harder_below(kGoal, experiment, effort, search);
  return search;
}

TrainingCurve drawn(const ErrorCurve& curve, std::string name) {
  constexpr std::size_t kPoints = 500;
  TrainingCurve drawn{std::move(name), {}, {}};
  const std::size_t step = std::max<std::size_t>(1, curve.errors.size() / kPoints);
  for (std::size_t k = step; k < curve.errors.size(); k += step) {
    drawn.step.push_back(static_cast<double>(k * curve.stride));
    drawn.value.push_back(curve.errors[k]);
  }
  return drawn;
}

void reproduce_adaptive_rate(const PeaksExperiment& experiment, const PeaksEffort& effort, Fit& best,
                             HiddenLayerFit& fit_of_paper_size, PeaksReproduction& found) {
  std::vector<TrainingState<double>> states(effort.adaptive_rate_starts);
  learn::calibration::parallel_for(states.size(), [&](std::size_t start) {
    states[start] = experiment.adaptive_rate(start, effort.adaptive_rate_epochs);
  });
  const auto& winner = *std::min_element(states.begin(), states.end(),
                                         [](const auto& a, const auto& b) { return a.best_error < b.best_error; });
  found.adaptive_rate_starts = states.size();
  found.adaptive_rate_epochs = effort.adaptive_rate_epochs;
  found.adaptive_rate_best_mse = winner.best_error;
  found.adaptive_rate_curve = drawn(winner.curve, "2-5-1, adaptive rate with momentum");
  if (winner.best_error >= best.mse) return;
  best = {winner.best_error, winner.best_parameters};
  note(best, experiment, fit_of_paper_size);
}

}  // namespace

PeaksReproduction reproduce_peaks(const PeaksEffort& effort, const std::function<void(double)>& progress) {
  const PeaksExperiment experiment;
  PeaksReproduction found;
  found.goal = kGoal;
  found.variance = experiment.variance();
  found.range = experiment.range();
  SizeSearch search = search_sizes(experiment, effort, progress);
  Fit& best = search.best.front();
  reproduce_adaptive_rate(experiment, effort, best, search.fits.front(), found);
  found.side = PeaksSamples::kSide;
  found.target = experiment.peaks().targets;
  found.output = experiment.output(peaks_shape(kPaperHidden), best.parameters);
  found.smallest_hidden_raw = smallest(search, kGoal);
  found.smallest_hidden_normalised = smallest(search, experiment.normalised_goal());
  found.by_hidden = std::move(search.fits);
  progress(1.0);
  return found;
}

}  // namespace dermis::paper
