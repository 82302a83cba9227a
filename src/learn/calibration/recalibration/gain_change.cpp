// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "dermis/learn/calibration/recalibration.hpp"
#include "learn/calibration/recalibration/known_presses.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kSheetSigma = 0.1;  // of the change of a sheet, before any press
constexpr std::size_t kLeastToTellSpread = 5;
constexpr double kLeastSpread = 0.002;
constexpr double kMostSpread = 0.3;
constexpr std::size_t kSpreadSteps = 20;
constexpr double kProof =
    12.0;  // of lines: by chance one press in 20 agrees with another, and each foretells the other

/// Shares of the variance of gains that a row or a column has in common; the rest is each taxel's own.
struct Structure {
  double row = 0.0;
  double column = 0.0;

  [[nodiscard]] double own() const { return 1.0 - row - column; }
};
constexpr std::array<Structure, 9> kStructures{
    {{}, {0.5, 0.0}, {0.9, 0.0}, {1.0, 0.0}, {0.0, 0.5}, {0.0, 0.9}, {0.0, 1.0}, {0.45, 0.45}, {0.5, 0.5}}};

/// The shares of each press on rows, columns and taxels.
struct PressShares {
  PressShares(std::span<const KnownPress> presses, const FrameShape& shape)
      : of_rows(zeros(presses.size(), shape.rows)),
        of_columns(zeros(presses.size(), shape.cols)),
        of_taxels(zeros(presses.size(), shape.taxel_count())) {
    for (std::size_t k = 0; k < presses.size(); ++k) {
      for (std::size_t i = 0; i < presses[k].taxels.size(); ++i) {
        const std::size_t taxel = presses[k].taxels[i];
        add(of_rows, k, taxel / shape.cols, presses[k].shares[i]);
        add(of_columns, k, taxel % shape.cols, presses[k].shares[i]);
        add(of_taxels, k, taxel, presses[k].shares[i]);
      }
    }
  }

  Eigen::MatrixXd of_rows;
  Eigen::MatrixXd of_columns;
  Eigen::MatrixXd of_taxels;

 private:
  static Eigen::MatrixXd zeros(std::size_t rows, std::size_t cols) {
    return Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
  }
  static void add(Eigen::MatrixXd& shares, std::size_t row, std::size_t col, double share) {
    shares(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col)) += share;
  }
};

/// Presses as Gaussian variables of a common covariance.
class GaussianPresses {
 public:
  GaussianPresses(std::span<const KnownPress> presses, const FrameShape& shape)
      : log_ratio_(presses.size()),
        variance_(presses.size()),
        cols_(static_cast<Eigen::Index>(shape.cols)),
        shares_(presses, shape),
        of_rows_(shares_.of_rows * shares_.of_rows.transpose()),
        of_columns_(shares_.of_columns * shares_.of_columns.transpose()),
        of_taxels_(shares_.of_taxels * shares_.of_taxels.transpose()) {
    for (std::size_t k = 0; k < presses.size(); ++k) {
      log_ratio_[static_cast<Eigen::Index>(k)] = presses[k].log_ratio;
      variance_[static_cast<Eigen::Index>(k)] = presses[k].sigma * presses[k].sigma;
    }
  }

  /// Sets the covariance to that with this spread of the taxels.
  void assume(double spread, const Structure& structure) {
    spread_ = spread;
    structure_ = structure;
    Eigen::MatrixXd covariance =
        spread * spread * (structure.row * of_rows_ + structure.column * of_columns_ + structure.own() * of_taxels_);
    covariance.array() += kSheetSigma * kSheetSigma;
    covariance.diagonal() += variance_;
    factor_.compute(covariance);
    weights_ = factor_.solve(log_ratio_);
  }

  [[nodiscard]] double log_likelihood() const {
    return -0.5 * log_ratio_.dot(weights_) - factor_.matrixLLT().diagonal().array().log().sum();
  }

  /// Sum over the presses of the logarithm of the density that the others foretell.
  [[nodiscard]] double left_out_score() const {
    const Eigen::Index count = log_ratio_.size();
    const Eigen::VectorXd precision = factor_.solve(Eigen::MatrixXd::Identity(count, count)).diagonal();
    return 0.5 * (precision.array().log() - weights_.array().square() / precision.array()).sum();
  }

  [[nodiscard]] double press_sigma() const { return std::sqrt(variance_.mean()); }

  [[nodiscard]] double sheet() const { return kSheetSigma * kSheetSigma * weights_.sum(); }

  /// Variance of the change of the sheet that is left.
  [[nodiscard]] double sheet_variance() const {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(log_ratio_.size());
    const double prior = kSheetSigma * kSheetSigma;
    return prior - prior * prior * ones.dot(factor_.solve(ones));
  }

  /// Covariance of each press with the change of a taxel beside the sheet's.
  [[nodiscard]] Eigen::VectorXd with(std::size_t taxel) const {
    const auto at = static_cast<Eigen::Index>(taxel);
    return spread_ * spread_ *
           (structure_.row * shares_.of_rows.col(at / cols_) + structure_.column * shares_.of_columns.col(at % cols_) +
            structure_.own() * shares_.of_taxels.col(at));
  }

  /// Change of a taxel beside the sheet's.
  [[nodiscard]] double change(std::size_t taxel) const { return with(taxel).dot(weights_); }

