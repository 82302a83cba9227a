// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/instrument_fit.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/instrument/instrument_parameters.hpp"
#include "learn/calibration/instrument/press_law.hpp"
#include "learn/calibration/instrument/proof.hpp"
#include "learn/calibration/mean.hpp"

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSteps = 4;              // of Gauss-Newton
constexpr double kLimit = 4.0;         // sigmas from which on a press is an outlier
constexpr double kEvidence = 30.0;     // squares that a part must explain
constexpr double kPerParameter = 6.0;  // and so many more for each parameter beyond the first
constexpr double kWorthAFit = 0.5;     // of that, as one step foretells it
constexpr double kNoticed = 2.0;       // mean square of presses that do not agree

/// Parts with values that explain presses as well as they can.
struct Explanation {
  InstrumentParameters parameters;
  VectorXd values;
  VectorXd errors;     // standard errors
  VectorXd residuals;  // of presses and idle lines, in sigmas

  /// Squares of what it leaves, and of how unusual it is. `weights`: of the residuals.
  [[nodiscard]] double cost(const VectorXd& weights) const;
};

/// Sum of squares in which outliers count by their first power (Huber).
double huber_cost(const VectorXd& residuals) {
  double sum = 0.0;
  for (const double residual : residuals) {
    const double size = std::abs(residual);
    sum += size <= kLimit ? size * size : kLimit * (2.0 * size - kLimit);
  }
  return sum;
}

double Explanation::cost(const VectorXd& weights) const {
  return huber_cost(residuals.cwiseProduct(weights)) + values.cwiseQuotient(parameters.usual()).squaredNorm();
}

/// Inversions of large arrays, and by Newton's method, take long.
std::size_t affordable_presses(const ArrayDescription& array) {
  constexpr std::size_t kTaxels = 400'000;
  constexpr std::size_t kFew = 100;
  constexpr std::size_t kMany = 600;
  const bool is_slow = is_inverted_slowly(array) || !array.readout.row_segment_ohm.empty();
  return is_slow ? kFew : std::clamp(kTaxels / array.taxel_count(), kFew, kMany);
}

/// The presses of a calibration, and what an instrument leaves of them.
class Judge {
 public:
  Judge(const ArrayDescription& array, const CircuitFrames& frames)
      : cols_(array.cols), presses_(sort_presses(frames, affordable_presses(array))), frames_(frames_of(presses_)) {}

  [[nodiscard]] const Presses& presses() const { return presses_; }

  /// Empty: the instrument cannot be so. The first call sets the standard deviations for all.
  std::optional<VectorXd> residuals(const InstrumentParameters& parameters, const VectorXd& values) {
    if (!values.allFinite()) return std::nullopt;
    const Result<InvertedFrames> inverted = parameters.invert(frames_, values);
    if (!inverted) return std::nullopt;
    if (readable_.empty()) readable_ = readable_taxels(presses_, *inverted);
    if (readable_.empty()) return std::nullopt;
    const std::optional<InstrumentMisfit> misfit = misfit_of(presses_, *inverted, cols_, readable_);
    if (!misfit) return std::nullopt;
    if (sigmas_.size() == 0) sigmas_ = Eigen::Map<const VectorXd>(misfit->sigmas.data(), std::ssize(misfit->sigmas));
    VectorXd residuals(sigmas_.size());
    residuals << Eigen::Map<const VectorXd>(misfit->totals.data(), std::ssize(misfit->totals)),
        Eigen::Map<const VectorXd>(misfit->idle.data(), std::ssize(misfit->idle));
    return residuals.cwiseQuotient(sigmas_);
  }

  /// Weights of residuals, where idle taxels scatter as these do.
  [[nodiscard]] VectorXd weights_by(const VectorXd& residuals) const {
    const Index idle = residuals.size() - totals();
    const VectorXd values = residuals.tail(idle).cwiseProduct(sigmas_.tail(idle));
    const std::vector<double> sigmas = sigmas_of_idle({values.data(), static_cast<std::size_t>(idle)});
    VectorXd weights = VectorXd::Ones(residuals.size());
    weights.tail(idle) = sigmas_.tail(idle).cwiseQuotient(Eigen::Map<const VectorXd>(sigmas.data(), idle));
    return weights;
  }
  /// Mean square of idle taxels on pressed lines, over the noise of readings.
  [[nodiscard]] double square_of_idle(const VectorXd& residuals) const {
    const Index idle = residuals.size() - totals();
    return residuals.tail(idle).cwiseProduct(sigmas_.tail(idle)).squaredNorm() / static_cast<double>(idle);
  }
  /// The mean for presses on several taxels, which come first. Or its estimate by the median where that is less, so
  /// that single outliers are no misfit.
  [[nodiscard]] double square_of_totals(const VectorXd& residuals) const {
    constexpr double kMedianOfSquare = 0.4549;  // of a standard normal variable
    const VectorXd squares = residuals.head(totals()).cwiseAbs2();
    const double median = upper_median(std::vector<double>(squares.begin(), squares.end()));
    return std::min(squares.mean(), median / kMedianOfSquare);
  }

