// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/anderson_mixing.hpp"

#include <algorithm>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kPlainShare = 0.5;   // of the residual that the span does not explain, in a step
constexpr double kDependent = 1e-14;  // a change with less of its square outside of the span of newer ones adds nothing

DERMIS_PROCESSOR_CLONES double dot(const double* a, const double* b, std::size_t size) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t k = 0; k < size; ++k) sum += a[k] * b[k];
  return sum;
}

DERMIS_PROCESSOR_CLONES void subtract(double factor, const double* from, double* to, std::size_t size) {
#pragma omp simd
  for (std::size_t k = 0; k < size; ++k) to[k] -= factor * from[k];
}

}  // namespace

AndersonMixing::AndersonMixing(std::size_t unknowns, std::size_t depth)
    : unknowns_(unknowns),
      depth_(depth),
      last_x_(unknowns),
      last_residual_(unknowns),
      x_change_(depth * unknowns),
      residual_change_(depth * unknowns),
      x_basis_(depth * unknowns),
      residual_basis_(depth * unknowns),
      square_(depth) {}

void AndersonMixing::advance(std::span<double> x, std::span<const double> residual) noexcept {
  remember(x, residual);
  orthogonalise();
  for (std::size_t k = 0; k < unknowns_; ++k) x[k] += kPlainShare * residual[k];
  for (std::size_t k = 0; k < std::min(steps_ - 1, depth_); ++k) {
    if (square_[k] == 0.0) continue;
    const double* const basis = &residual_basis_[k * unknowns_];
    const double share = dot(basis, residual.data(), unknowns_) / square_[k];
    subtract(share, &x_basis_[k * unknowns_], x.data(), unknowns_);
    subtract(kPlainShare * share, basis, x.data(), unknowns_);
  }
}

void AndersonMixing::remember(std::span<const double> x, std::span<const double> residual) noexcept {
  if (steps_ > 0) {
    const std::size_t place = (steps_ - 1) % depth_ * unknowns_;
    for (std::size_t k = 0; k < unknowns_; ++k) {
      x_change_[place + k] = x[k] - last_x_[k];
      residual_change_[place + k] = residual[k] - last_residual_[k];
    }
  }
  std::copy(x.begin(), x.end(), last_x_.begin());
  std::copy(residual.begin(), residual.end(), last_residual_.begin());
  ++steps_;
}

/// Gram-Schmidt, from the newest step to the oldest.
void AndersonMixing::orthogonalise() noexcept {
  for (std::size_t k = 0; k < std::min(steps_ - 1, depth_); ++k) {
    const std::size_t place = (steps_ - 2 - k) % depth_ * unknowns_;
    double* const x = &x_basis_[k * unknowns_];
    double* const residual = &residual_basis_[k * unknowns_];
    std::copy_n(&x_change_[place], unknowns_, x);
    std::copy_n(&residual_change_[place], unknowns_, residual);
    const double square = dot(residual, residual, unknowns_);
    for (std::size_t newer = 0; newer < k; ++newer) {
      if (square_[newer] == 0.0) continue;
      const double share = dot(&residual_basis_[newer * unknowns_], residual, unknowns_) / square_[newer];
      subtract(share, &residual_basis_[newer * unknowns_], residual, unknowns_);
      subtract(share, &x_basis_[newer * unknowns_], x, unknowns_);
    }
    square_[k] = dot(residual, residual, unknowns_);
    if (!(square_[k] > kDependent * square)) square_[k] = 0.0;
  }
}

}  // namespace dermis::touch::compensation
