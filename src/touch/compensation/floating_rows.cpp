// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/floating_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "touch/compensation/circuit_model/matrix.hpp"
#include "touch/compensation/matrix_product.hpp"
#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {
namespace {

using Eigen::Index;

constexpr int kMostPasses = 60;
constexpr std::size_t kMixingDepth = 16;
constexpr double kMixedShare =
    2.0;  // of a pass's change: the mixing goes half the way of what its span does not explain
constexpr int kMostRootSteps = 12;
constexpr double kRootAccuracy = 3e-6;  // of a step, whose error is the square of it
constexpr double kLeastOpenShare = 1e-4;
constexpr double kMostApparentRatio = 0.999;
constexpr double kLeastFactor = 1.0001;
constexpr double kLeastCurrent = 1e-18;  // [A at 1 V]
constexpr double kHighestSiemens = 1e3;

void multiply_into(const DenseInverse::Matrix& a, const DenseInverse::Matrix& b, DenseInverse::Matrix& out) noexcept {
  multiply(StridedMatrix<double>{a.data(), static_cast<std::size_t>(a.cols()), 1}, b.data(),
           static_cast<std::size_t>(a.rows()), static_cast<std::size_t>(a.cols()), static_cast<std::size_t>(b.cols()),
           out.data());
}

}  // namespace

FloatingRows::FloatingRows(const ArrayDescription& array)
    : drive_ohm_(Eigen::Map<const Eigen::VectorXd>(array.readout.drive_ohm.data(), at(array.rows))),
      load_siemens_(Eigen::Map<const Eigen::RowVectorXd>(array.readout.load_ohm.data(), at(array.cols)).cwiseInverse()),
      mixing_(array.cols + array.rows, kMixingDepth),
      logarithms_(at(array.cols + array.rows)),
      change_(at(array.cols + array.rows)),
      readings_(at(array.rows), at(array.cols)),
      siemens_(at(array.rows), at(array.cols)),
      kept_(at(array.rows), at(array.cols)),
      raised_(at(array.rows), at(array.cols)),
      potentials_(at(array.rows), at(array.cols)),
      driven_(at(array.rows)),
      currents_(at(array.rows)),
      scale_(at(array.cols)),
      weighted_(at(array.rows), at(array.cols)),
      coupling_(at(array.cols), at(array.cols)),
      returned_(at(array.rows), at(array.cols)),
      square_(at(array.cols), at(array.cols)),
      root_(at(array.cols), at(array.cols)),
      product_(at(array.cols), at(array.cols)),
      inverse_(array.cols) {}

bool FloatingRows::inverts(const Readout& readout) noexcept {
  return readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::floating &&
         readout.idle_columns == IdleColumns::loaded && !has_resistive_lines(readout);
}

// Readings that are raised take more.
bool FloatingRows::allows(std::span<const double> ratio) const noexcept {
  for (Index row = 0; row < drive_ohm_.size(); ++row) {
    double current = 0.0;
    for (Index col = 0; col < load_siemens_.size(); ++col) {
      const double reading = ratio[static_cast<std::size_t>(row * load_siemens_.size() + col)];
      if (!std::isnan(reading)) current += reading * load_siemens_[col];
    }
    if (!(drive_ohm_[row] * current < 1.0)) return false;
  }
  return true;
}

double FloatingRows::solve(std::span<const double> ratio, double enough, std::span<double> siemens) noexcept {
  readings_ = Eigen::Map<const Matrix>(ratio.data(), readings_.rows(), readings_.cols());
  kept_ = Eigen::Map<const Matrix>(siemens.data(), kept_.rows(), kept_.cols());
  for (Index k = 0; k < readings_.size(); ++k) {
    const double load = load_siemens_[k % load_siemens_.size()];
    const double reading = readings_.data()[k];
    raised_.data()[k] = std::isnan(reading) ? kept_.data()[k] / (load + kept_.data()[k]) : reading;
  }
  find_potentials();
  if (!has_last_) start();
  mixing_.forget();
  double moved = 0.0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    couple_columns();
    moved = follow();
    if (!std::isfinite(moved) || moved <= enough) break;
    change_ *= kMixedShare;
    mixing_.advance({logarithms_.data(), static_cast<std::size_t>(logarithms_.size())},
                    {change_.data(), static_cast<std::size_t>(change_.size())});
    find_potentials();
  }
  has_last_ = moved <= enough;
  std::copy_n(siemens_.data(), siemens.size(), siemens.data());
  return moved;
}

/// As if there were no crosstalk.
void FloatingRows::start() noexcept {
  const auto open = 1.0 - potentials_.array().min(kMostApparentRatio);
  weighted_ = (potentials_.array().max(0.0) / open).matrix() * load_siemens_.asDiagonal();
  logarithms_.head(load_siemens_.size()) = (load_siemens_ + weighted_.colwise().sum()).transpose().array().log();
  for (Index row = 0; row < currents_.size(); ++row) {
    const double factor = currents_[row] > 0.0 ? weighted_.row(row).sum() / currents_[row] : kLeastFactor;
    logarithms_[load_siemens_.size() + row] = std::log(std::max(factor, kLeastFactor));
  }
}

