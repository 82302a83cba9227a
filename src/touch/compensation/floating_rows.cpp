// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/floating_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
constexpr double kMostFall = 2.0;  // of a logarithm in a pass under a film
constexpr double kMostMoved = 3.0;
constexpr double kLeastFilm = 1e-15;  // [S]
constexpr int kHopefulPasses = 15;    // under a film: in which the change falls below
constexpr double kHopeful = 0.3;

Index count_logarithms(const ArrayDescription& array) {
  const std::size_t lines = array.rows + array.cols;
  return at(array.readout.film ? 2 * lines - 2 : lines);
}

void multiply_into(const DenseInverse::Matrix& a, const DenseInverse::Matrix& b, DenseInverse::Matrix& out) noexcept {
  multiply(StridedMatrix<double>{a.data(), static_cast<std::size_t>(a.cols()), 1}, b.data(),
           static_cast<std::size_t>(a.rows()), static_cast<std::size_t>(a.cols()), static_cast<std::size_t>(b.cols()),
           out.data());
}

}  // namespace

FloatingRows::FloatingRows(const ArrayDescription& array, const ReferenceConductances& references)
    : drive_ohm_(Eigen::Map<const Eigen::VectorXd>(array.readout.drive_ohm.data(), at(array.rows))),
      load_siemens_(Eigen::Map<const Eigen::RowVectorXd>(array.readout.load_ohm.data(), at(array.cols)).cwiseInverse()),
      film_(array, references),
      mixing_(static_cast<std::size_t>(count_logarithms(array)), kMixingDepth),
      logarithms_(count_logarithms(array)),
      change_(count_logarithms(array)),
      last_logarithms_(film_.any() ? count_logarithms(array) : 0),
      readings_(at(array.rows), at(array.cols)),
      siemens_(at(array.rows), at(array.cols)),
      kept_(at(array.rows), at(array.cols)),
      raised_(at(array.rows), at(array.cols)),
      potentials_(at(array.rows), at(array.cols)),
      driven_(at(array.rows)),
      currents_(at(array.rows)),
      scale_(at(array.cols)),
      of_cols_(film_.any() ? array.cols : 0),
      of_rows_(film_.any() ? array.rows : 0),
      beside_(film_.any() ? at(array.rows) : 0),
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
  double moved = settle(enough);
  if (film_.any() && std::exchange(has_last_, false) && !(moved <= enough)) moved = settle(enough);
  has_last_ = moved <= enough;
  std::copy_n(siemens_.data(), siemens.size(), siemens.data());
  return moved;
}

/// From the last frame where there is one.
double FloatingRows::settle(double enough) noexcept {
  for (Index k = 0; k < readings_.size(); ++k) {
    const double load = load_siemens_[k % load_siemens_.size()];
    const double reading = readings_.data()[k];
    raised_.data()[k] = std::isnan(reading) ? kept_.data()[k] / (load + kept_.data()[k]) : reading;
  }
  find_potentials();
  if (film_.any() && !(currents_.minCoeff() > 0.0)) return std::numeric_limits<double>::infinity();
  if (!has_last_) start();
  if (film_.any()) copy_film();
  mixing_.forget();
  double moved = 0.0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    couple_columns();
    moved = follow();
    if (!std::isfinite(moved) || moved <= enough) break;
    if (film_.any() && pass > kHopefulPasses && moved > kHopeful) break;
    advance();
    find_potentials();
  }
  return moved;
}

void FloatingRows::advance() noexcept {
  if (film_.any()) last_logarithms_ = logarithms_;
  change_ *= kMixedShare;
  mixing_.advance({logarithms_.data(), static_cast<std::size_t>(logarithms_.size())},
                  {change_.data(), static_cast<std::size_t>(change_.size())});
  if (!film_.any()) return;
  logarithms_ =
      logarithms_.array().max(last_logarithms_.array() - kMostMoved).min(last_logarithms_.array() + kMostMoved);
}