 private:
  [[nodiscard]] Index totals() const { return std::ssize(presses_.several); }

  std::size_t cols_;
  Presses presses_;
  std::vector<const CircuitFrame*> frames_;
  std::vector<bool> readable_;  // of the instrument as described
  VectorXd sigmas_;
};

VectorXd huber_weights(const VectorXd& residuals) {
  return residuals.unaryExpr([](double r) { return std::min(1.0, kLimit / std::max(std::abs(r), 1e-9)); });
}

std::optional<MatrixXd> jacobian(Judge& judge, const InstrumentParameters& parameters, const VectorXd& values,
                                 const VectorXd& here) {
  const VectorXd steps = parameters.steps();
  MatrixXd slopes(here.size(), steps.size());
  for (Index p = 0; p < steps.size(); ++p) {
    VectorXd moved = values;
    moved[p] += steps[p];
    std::optional<VectorXd> there = judge.residuals(parameters, moved);
    if (!there) {  // as much of it would leave idle taxels nothing
      moved[p] = values[p] - steps[p];
      there = judge.residuals(parameters, moved);
    }
    if (!there) return std::nullopt;
    slopes.col(p) = (*there - here) / (moved[p] - values[p]);
  }
  return slopes;
}

/// With what is usual as the prior.
MatrixXd information(const MatrixXd& slopes, const VectorXd& weights, const VectorXd& usual) {
  MatrixXd normal = slopes.transpose() * weights.asDiagonal() * slopes;
  normal.diagonal() += usual.cwiseAbs2().cwiseInverse();
  return normal;
}

/// A step downhill, halved until it is one. false: there is none. `scale`: of the residuals.
bool move(Judge& judge, const InstrumentParameters& parameters, const VectorXd& step, const VectorXd& scale,
          VectorXd& values, VectorXd& residuals) {
  constexpr double kLeastShare = 0.1;
  for (double share = 1.0; share > kLeastShare; share *= 0.5) {
    const VectorXd next = parameters.possible(values - share * step);
    const std::optional<VectorXd> there = judge.residuals(parameters, next);
    if (!there || huber_cost(there->cwiseProduct(scale)) > huber_cost(residuals.cwiseProduct(scale))) continue;
    values = next;
    residuals = *there;
    return true;
  }
  return false;
}

/// Empty: one step foretells that it explains less than `least`.
std::optional<Explanation> explain(Judge& judge, InstrumentParameters parameters, double least) {
  VectorXd values = VectorXd::Zero(parameters.count());
  VectorXd errors = values;
  std::optional<VectorXd> here = judge.residuals(parameters, values);
  for (int step = 0; here && parameters.count() > 0 && step < kSteps; ++step) {
    const std::optional<MatrixXd> slopes = jacobian(judge, parameters, values, *here);
    if (!slopes) return std::nullopt;
    const VectorXd scale = judge.weights_by(*here);
    const VectorXd weights = huber_weights(here->cwiseProduct(scale)).cwiseProduct(scale.cwiseAbs2());
    const VectorXd usual = parameters.usual();
    const MatrixXd normal = information(*slopes, weights, usual);
    const VectorXd gradient =
        slopes->transpose() * weights.cwiseProduct(*here) + values.cwiseQuotient(usual.cwiseAbs2());
    const Eigen::LDLT<MatrixXd> factors(normal);
    errors = factors.solve(MatrixXd::Identity(normal.rows(), normal.cols())).diagonal().cwiseMax(0.0).cwiseSqrt();
    if (step == 0 && gradient.dot(factors.solve(gradient)) < least) return std::nullopt;
    if (!move(judge, parameters, factors.solve(gradient), scale, values, *here)) break;
  }
  if (!here) return std::nullopt;
  return Explanation{std::move(parameters), std::move(values), std::move(errors), *std::move(here)};
}

/// By how much it explains more than what must be asked of so many parameters, with what it leaves as the measure.
double evidence(const Judge& judge, const Explanation& found, const Explanation& before) {
  const VectorXd weights = judge.weights_by(found.residuals);
  const double left = found.cost(weights);
  const double scale = std::max(1.0, left / static_cast<double>(found.residuals.size()));
  const auto more = static_cast<double>(found.parameters.count() - before.parameters.count());
  return (before.cost(weights) - left) / scale - kEvidence - kPerParameter * (more - 1.0);
}