  /// Variance of the change of a taxel that is left, that of the sheet included.
  [[nodiscard]] double variance(std::size_t taxel) const {
    Eigen::VectorXd with_change = with(taxel);
    with_change.array() += kSheetSigma * kSheetSigma;
    const double prior = kSheetSigma * kSheetSigma + spread_ * spread_;
    return std::max(prior - factor_.matrixL().solve(with_change).squaredNorm(), 0.0);
  }

 private:
  Eigen::VectorXd log_ratio_;
  Eigen::VectorXd variance_;
  Eigen::Index cols_;
  PressShares shares_;
  Eigen::MatrixXd of_rows_;  // products of the shares of two presses
  Eigen::MatrixXd of_columns_;
  Eigen::MatrixXd of_taxels_;
  double spread_ = 0.0;
  Structure structure_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd weights_;  // Covariance^-1 times the logarithms of the ratios
};

/// How gains differ, if they do as a structure says.
struct Spread {
  double rms = 0.0;           ///< 0: not distinguished.
  double log_evidence = 0.0;  ///< Mean likelihood of the presses over the spreads.
  double left_out_score = 0.0;
};

/// Before any press, spreads beyond the scatter of presses are as likely in equal ratios. That the gains are alike has
/// to be less likely than some spread.
Spread spread_of(const Structure& structure, GaussianPresses& presses) {
  presses.assume(0.0, structure);
  const double alike = presses.log_likelihood();
  std::array<double, kSpreadSteps> spreads{};
  std::array<double, kSpreadSteps> log_likelihoods{};
  for (std::size_t step = 0; step < kSpreadSteps; ++step) {
    const double place = static_cast<double>(step) / (kSpreadSteps - 1);
    spreads[step] = kLeastSpread * std::pow(kMostSpread / kLeastSpread, place);
    presses.assume(spreads[step], structure);
    log_likelihoods[step] = presses.log_likelihood();
  }
  const double most = *std::max_element(log_likelihoods.begin(), log_likelihoods.end());
  double sum = 0.0;
  double squares = 0.0;
  double priors = 0.0;
  for (std::size_t step = 0; step < kSpreadSteps; ++step) {
    const double prior = spreads[step] / (spreads[step] + presses.press_sigma());
    const double weight = prior * std::exp(log_likelihoods[step] - most);
    sum += weight;
    squares += weight * spreads[step] * spreads[step];
    priors += prior;
  }
  Spread spread;
  if (most > alike) spread.rms = std::sqrt(squares / sum);
  spread.log_evidence = most + std::log(sum / priors);
  presses.assume(spread.rms, structure);
  spread.left_out_score = presses.left_out_score();
  return spread;
}

/// How the spread is shared, where that is not known: the mean of the structures, each as likely as the presses say.
Structure mean_structure(const std::array<Spread, kStructures.size()>& spreads) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Spread& spread : spreads) most = std::max(most, spread.log_evidence);
  Structure mean;
  double sum = 0.0;
  for (std::size_t k = 0; k < spreads.size(); ++k) {
    const double weight = std::exp(spreads[k].log_evidence - most);
    mean.row += weight * kStructures[k].row;
    mean.column += weight * kStructures[k].column;
    sum += weight;
  }
  return {mean.row / sum, mean.column / sum};
}

/// The structure by which presses foretell others best, if that is beyond chance; otherwise that of taxels alone.
std::size_t proven_structure(const std::array<Spread, kStructures.size()>& spreads) {
  const auto is_less = [](const Spread& a, const Spread& b) { return a.left_out_score < b.left_out_score; };
  const auto best = std::max_element(spreads.begin(), spreads.end(), is_less);
  if (best->left_out_score < spreads.front().left_out_score + kProof) return 0;
  return static_cast<std::size_t>(best - spreads.begin());
}

/// The part of the change of each gain that is left.
GainErrors errors_left(const GaussianPresses& presses, double spread, const Structure& shared,
                       const FrameShape& shape) {
  const double sheet_variance = presses.sheet_variance();
  GainErrors errors;
  errors.cols = shape.cols;
  for (std::size_t taxel = 0; taxel < shape.taxel_count(); ++taxel) {
    errors.sigma.push_back(static_cast<float>(std::sqrt(presses.variance(taxel))));
  }
  errors.sheet_share = sheet_variance / (sheet_variance + spread * spread);
  errors.row_share = (1.0 - errors.sheet_share) * shared.row;
  errors.column_share = (1.0 - errors.sheet_share) * shared.column;
  return errors;
}

}  // namespace

GainChange change_of(std::span<const KnownPress> presses, const FrameShape& shape) {
  assert(!presses.empty());
  GaussianPresses gaussian(presses, shape);
  GainChange change;
  Structure structure;
  Structure shared;
  if (std::min(presses.size(), pressed_taxels(presses)) >= kLeastToTellSpread) {
    std::array<Spread, kStructures.size()> spreads;
    for (std::size_t k = 0; k < spreads.size(); ++k) spreads[k] = spread_of(kStructures[k], gaussian);
    const std::size_t proven = proven_structure(spreads);
    structure = kStructures[proven];
    shared = mean_structure(spreads);
    change.spread = spreads[proven].rms;
    change.row_share = structure.row;
    change.column_share = structure.column;
  }
  gaussian.assume(change.spread, structure);
  change.sheet = gaussian.sheet();
  change.sheet_sigma = std::sqrt(gaussian.sheet_variance());
  for (std::size_t taxel = 0; taxel < shape.taxel_count(); ++taxel) {
    change.taxels.push_back(change.sheet + gaussian.change(taxel));
  }
  change.left = errors_left(gaussian, change.spread, shared, shape);
  return change;
}

}  // namespace dermis::learn::calibration