/// As if there were no crosstalk.
void FloatingRows::start() noexcept {
  const auto open = 1.0 - potentials_.array().min(kMostApparentRatio);
  weighted_ = (potentials_.array().max(0.0) / open).matrix() * load_siemens_.asDiagonal();
  logarithms_.head(load_siemens_.size()) = (load_siemens_ + weighted_.colwise().sum()).transpose().array().log();
  for (Index row = 0; row < currents_.size(); ++row) {
    const double factor = currents_[row] > 0.0 ? weighted_.row(row).sum() / currents_[row] : kLeastFactor;
    logarithms_[load_siemens_.size() + row] = std::log(std::max(factor, kLeastFactor));
    if (film_.any()) logarithms_[load_siemens_.size() + row] += std::log(currents_[row]);
  }
  film_.follow({weighted_.data(), static_cast<std::size_t>(weighted_.size())});
}

void FloatingRows::copy_film() noexcept {
  Index place = potentials_.rows() + potentials_.cols();
  for (const auto* between : {&film_.film().between_rows, &film_.film().between_cols}) {
    for (const double siemens : *between) logarithms_[place++] = std::log(std::max(siemens, kLeastFilm));
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

/// The root of T.
void FloatingRows::weigh() noexcept {
  const Index cols = load_siemens_.size();
  scale_ = (0.5 * logarithms_.head(cols)).array().exp().matrix().transpose();
  for (Index row = 0; row < potentials_.rows(); ++row) {
    const double weight = currents_[row] > 0.0 ? std::exp(logarithms_[cols + row]) / currents_[row] : 0.0;
    weighted_.row(row) = std::sqrt(weight) * potentials_.row(row).cwiseProduct(scale_);
  }
}

void FloatingRows::Bidiagonal::factorise(const double* log_own, const double* log_between) noexcept {
  double before = 0.0;
  for (Index k = 0; k < diagonal.size(); ++k) {
    const double after = k + 1 < diagonal.size() ? std::exp(log_between[k]) : 0.0;
    below[k] = k > 0 ? -before / diagonal[k - 1] : 0.0;
    diagonal[k] = std::sqrt(std::exp(log_own[k]) + before + after - below[k] * below[k]);
    before = after;
  }
}

/// With A, the rows and the film between them, and q = p/c it is A^1/2 Q D^1/2. The film between columns is in D.
void FloatingRows::weigh_under_film() noexcept {
  const Index rows = potentials_.rows();
  const Index cols = potentials_.cols();
  const double* const logarithms = logarithms_.data();
  of_cols_.factorise(logarithms, logarithms + cols + rows + rows - 1);
  of_rows_.factorise(logarithms + cols, logarithms + cols + rows);
  for (Index row = 0; row < rows; ++row) {
    const auto q = potentials_.row(row) / currents_[row];
    weighted_.row(row) = q.cwiseProduct(of_cols_.diagonal.transpose());
    weighted_.row(row).head(cols - 1) += q.tail(cols - 1).cwiseProduct(of_cols_.below.tail(cols - 1).transpose());
  }
  for (Index row = 0; row < rows; ++row) {
    weighted_.row(row) *= of_rows_.diagonal[row];
    if (row + 1 < rows) weighted_.row(row) += of_rows_.below[row + 1] * weighted_.row(row + 1);
  }
}

/// Finds M from M + M S M = D, where S is the sum over the rows of b/c p p^T. With M = sqrt(D) E^-1 sqrt(D) it is E^2 -
/// E = T.
void FloatingRows::couple_columns() noexcept {
  const Index cols = load_siemens_.size();
  film_.any() ? weigh_under_film() : weigh();
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
  if (film_.any()) return couple_under_film();
  coupling_ = scale_.asDiagonal() * inverse_.matrix() * scale_.asDiagonal();
}

void FloatingRows::couple_under_film() noexcept {
  coupling_ = inverse_.matrix();
  const auto& [diagonal, below] = of_cols_;
  for (Index col = coupling_.cols(); col-- > 0;) {
    coupling_.row(col) *= diagonal[col];
    if (col > 0) coupling_.row(col) += below[col] * coupling_.row(col - 1);
  }
  for (Index col = coupling_.cols(); col-- > 0;) {
    coupling_.col(col) *= diagonal[col];
    if (col > 0) coupling_.col(col) += below[col] * coupling_.col(col - 1);
  }
}

/// The conductances, and what they make of D, of the rows and of the film. Returns the largest change.
double FloatingRows::follow() noexcept {
  const Index cols = load_siemens_.size();
  multiply_into(potentials_, coupling_, returned_);
  const double raised = film_.any() ? follow_rows_under_film() : follow_rows();
  change_.head(cols) =
      (load_siemens_ + siemens_.colwise().sum()).transpose().array().log().matrix() - logarithms_.head(cols);
  if (film_.any()) follow_film();
  if (!change_.allFinite()) return std::numeric_limits<double>::infinity();
  return std::max(raised, change_.cwiseAbs().maxCoeff());
}

/// The conductances b p M. Returns the largest change of a raised reading.
double FloatingRows::follow_rows() noexcept {
  const Index cols = load_siemens_.size();
  double raised = 0.0;
  for (Index row = 0; row < readings_.rows(); ++row) {
    double factor = kLeastFactor;
    if (currents_[row] > 0.0) {
      const double open = 1.0 - returned_.row(row).dot(potentials_.row(row)) / currents_[row];
      factor = 1.0 / std::max(open, kLeastOpenShare);
    }
    change_[cols + row] = std::log(factor) - logarithms_[cols + row];
    siemens_.row(row) = (factor * returned_.row(row)).cwiseMin(kHighestSiemens);
    for (Index col = 0; col < cols; ++col) raised = std::max(raised, follow_taxel(row, col, factor, driven_[row]));
  }
  return raised;
}

/// The conductances A Q M. The driven row is at its potential, which tells the diagonal of the inverse of A.
double FloatingRows::follow_rows_under_film() noexcept {
  const Index rows = potentials_.rows();
  const Index cols = potentials_.cols();
  const auto own = [&](Index row) { return std::exp(logarithms_[cols + row]); };
  const auto between = [&](Index row) { return std::exp(logarithms_[cols + rows + row]); };
  const auto series = [](double a, double b) { return a * b / (a + b); };
  double before = 0.0;
  for (Index row = 0; row < rows; ++row) {
    beside_[row] = before;
    if (row + 1 < rows) before = series(between(row), own(row) + before);
  }
  double after = 0.0;
  for (Index row = rows; row-- > 0;) {
    beside_[row] += after;
    if (row > 0) after = series(between(row - 1), own(row) + after);
  }
  for (Index row = 0; row < rows; ++row) {
    returned_.row(row) /= currents_[row];
    const double open = 1.0 - returned_.row(row).dot(potentials_.row(row));
    const double found = currents_[row] / std::max(open, kLeastOpenShare) - beside_[row];
    change_[cols + row] = std::log(std::max(found / own(row), std::exp(-kMostFall)));
  }
  for (Index row = 0; row < rows; ++row) {
    siemens_.row(row) = own(row) * returned_.row(row);
    if (row > 0) siemens_.row(row) += between(row - 1) * (returned_.row(row) - returned_.row(row - 1));
    if (row + 1 < rows) siemens_.row(row) += between(row) * (returned_.row(row) - returned_.row(row + 1));
  }
  returned_ = siemens_;
  siemens_ = siemens_.cwiseMin(kHighestSiemens);
  double raised = 0.0;
  for (Index row = 0; row < rows; ++row) {
    double total = own(row);
    if (row > 0) total += between(row - 1);
    if (row + 1 < rows) total += between(row);
    const double driven = driven_[row] * currents_[row] / total;
    for (Index col = 0; col < cols; ++col) raised = std::max(raised, follow_taxel(row, col, 1.0, driven));
  }
  return raised;
}

void FloatingRows::follow_film() noexcept {
  film_.follow({siemens_.data(), static_cast<std::size_t>(siemens_.size())});
  const Index lines = potentials_.rows() + potentials_.cols();
  Index place = lines;
  for (const auto* between : {&film_.film().between_rows, &film_.film().between_cols}) {
    for (const double siemens : *between) {
      change_[place] = std::log(std::max(siemens, kLeastFilm)) - logarithms_[place];
      ++place;
    }
  }
  change_ = change_.cwiseMax(-kMostFall).cwiseMin(kMostFall);
}

/// A taxel below 0 S is held there, and one without a reading where it is kept: the reading follows. Returns its
/// change.
double FloatingRows::follow_taxel(Index row, Index col, double factor, double driven) noexcept {
  const bool is_kept = std::isnan(readings_(row, col));
  const double wanted = is_kept ? kept_(row, col) / factor : 0.0;  // of p M
  const double held = raised_(row, col) + (wanted - returned_(row, col)) * driven / coupling_(col, col);
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