std::vector<InstrumentPart> open_parts(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  std::vector<InstrumentPart> parts;
  if (!readout.adc_errors.offset_counts) parts.push_back(InstrumentPart::offset);
  if (readout.adc_errors.curve.empty()) parts.push_back(InstrumentPart::curve);
  if (!readout.drive_error_ohm.empty()) return parts;  // drivers were fitted: what is left of them looks like a supply
  if (!readout.supply_ohm && readout.amplifier_offset_v.empty()) parts.push_back(InstrumentPart::supply);
  parts.push_back(InstrumentPart::drivers);
  return parts;
}

/// Parts beside those of `best`, the one that explains most.
std::optional<Explanation> best_beside(Judge& judge, const ArrayDescription& array, const Explanation& best) {
  std::optional<Explanation> found;
  double most = 0.0;
  for (const InstrumentPart part : open_parts(array)) {
    std::vector<InstrumentPart> parts = best.parameters.parts();
    if (std::find(parts.begin(), parts.end(), part) != parts.end()) continue;
    parts.push_back(part);
    std::optional<Explanation> with_part = explain(judge, {array, parts}, kWorthAFit * kEvidence);
    if (!with_part || !with_part->parameters.are_within_bounds(with_part->values)) continue;
    const double gained = evidence(judge, *with_part, best);
    if (gained <= most) continue;
    most = gained;
    found = std::move(with_part);
  }
  return found;
}

std::string describe(const Explanation& found, const ArrayDescription& array, std::size_t place) {
  const Readout& readout = array.readout;
  const Index first = found.parameters.first_of(place);
  const double value = found.values[first];
  const double error = found.errors[first];
  switch (found.parameters.parts()[place]) {
    case InstrumentPart::offset:
      return fmt::format(
          "the ADC reads {:+.1f} (\u00b1 {:.1f}) counts too much, by what presses tell: taken away "
          "(adc_offset_counts)",
          value, error);
    case InstrumentPart::supply:
      return fmt::format(
          "the supply sags under load, as behind {:.2g} ohm (\u00b1 {:.1g}), by what presses tell: undone "
          "(supply_ohm)",
          value * mean_of(readout.load_ohm), error * mean_of(readout.load_ohm));
    case InstrumentPart::curve:
      return fmt::format(
          "the ADC is bent by {:+.2f} % (\u00b1 {:.2f}) of its range in its middle, by what presses tell: undone "
          "(adc_curve)",
          100.0 * value, 100.0 * error);
    case InstrumentPart::drivers: break;
  }
  const VectorXd ohms = found.values.segment(first, found.parameters.size_of(place)) * mean_of(readout.load_ohm);
  return fmt::format(
      "drive_ohm is not as given: presses ask for {:+.0f} to {:+.0f} ohm more, line by line, as "
      "behind a multiplexer; write drive_ohm = \"fit\"",
      ohms.minCoeff(), ohms.maxCoeff());
}

InstrumentFinding finding_of(const Explanation& found, const ArrayDescription& array, double highest) {
  InstrumentFinding finding{found.parameters.parts(), found.parameters.array_at(found.values), {}, 0.0, false};
  for (std::size_t place = 0; place < finding.parts.size(); ++place) {
    finding.sentences.push_back(describe(found, array, place));
    if (finding.parts[place] != InstrumentPart::drivers) continue;
    const VectorXd shares = found.values.segment(found.parameters.first_of(place), found.parameters.size_of(place));
    finding.loss_by_drivers = shares.cwiseAbs().mean() * highest;  // a reading over its load is about the conductance
  }
  return finding;
}

}  // namespace

InstrumentFindings find_instrument(const ArrayDescription& array, const CircuitFrames& frames) {
  constexpr double kNoise = 1.2;    // mean square of idle taxels that differ by noise alone
  constexpr double kWithout = 1.5;  // times that, without a part that explains them
  InstrumentFindings findings;
  Judge judge(array, frames);
  findings.lacks_presses = judge.presses().several.size() < Proof::kLeastPresses;
  if (findings.lacks_presses) return findings;
  std::optional<Explanation> best = explain(judge, {array, {}}, 0.0);
  if (!best) return findings;
  findings.disagree = judge.square_of_totals(best->residuals) > kNoticed;
  while (std::optional<Explanation> better = best_beside(judge, array, *best)) {
    findings.found.push_back(finding_of(*better, array, highest_ratio(frames)));
    const double idle = judge.square_of_idle(better->residuals);
    findings.found.back().explains_idle = idle < kNoise && judge.square_of_idle(best->residuals) > kWithout * idle;
    best = std::move(better);
  }
  return findings;
}

std::optional<InstrumentFinding> refit_instrument(const ArrayDescription& array,
                                                  const std::vector<InstrumentPart>& parts,
                                                  const CircuitFrames& frames) {
  Judge judge(array, frames);
  const std::optional<Explanation> refit = explain(judge, {array, parts}, 0.0);
  if (!refit || !refit->parameters.are_within_bounds(refit->values)) return std::nullopt;
  return finding_of(*refit, array, highest_ratio(frames));
}

}  // namespace dermis::learn::calibration
