// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/ageing_monitor.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::health {
namespace {

constexpr double kLeastSpread = 0.05;  // of gains: less is not worth a calibration
constexpr double kLeastPercent = 0.5;  // that is reported
constexpr double kSigmas = 3.0;
constexpr std::size_t kLeastBlocks = 16;
constexpr float kMostWeight = 8.0F;  // of the touches that a square remembers of each way
constexpr float kMostRelativeSigma = 0.25F;
constexpr float kContrast = 0.7F;   // of ln F in a square, from which on it counts less
constexpr double kVariances = 4.0;  // of ln g, in that of d

// Squares that share taxels are alike. The correlation of their squared d is 1/4 with each of four neighbours and 1/16
// with each of four others.
constexpr double kSharing = 1.0 + 4.0 * 0.25 + 4.0 * 0.0625;

/// Most taxels are on one network: nobody has weighed them one by one.
bool are_shared(const touch::fusion::ForceNetworks& networks) {
  const std::size_t taxels = networks.taxel_count();
  std::size_t shared = 0;
  for (std::size_t taxel = 1; taxel < taxels; ++taxel) {
    bool is_alike = true;
    for (std::size_t first = 0; first < networks.parameters.size(); first += taxels) {
      is_alike = is_alike && networks.parameters[first + taxel] == networks.parameters[first + taxel - 1];
    }
    if (is_alike) ++shared;
  }
  return 2 * (shared - std::min(shared, networks.tables.taxels.size())) > taxels;
}

/// Median over the taxels of the root mean square of relative_sigma over the forces in the middle of its knots. Half of
/// it or more is other at every touch, where each taxel has been weighed.
double calibrated_spread(const touch::fusion::ForceNetworks& networks) {
  const std::size_t taxels = networks.taxel_count();
  const double lasting = are_shared(networks) ? 1.0 : 0.5;
  std::vector<double> spreads;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    if (networks.dead[taxel] != 0) continue;
    double sum = 0.0;
    for (std::size_t k = 1; k + 1 < touch::fusion::kSigmaKnots; ++k) {
      sum += std::pow(static_cast<double>(networks.relative_sigma[k * taxels + taxel]), 2);
    }
    spreads.push_back(lasting * std::sqrt(sum / static_cast<double>(touch::fusion::kSigmaKnots - 2)));
  }
  return spreads.empty() ? 0.0 : upper_median(std::move(spreads));
}

/// Weight of a square whose taxels differ by so much: at the rim of a touch shapes differ most.
float weight_of(float contrast) {
  const float square = contrast * contrast / (kContrast * kContrast);
  return 1.0F / (1.0F + square * square);
}

}  // namespace

bool AgeingEvidence::has_aged() const noexcept {
  return gain_spread && *gain_spread - kSigmas * spread_sigma > std::max(kLeastSpread, calibrated_spread);
}

std::string describe(const AgeingEvidence& evidence) {
  if (!evidence.gain_spread) {
    return fmt::format("not known yet ({} of {} squares of taxels compared)", evidence.blocks, kLeastBlocks);
  }
  const double sigma_percent = std::max(100.0 * evidence.spread_sigma, 1.0);
  if (100.0 * *evidence.gain_spread < kLeastPercent) {
    return fmt::format("gains have not changed from taxel to taxel (\u00b1 {:.0f} %, {} comparisons)", sigma_percent,
                       evidence.comparisons);
  }
  return fmt::format("{}gains have changed by about {:.0f} % from taxel to taxel (\u00b1 {:.0f} %, {} comparisons)",
                     evidence.has_aged() ? "recalibrate: " : "", 100.0 * *evidence.gain_spread, sigma_percent,
                     evidence.comparisons);
}

AgeingMonitor::AgeingMonitor(const touch::pipeline::Model& model)
    : rows_(model.array.rows),
      cols_(model.array.cols),
      calibrated_spread_(calibrated_spread(model.networks)),
      blocks_((rows_ - 1) * (cols_ - 1)),
      log_newtons_(rows_ * cols_),
      is_pressed_(rows_),
      is_compared_(rows_) {}

void AgeingMonitor::add(const ForceFrame& force) noexcept {
  if (has(force.status, FrameStatus::rejected)) return;
  assert(force.newtons.size() == log_newtons_.size());
  for (std::size_t row = 0; row < rows_; ++row) take_row(force, row);
  for (std::size_t row = 0; row + 1 < rows_; ++row) compare_row(row);
}

