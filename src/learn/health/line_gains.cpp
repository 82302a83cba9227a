// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/line_gains.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/line_order.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kLines = 4;
constexpr float kMostRelativeSigma = 0.25F;
constexpr double kContrast = 0.7;     // of ln F between two neighbours, from which on they count less
constexpr double kMostWeight = 64.0;  // of the touches that a window remembers of each side
constexpr double kLeastWeight = 2.0;
constexpr std::size_t kLeastComparisons = 4;
constexpr std::array<std::array<std::size_t, 2>, 2> kOpposite{{{0, 3}, {1, 2}}};  // quarters
constexpr double kAgreeing = 2.0 / 3.0;  // of the windows: a shape that comes to one place is no gain
constexpr double kVariances = 20.0;      // of ln g, in that of t
constexpr double kSharing = 2.3;         // windows that share lines are alike
constexpr double kSigmas = 5.0;
constexpr double kLeastSpread = 0.07;

}  // namespace

LineGains::LineGains(const touch::pipeline::Model& model, Axis axis) : array_(model.array), axis_(axis) {
  const std::size_t lines = line_count(array_, axis);
  if (lines >= kLines) windows_.resize(lines - kLines + 1);
}

void LineGains::add(const ForceFrame& force) {
  if (has(force.status, FrameStatus::rejected)) return;
  for (std::size_t first = 0; first < windows_.size(); ++first) compare(windows_[first], first, force);
}

void LineGains::compare(Window& window, std::size_t first, const ForceFrame& force) {
  double weights = 0.0;
  double sum = 0.0;
  double slope = 0.0;
  double place = 0.0;
  for (std::size_t along = 0; along < line_length(array_, axis_); ++along) {
    std::array<double, kLines> log_newtons{};
    double contrast = 0.0;
    bool is_pressed = true;
    for (std::size_t k = 0; k < kLines && is_pressed; ++k) {
      const std::size_t taxel = taxel_on_line(array_, axis_, first + k, along);
      is_pressed = force.taxels[taxel] == TaxelStatus::ok && force.newtons[taxel] > 0.0F &&
                   force.sigma_newtons[taxel] < kMostRelativeSigma * force.newtons[taxel];
      if (!is_pressed) break;
      log_newtons[k] = std::log(static_cast<double>(force.newtons[taxel]));
      if (k > 0) contrast = std::max(contrast, std::abs(log_newtons[k] - log_newtons[k - 1]));
    }
    if (!is_pressed) continue;
    const double weight = 1.0 / (1.0 + std::pow(contrast / kContrast, 4));
    weights += weight;
    place += weight * static_cast<double>(along);
    sum += weight * (log_newtons[3] - 3.0 * log_newtons[2] + 3.0 * log_newtons[1] - log_newtons[0]);
    slope += weight * (log_newtons[3] + log_newtons[2] - log_newtons[1] - log_newtons[0]);
  }
  if (weights == 0.0) {
    if (window.frames > 0) end_touch(window);
    return;
  }
  const bool is_far = 2.0 * place > weights * static_cast<double>(line_length(array_, axis_) - 1);
  const auto quarter = static_cast<std::uint8_t>((slope > 0.0 ? 2 : 0) + (is_far ? 1 : 0));
  if (window.frames == 0) window.quarter = quarter;
  window.is_over = window.is_over || quarter != window.quarter;
  if (window.is_over) return;
  ++window.frames;
  window.sum += sum;
  window.sum_weight += weights;
}

void LineGains::end_touch(Window& window) {
  const double t = window.sum / window.sum_weight;
  const double weight = std::min(window.sum_weight / static_cast<double>(window.frames), 1.0);
  double& of_touches = window.weight[window.quarter];
  of_touches = std::min(of_touches + weight, kMostWeight);
  window.mean[window.quarter] += weight / of_touches * (t - window.mean[window.quarter]);
  ++touches_;
  window.is_over = false;
  window.frames = 0;
  window.sum = 0.0;
  window.sum_weight = 0.0;
}

std::optional<std::string> LineGains::finding(double least_spread) const {
  double weights = 0.0;
  double products = 0.0;
  double squares = 0.0;  // of the differences of the two means
  std::size_t compared = 0;
  std::size_t agreeing = 0;
  for (const Window& window : windows_) {
    for (const auto& [one, other] : kOpposite) {
      if (std::min(window.weight[one], window.weight[other]) < kLeastWeight) continue;
      const double product = window.mean[one] * window.mean[other];
      const double weight = 1.0 / (1.0 / window.weight[one] + 1.0 / window.weight[other]);
      weights += weight;
      products += weight * product;
      squares += weight * std::pow(window.mean[one] - window.mean[other], 2);
      ++compared;
      if (product > 0.0) ++agreeing;
    }
  }
  if (compared < kLeastComparisons || static_cast<double>(agreeing) < kAgreeing * static_cast<double>(compared))
    return {};
  const double variance = products / weights;
  const double chance = 0.5 * squares / weights * std::sqrt(kSharing / static_cast<double>(compared));
  const double spread = std::sqrt(std::max(variance, 0.0) / kVariances);
  if (variance < kSigmas * chance || spread < std::max(kLeastSpread, least_spread)) return {};
  return fmt::format("recalibrate: gains have changed by about {:.0f} % from {} to {} ({} touches)", 100.0 * spread,
                     to_string(axis_), to_string(axis_), touches_);
}

}  // namespace dermis::learn::health
