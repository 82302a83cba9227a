// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// Taxels are judged by relative error from this share of the heaviest load of a taxel in the calibration. If readings
/// are forces already, it is the heaviest in the evaluation.
inline constexpr double kJudgedShare = 0.02;

/// An estimator from outside that is judged beside dermis and the baselines.
class FurtherEstimator {
 public:
  virtual ~FurtherEstimator() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string description() const = 0;  ///< For the legend of a report.
  [[nodiscard]] virtual std::size_t taxel_count() const noexcept = 0;

  /// ratio = reading / supply [taxels] -> newtons [taxels].
  virtual void estimate(std::span<const double> ratio, std::optional<double> temperature_celsius,
                        std::span<float> newtons) = 0;
};

/// Percentiles of a set of errors; all empty where nothing was judged.
struct ErrorSummary {
  std::size_t count = 0;
  std::optional<double> median;
  std::optional<double> p95;
  std::optional<double> p99;
  std::optional<double> max;
};

/// Nearest-rank percentiles; NaN errors (a taxel without a force) count as the worst.
[[nodiscard]] ErrorSummary summarise(std::vector<double> errors);

/// How often the true force lies within a multiple of dermis' standard deviation of its force.
struct Coverage {
  std::size_t count = 0;           ///< Judged taxels whose standard deviation is a finite number.
  std::optional<double> share_68;  ///< Within 0.9945 sigma: 0.68 where sigma is right. Empty where count is 0.
  std::optional<double> share_95;  ///< Within 1.96 sigma.
};

/// Forces on the whole array (ForceFrame::total) beside the loads, in frames whose loads are known throughout.
struct SumErrors {
  std::size_t untouched = 0;                       ///< Frames.
  std::optional<double> untouched_mean_n;          ///< Their mean sum [N]: 0 where it is right.
  std::optional<double> untouched_within_2_sigma;  ///< Share of them.
  std::size_t touched = 0;                         ///< Frames.
  std::optional<double> relative_bias;             ///< Of all their sums together.
  std::optional<double> share_68;                  ///< As Coverage.
  std::optional<double> share_95;
};

/// dermis beside the Cramer-Rao bound. That is the least standard deviation which the noise of the ADC leaves to an
/// unbiased estimator that knows the circuit and the material. It covers some of the frames, evenly, and their judged
/// taxels.
struct BoundComparison {
  std::size_t frames = 0;  ///< 0 where there is no bound: circuit "none", more than 1024 taxels, no judged taxel.
  std::size_t taxels = 0;
  double median_bound = 0.0;      ///< Over the taxels: bound over true force.
  double median_deviation = 0.0;  ///< |error| over true force, median over 0.6745: the standard deviation if normal.
  double rms_ratio = 0.0;         ///< Root mean square of error over bound.
};

/// How one estimator did on all frames.
struct EstimatorResult {
  std::string name;                    ///< "dermis" first, then the baselines, then a further estimator.
  std::string description;             ///< Describes a further estimator; the model describes the others.
  ErrorSummary relative_error;         ///< |estimate / truth - 1| of judged taxels; dimensionless.
  ErrorSummary ghost_n;                ///< Force on unloaded taxels that give one [N].
  std::size_t totals_judged = 0;       ///< `force` loads over several taxels.
  std::optional<double> total_rmse_n;  ///< Root mean square error of their sums over live taxels [N].
  ErrorSummary total_relative_error;   ///< |sum / total - 1| of totals above 0.
};

/// Where in its touch a known force was, by the labels, which are at most a second apart.
struct TouchTime {
  std::optional<double> seconds_since_onset;  ///< Since the first label above zero after one of zero.
  std::optional<bool> is_unloading;           ///< Whether the last change of the force, of more than 1 %, was a fall.
};