/// Most rows are not pressed, which is known at a glance.
void AgeingMonitor::take_row(const ForceFrame& force, std::size_t row) noexcept {
  const std::size_t begin = row * cols_;
  const std::size_t end = begin + cols_;
  int pressed = 0;
  for (std::size_t taxel = begin; taxel < end; ++taxel) {
    pressed |= static_cast<int>(force.sigma_newtons[taxel] < kMostRelativeSigma * force.newtons[taxel]);
  }
  is_pressed_[row] = pressed != 0;
  if (pressed == 0) return;
  for (std::size_t taxel = begin; taxel < end; ++taxel) {
    const bool is_pressed = force.taxels[taxel] == TaxelStatus::ok && force.newtons[taxel] > 0.0F &&
                            force.sigma_newtons[taxel] < kMostRelativeSigma * force.newtons[taxel];
    log_newtons_[taxel] = is_pressed ? std::log(force.newtons[taxel]) : std::numeric_limits<float>::quiet_NaN();
  }
}

/// The squares between this row and the next.
void AgeingMonitor::compare_row(std::size_t row) noexcept {
  const bool are_pressed = is_pressed_[row] && is_pressed_[row + 1];
  if (!are_pressed && !is_compared_[row]) return;
  is_compared_[row] = are_pressed;
  Block* const blocks = blocks_.data() + row * (cols_ - 1);
  for (std::size_t col = 0; col + 1 < cols_; ++col) {
    if (are_pressed) {
      compare(blocks[col], row * cols_ + col);
    } else if (blocks[col].frames > 0) {
      end_touch(blocks[col]);
    }
  }
}

void AgeingMonitor::compare(Block& block, std::size_t taxel) noexcept {
  const float* const upper = log_newtons_.data() + taxel;
  const float* const lower = upper + cols_;
  const float d = upper[0] - upper[1] - lower[0] + lower[1];
  if (std::isnan(d)) {
    if (block.frames > 0) end_touch(block);
    return;
  }
  const auto [least, most] = std::minmax({upper[0], upper[1], lower[0], lower[1]});
  const float along_x = upper[1] - upper[0] + lower[1] - lower[0];
  const float along_y = lower[0] - upper[0] + lower[1] - upper[1];
  const std::uint8_t way = (along_x > 0.0F) == (along_y > 0.0F) ? 0 : 1;
  if (block.frames == 0) block.way = way;
  block.is_over = block.is_over || way != block.way;
  if (block.is_over) return;
  const float weight = weight_of(most - least);
  block.sum += static_cast<double>(weight * d);
  block.sum_weight += static_cast<double>(weight);
  ++block.frames;
}

void AgeingMonitor::end_touch(Block& block) noexcept {
  const auto d = static_cast<float>(block.sum / block.sum_weight);
  const auto weight = static_cast<float>(block.sum_weight / block.frames);
  float& of_touches = block.weight[block.way];
  of_touches = std::min(of_touches + weight, kMostWeight);
  block.mean[block.way] += weight / of_touches * (d - block.mean[block.way]);
  ++comparisons_;
  block.is_over = false;
  block.frames = 0;
  block.sum = 0.0;
  block.sum_weight = 0.0;
}

AgeingEvidence AgeingMonitor::evidence() const {
  double weights = 0.0;
  double square_weights = 0.0;
  double products = 0.0;
  double square_products = 0.0;
  double squares = 0.0;  // of the differences of the two means: they are of different touches
  for (const Block& block : blocks_) {
    if (block.weight[0] == 0.0F || block.weight[1] == 0.0F) continue;
    const double weight =
        1.0 / (1.0 / static_cast<double>(block.weight[0]) + 1.0 / static_cast<double>(block.weight[1]));
    const auto one = static_cast<double>(block.mean[0]);
    const auto other = static_cast<double>(block.mean[1]);
    weights += weight;
    square_weights += weight * weight;
    products += weight * one * other;
    square_products += weight * one * other * one * other;
    squares += weight * (one - other) * (one - other);
  }
  AgeingEvidence evidence;
  evidence.comparisons = comparisons_;
  evidence.calibrated_spread = calibrated_spread_;
  if (weights == 0.0) return evidence;
  const double blocks = weights * weights / square_weights;
  evidence.blocks = static_cast<std::size_t>(blocks);
  if (evidence.blocks < kLeastBlocks) return evidence;
  const double variance = std::max(products / weights, 0.0);
  const double scatter = squares / weights;  // twice the variance of a mean
  // A few squares between two touches may stand out: how the products differ counts, too.
  const double of_products = std::max(square_products / weights - variance * variance, 0.0);
  const double of_touches = variance * scatter + 0.25 * scatter * scatter;
  const double sigma = std::sqrt(kSharing * std::max(of_products, of_touches) / blocks);
  const double spread = std::sqrt(variance / kVariances);
  evidence.gain_spread = spread;
  evidence.spread_sigma = sigma / (2.0 * kVariances * std::max(spread, std::sqrt(sigma / kVariances)));
  return evidence;
}

}  // namespace dermis::learn::health