/// The current out through the loads equals the current in through the driver.
void FloatingRows::find_potentials() noexcept {
  for (Index row = 0; row < raised_.rows(); ++row) {
    const double current = raised_.row(row).cwiseProduct(load_siemens_).sum();
    driven_[row] = 1.0 - drive_ohm_[row] * current;
    const bool has_current = current > kLeastCurrent;
    currents_[row] = has_current ? current / driven_[row] : 0.0;
    if (has_current) {
      potentials_.row(row) = raised_.row(row) / driven_[row];
    } else {
      potentials_.row(row).setZero();
    }
  }
}

/// Finds M from M + M S M = D, where S is the sum over the rows of b/c p p^T. With M = sqrt(D) E^-1 sqrt(D) it is E^2 -
/// E = T.
void FloatingRows::couple_columns() noexcept {
  const Index cols = load_siemens_.size();
  scale_ = (0.5 * logarithms_.head(cols)).array().exp().matrix().transpose();
  for (Index row = 0; row < potentials_.rows(); ++row) {
    const double weight = currents_[row] > 0.0 ? std::exp(logarithms_[cols + row]) / currents_[row] : 0.0;
    weighted_.row(row) = std::sqrt(weight) * potentials_.row(row).cwiseProduct(scale_);
  }
  multiply(StridedMatrix<double>{weighted_.data(), 1, static_cast<std::size_t>(cols)}, weighted_.data(),
           static_cast<std::size_t>(cols), static_cast<std::size_t>(weighted_.rows()), static_cast<std::size_t>(cols),
           square_.data());
  // Newton's method for the root, all of whose steps commute with T, from above at its largest eigenvalue and from
  // below between.
  const double most = 0.5 + std::sqrt(0.25 + square_.cwiseAbs().rowwise().sum().maxCoeff());
  root_ = square_ / most;
  root_.diagonal().array() += 1.0;
  for (int step = 0; step < kMostRootSteps; ++step) {
    inverse_.matrix() = 2.0 * root_;
    inverse_.matrix().diagonal().array() -= 1.0;
    inverse_.invert();
    multiply_into(root_, root_, product_);
    product_ += square_;
    multiply_into(product_, inverse_.matrix(), coupling_);
    const double moved = (coupling_ - root_).cwiseAbs().maxCoeff();
    root_.swap(coupling_);
    if (!(moved > kRootAccuracy * most)) break;
  }
  inverse_.matrix() = root_;
  inverse_.invert();
  coupling_ = scale_.asDiagonal() * inverse_.matrix() * scale_.asDiagonal();
}

/// The conductances b p M, and what they make of D and b. Returns the largest change.
double FloatingRows::follow() noexcept {
  const Index cols = load_siemens_.size();
  multiply_into(potentials_, coupling_, returned_);
  double raised = 0.0;
  for (Index row = 0; row < readings_.rows(); ++row) {
    double factor = kLeastFactor;
    if (currents_[row] > 0.0) {
      const double open = 1.0 - returned_.row(row).dot(potentials_.row(row)) / currents_[row];
      factor = 1.0 / std::max(open, kLeastOpenShare);
    }
    change_[cols + row] = std::log(factor) - logarithms_[cols + row];
    siemens_.row(row) = (factor * returned_.row(row)).cwiseMin(kHighestSiemens);
    for (Index col = 0; col < cols; ++col) raised = std::max(raised, follow_taxel(row, col, factor));
  }
  change_.head(cols) =
      (load_siemens_ + siemens_.colwise().sum()).transpose().array().log().matrix() - logarithms_.head(cols);
  if (!change_.allFinite()) return std::numeric_limits<double>::infinity();
  return std::max(raised, change_.cwiseAbs().maxCoeff());
}

/// A taxel below 0 S is held there, and one without a reading where it is kept: the reading follows. Returns its
/// change.
double FloatingRows::follow_taxel(Index row, Index col, double factor) noexcept {
  const bool is_kept = std::isnan(readings_(row, col));
  const double wanted = is_kept ? kept_(row, col) / factor : 0.0;  // of p M
  const double held = raised_(row, col) + (wanted - returned_(row, col)) * driven_[row] / coupling_(col, col);
  const double next = is_kept ? held : std::max(readings_(row, col), held);
  const double change = std::abs(next - raised_(row, col));
  raised_(row, col) = next;
  if (is_kept) {
    siemens_(row, col) = kept_(row, col);
  } else {
    siemens_(row, col) = next > readings_(row, col) ? 0.0 : std::max(0.0, siemens_(row, col));
  }
  return change;
}

}  // namespace dermis::touch::compensation