/// One loaded taxel of one frame, for plots.
struct JudgedTaxel {
  std::size_t frame = 0;
  std::size_t taxel = 0;
  double true_newtons = 0.0;
  std::optional<double> temperature_celsius;
  std::optional<double> supply_v;
  std::size_t contacts = 0;    ///< Separate stressed areas in the frame (8-connected).
  std::vector<float> newtons;  ///< Estimate of each estimator, in their order.
  float sigma_newtons = 0.0F;  ///< Standard deviation of dermis' estimate, as ForceFrame defines it [N].
  TouchTime touch = {};
};

/// Share of `taxels` whose true force is within each of `sigmas` (>= 0) standard deviations of dermis' force. Only
/// finite deviations count; empty where there are none.
[[nodiscard]] std::vector<double> covered_shares(std::span<const JudgedTaxel> taxels, std::span<const double> sigmas);

/// One `force` load over several taxels of one frame, for plots.
struct JudgedTotal {
  std::size_t frame = 0;
  double true_newtons = 0.0;
  std::optional<double> temperature_celsius;
  std::vector<double> newtons;  ///< Sum of each estimator, in their order.
  TouchTime touch = {};         ///< Where it is the only total of its frame.
};

/// Errors of all estimators on the judged taxels (totals, where no taxel is judged) that fall into [low, high).
struct BreakdownBin {
  double low = 0.0;
  double high = 0.0;
  std::vector<ErrorSummary> relative_error;  ///< One per estimator.
  Coverage coverage = {};                    ///< Of dermis; of taxels only.
};

/// Forces on unloaded taxels whose load went [low, high) before.
struct ReleaseBin {
  double low = 0.0;                   ///< [s]
  double high = 0.0;                  ///< [s]
  std::vector<ErrorSummary> ghost_n;  ///< One per estimator [N].
};

/// A frame at its stages, for pictures; each [rows, cols].
struct TactileExample {
  std::size_t frame = 0;
  std::vector<double> reading;  ///< counts / full scale
  std::vector<double> siemens;  ///< Crosstalk removed.
  std::vector<float> newtons;   ///< dermis
  std::vector<double> true_newtons;
};

/// The result of evaluate(). Many members: reports show each of them.
struct Evaluation {
  ArrayDescription array;
  std::size_t frames = 0;  ///< Labelled frames judged.
  std::size_t frames_rejected = 0;
  Status most_have_forces = Done{};  ///< Else what is wrong with the frames: touch::pipeline::FrameTroubles::verdict().
  double judged_from_n = 0.0;        ///< True force from which on taxels are judged [N]: kJudgedShare.
  std::vector<EstimatorResult> estimators;
  Coverage coverage;  ///< Of dermis, over all judged taxels.
  SumErrors sums;     ///< Of dermis.
  BoundComparison bound;
  std::vector<JudgedTaxel> taxels;
  std::vector<JudgedTotal> totals;
  std::vector<BreakdownBin> by_force;        ///< [N]
  std::vector<BreakdownBin> by_temperature;  ///< [C]
  std::vector<BreakdownBin> by_supply;       ///< [V]
  std::vector<BreakdownBin> by_contacts;     ///< Number of contacts, one a bin.
  std::vector<BreakdownBin> by_onset;        ///< Time since the onset of the touch [s].
  std::vector<BreakdownBin> by_direction;    ///< From 0: loading, and held after it; from 1: unloading.
  std::vector<ReleaseBin> after_release;
  std::vector<TactileExample> examples;  ///< A few loaded frames with known taxel forces.
};

/// Runs the model and its baselines on frames whose loads are known, and a further estimator where there is one, as the
/// last. Unlabelled frames pass through the pipeline but are not judged. Errors: frames or an estimator that do not fit
/// the model's array, no labelled frame, loads given as pressure without a taxel area.
[[nodiscard]] Result<Evaluation> evaluate(const touch::pipeline::Model& model, std::span<const RawFrame> frames,
                                          std::span<const Load> loads, FurtherEstimator* further = nullptr);

/// The result as in `dermis evaluate --json` (docs/command-line.md).
[[nodiscard]] std::string to_json(const Evaluation& evaluation);

}  // namespace dermis::learn::calibration
