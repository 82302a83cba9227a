// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/instrument/instrument_fit.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibration/circuit_fit/circuit_frames.hpp"
#include "calibration/circuit_fit/line_parameters.hpp"
#include "calibration/instrument/dead_zone.hpp"
#include "calibration/instrument/instrument_parameters.hpp"
#include "calibration/instrument/press_law.hpp"
#include "calibration/instrument/settling.hpp"
#include "calibration/mean.hpp"
#include "dermis/core/quantile.hpp"

namespace dermis::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kLeastPresses = 8;  // on several taxels, for any evidence
constexpr int kSteps = 4;                 // of Gauss-Newton
constexpr double kLimit = 4.0;            // sigmas from which on a press is an outlier
constexpr double kEvidence = 30.0;        // squares that a part must explain
constexpr double kPerParameter = 6.0;     // and so many more for each parameter beyond the first
constexpr const char* kNoPresses = "adc_offset_counts and supply_ohm cannot be told";
constexpr double kWorthAFit = 0.5;  // of that, as one step foretells it
constexpr double kMostPressesShare = 0.9;
constexpr const char* kNothing = "adc_offset_counts and supply_ohm are nothing, as far as presses tell";
constexpr double kNoticed = 2.0;  // mean square of presses that do not agree

/// Parts with values that explain presses as well as they can.
struct Explanation {
  InstrumentParameters parameters;
  VectorXd values;
  VectorXd errors;     // standard errors
  VectorXd residuals;  // of presses and idle lines, in sigmas

