// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/surface_forces.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::touch::pipeline {
namespace {

constexpr float kPressedSigmas = 2.0F;
constexpr double kLeastOfPeak = 0.01;  // of the largest force: the prior's of taxels that feel less
constexpr double kFirstSize = 1.0;
constexpr double kLeastSize = 0.03;
constexpr int kRounds = 4;
constexpr std::size_t kMostPressed = 1024;  // taxels: more take seconds a frame

}  // namespace

SurfaceForces::SurfaceForces(const ArrayDescription& array) : cols_(array.cols), kernel_(array) {
  const std::size_t taxels = std::min(array.taxel_count(), kMostPressed + 1);
  pressed_.reserve(taxels);
  for (auto* values : {&felt_, &precision_, &gradient_, &deviation_}) values->reserve(taxels);
  for (auto* values : {&normal_, &matrix_}) values->reserve(taxels * taxels);
}

double SurfaceForces::share(std::size_t a, std::size_t b) const noexcept {
  const auto apart = [](std::size_t x, std::size_t y) { return x > y ? x - y : y - x; };
  return kernel_.share(apart(a / cols_, b / cols_), apart(a % cols_, b % cols_));
}

const ForceFrame& SurfaceForces::process(const ForceFrame& force) noexcept {
  surface_ = force;
  choose_pressed(force);
  if (pressed_.empty() || pressed_.size() > kMostPressed) return surface_;
  weigh();
  double size = kFirstSize;
  for (int round = 0; round < kRounds; ++round) size = std::max(kLeastSize, solve(size));
  take(force);
  return surface_;
}

/// Others feel nothing, or nobody knows how much.
void SurfaceForces::choose_pressed(const ForceFrame& force) {
  pressed_.clear();
  felt_.clear();
  precision_.clear();
  for (std::size_t taxel = 0; taxel < force.newtons.size(); ++taxel) {
    const float newtons = force.newtons[taxel];
    const float sigma = force.sigma_newtons[taxel];
    if (!std::isfinite(newtons) || !std::isfinite(sigma) || newtons < kPressedSigmas * sigma) continue;
    pressed_.push_back(taxel);
    felt_.push_back(newtons);
    precision_.push_back(1.0 / (static_cast<double>(sigma) * static_cast<double>(sigma)));
    if (pressed_.size() > kMostPressed) return;
  }
}

void SurfaceForces::weigh() {
  const std::size_t count = pressed_.size();
  normal_.assign(count * count, 0.0);
  gradient_.assign(count, 0.0);
  matrix_.resize(count * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < count; ++k) matrix_[i * count + k] = share(pressed_[i], pressed_[k]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double* const row = matrix_.data() + k * count;
    double rest = felt_[k];
    for (std::size_t i = 0; i < count; ++i) rest -= row[i] * felt_[i];
    for (std::size_t i = 0; i < count; ++i) {
      if (row[i] == 0.0) continue;
      const double weight = precision_[k] * row[i];
      gradient_[i] += weight * rest;
      for (std::size_t j = 0; j <= i; ++j) normal_[i * count + j] += weight * row[j];
    }
  }
}

double SurfaceForces::solve(double size) {
  const std::size_t count = pressed_.size();
  const double least = kLeastOfPeak * *std::max_element(felt_.begin(), felt_.end());
  const auto prior = [&](std::size_t k) { return size * std::max(felt_[k], least); };
  matrix_ = normal_;
  for (std::size_t k = 0; k < count; ++k) matrix_[k * count + k] += 1.0 / (prior(k) * prior(k));
  invert();
  deviation_.assign(count, 0.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      deviation_[i] += matrix_[std::max(i, k) * count + std::min(i, k)] * gradient_[k];
    }
    const double relative = size / prior(i);
    squares += relative * relative * (deviation_[i] * deviation_[i] + matrix_[i * count + i]);
  }
  return std::sqrt(squares / static_cast<double>(count));
}

/// The lower triangle of the inverse in place of that of the matrix (Cholesky).
void SurfaceForces::invert() {
  const std::size_t count = pressed_.size();
  double* const a = matrix_.data();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i * count + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * count + k] * a[j * count + k];
      a[i * count + j] = i == j ? std::sqrt(sum) : sum / a[j * count + j];
    }
  }
  for (std::size_t j = 0; j < count; ++j) {  // the inverse of the factor, column by column
    a[j * count + j] = 1.0 / a[j * count + j];
    for (std::size_t i = j + 1; i < count; ++i) {
      double sum = 0.0;
      for (std::size_t k = j; k < i; ++k) sum -= a[i * count + k] * a[k * count + j];
      a[i * count + j] = sum / a[i * count + i];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (std::size_t k = i; k < count; ++k) sum += a[k * count + i] * a[k * count + j];
      a[i * count + j] = sum;
    }
  }
}

void SurfaceForces::take(const ForceFrame& force) {
  const std::size_t count = pressed_.size();
  for (std::size_t taxel = 0; taxel < force.newtons.size(); ++taxel) {
    if (std::isfinite(force.newtons[taxel]) && std::isfinite(force.sigma_newtons[taxel]))
      surface_.newtons[taxel] = 0.0F;
  }
  for (std::size_t k = 0; k < count; ++k) {
    surface_.newtons[pressed_[k]] = static_cast<float>(std::max(0.0, felt_[k] + deviation_[k]));
    surface_.sigma_newtons[pressed_[k]] = static_cast<float>(std::sqrt(matrix_[k * count + k]));
  }
}

}  // namespace dermis::touch::pipeline