  /// Squares of what it leaves, and of how unusual it is.
  [[nodiscard]] double cost() const;
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

double Explanation::cost() const {
  return huber_cost(residuals) + values.cwiseQuotient(parameters.usual()).squaredNorm();
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

  /// The relative difference that nine of ten presses on several taxels stay below.
  [[nodiscard]] double largest_difference(const VectorXd& residuals) const {
    const VectorXd sizes = residuals.head(totals()).cwiseProduct(sigmas_.head(totals())).cwiseAbs();
    return quantile(std::vector<double>(sizes.begin(), sizes.end()), kMostPressesShare);
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
    const std::optional<VectorXd> there = judge.residuals(parameters, moved);
    if (!there) return std::nullopt;
    slopes.col(p) = (*there - here) / steps[p];
  }
  return slopes;
}

/// With what is usual as the prior.
MatrixXd information(const MatrixXd& slopes, const VectorXd& weights, const VectorXd& usual) {
  MatrixXd normal = slopes.transpose() * weights.asDiagonal() * slopes;
  normal.diagonal() += usual.cwiseAbs2().cwiseInverse();
  return normal;
}

/// A step downhill, halved until it is one. false: there is none.
bool move(Judge& judge, const InstrumentParameters& parameters, const VectorXd& step, VectorXd& values,
          VectorXd& residuals) {
  constexpr double kLeastShare = 0.1;
  for (double share = 1.0; share > kLeastShare; share *= 0.5) {
    const VectorXd next = parameters.possible(values - share * step);
    const std::optional<VectorXd> there = judge.residuals(parameters, next);
    if (!there || huber_cost(*there) > huber_cost(residuals)) continue;
    values = next;
    residuals = *there;
    return true;
  }
  return false;
}

std::optional<Explanation> explain(Judge& judge, InstrumentParameters parameters) {
  VectorXd values = VectorXd::Zero(parameters.count());
  VectorXd errors = values;
  std::optional<VectorXd> here = judge.residuals(parameters, values);
  for (int step = 0; here && parameters.count() > 0 && step < kSteps; ++step) {
    const std::optional<MatrixXd> slopes = jacobian(judge, parameters, values, *here);
    if (!slopes) return std::nullopt;
    const VectorXd weights = huber_weights(*here);
    const VectorXd usual = parameters.usual();
    const MatrixXd normal = information(*slopes, weights, usual);
    const VectorXd gradient =
        slopes->transpose() * weights.cwiseProduct(*here) + values.cwiseQuotient(usual.cwiseAbs2());
    const Eigen::LDLT<MatrixXd> factors(normal);
    errors = factors.solve(MatrixXd::Identity(normal.rows(), normal.cols())).diagonal().cwiseMax(0.0).cwiseSqrt();
    if (step == 0 && gradient.dot(factors.solve(gradient)) < kWorthAFit * kEvidence) return std::nullopt;
    if (!move(judge, parameters, factors.solve(gradient), values, *here)) break;
  }
  if (!here) return std::nullopt;
  return Explanation{std::move(parameters), std::move(values), std::move(errors), *std::move(here)};
}

/// By how much it explains more than what must be asked of so many parameters, with what it leaves as the measure.
double evidence(const Explanation& found, double before, Index parameters_before) {
  const double left = found.cost();
  const double scale = std::max(1.0, left / static_cast<double>(found.residuals.size()));
  const auto more = static_cast<double>(found.parameters.count() - parameters_before);
  return (before - left) / scale - kEvidence - kPerParameter * (more - 1.0);
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
    std::optional<Explanation> with_part = explain(judge, {array, parts});
    if (!with_part) continue;
    const double gained = evidence(*with_part, best.cost(), best.parameters.count());
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

/// The relative loss through such a part of one of two equal presses in a row, for the heaviest.
double effect_of(InstrumentPart part, const Explanation& found, const CircuitFrames& frames) {
  const std::vector<InstrumentPart>& parts = found.parameters.parts();
  const auto here = std::find(parts.begin(), parts.end(), part);
  if (here == parts.end()) return 0.0;
  const auto place = static_cast<std::size_t>(here - parts.begin());
  const VectorXd shares = found.values.segment(found.parameters.first_of(place), found.parameters.size_of(place));
  return shares.cwiseAbs().mean() * highest_ratio(frames);  // a reading over its load is about the conductance
}

/// Drivers that the description gives are not changed.
Explanation without_drivers(Judge& judge, const ArrayDescription& array, const Explanation& found) {
  std::vector<InstrumentPart> parts = found.parameters.parts();
  if (std::erase(parts, InstrumentPart::drivers) == 0) return found;
  std::optional<Explanation> rest = explain(judge, {array, parts});
  return rest ? *std::move(rest) : found;
}

/// Judges the residual after the applied parts: how sure forces are, and a sentence where presses do not agree.
void notice(const Judge& judge, const Explanation& applied, InstrumentFit& fit) {
  const double square = judge.square_of_totals(applied.residuals);
  if (square <= kNoticed) return;
  fit.unexplained = std::max(fit.unexplained, judge.largest_difference(applied.residuals));
  fit.doubts.push_back(fmt::format(
      "presses on several taxels do not add up: they scatter {:.1f} times as much as single ones tell, {:.1f} % of the "
      "force; circuit or ADC are not as described, and forces are said to be so much less sure",
      std::sqrt(square), 100.0 * fit.unexplained));
}

}  // namespace

bool asks_for_instrument(const Readout& readout) {
  return readout.adc_errors.is_unknown() || std::isnan(readout.supply_ohm.value_or(0.0));
}

ArrayDescription without_unknown_instrument(ArrayDescription array) {
  for (std::optional<double>* const value : {&array.readout.adc_errors.offset_counts, &array.readout.supply_ohm}) {
    if (std::isnan(value->value_or(0.0))) value->reset();
  }
  return array;
}

InstrumentFit fit_settling(const ArrayDescription& array, std::span<const RawFrame> frames,
                           std::span<const Load> loads) {
  InstrumentFit fit{.array = array, .statements = {}, .doubts = {}};
  std::optional<double>& settling = fit.array.readout.adc_errors.settling;
  const bool is_asked_for = settling && std::isnan(*settling);
  if (settling && !is_asked_for) return fit;
  settling.reset();
  const std::optional<SettlingEstimate> estimate = measure_settling(fit.array, frames, loads);
  if (estimate && estimate->is_significant()) {
    settling = estimate->share;
    fit.statements.push_back(fmt::format(
        "each reading keeps {:.2f} % (\u00b1 {:.2f}) of the one before it in the scan, which has not settled: "
        "undone (adc_settling)",
        100.0 * estimate->share, 100.0 * estimate->standard_error));
  } else if (is_asked_for) {
    fit.statements.push_back(estimate
                                 ? fmt::format("readings settle: {:.2f} % (\u00b1 {:.2f}) is left of the one before",
                                               100.0 * estimate->share, 100.0 * estimate->standard_error)
                                 : "adc_settling cannot be told: press at least 20 taxels, each alone");
  }
  return fit;
}

Result<InstrumentFit> fit_instrument(const ArrayDescription& array, std::span<const RawFrame> frames,
                                     std::span<const Load> loads, Nanos settle_time, bool is_asked_for) {
  InstrumentFit fit{.array = array, .statements = {}, .doubts = {}};
  const Result<CircuitFrames> labelled = circuit_frames(array, frames, loads, settle_time);
  if (!labelled) return labelled.error();
  const std::optional<std::string> dead_zone = describe_dead_zone(*labelled);
  if (dead_zone) fit.doubts.push_back(*dead_zone);
  Judge judge(array, *labelled);
  if (judge.presses().several.size() < kLeastPresses) {
    if (is_asked_for) fit.statements.emplace_back(kNoPresses);
    fit.lacks_proof = true;
    return fit;
  }
  std::optional<Explanation> best = explain(judge, {array, {}});
  if (!best) return fit;
  const auto explain_more = [&] { return dead_zone ? std::nullopt : best_beside(judge, array, *best); };
  while (std::optional<Explanation> better = explain_more()) best = std::move(better);
  for (std::size_t place = 0; place < best->parameters.parts().size(); ++place) {
    const bool is_applied = best->parameters.parts()[place] != InstrumentPart::drivers;
    (is_applied ? fit.statements : fit.doubts).push_back(describe(*best, array, place));
  }
  if (is_asked_for && best->parameters.count() == 0) fit.statements.emplace_back(kNothing);
  const Explanation applied = without_drivers(judge, array, *best);
  fit.array = applied.parameters.array_at(applied.values);
  fit.unexplained = effect_of(InstrumentPart::drivers, *best, *labelled);
  notice(judge, applied, fit);
  return fit;
}

}  // namespace dermis::calibration
