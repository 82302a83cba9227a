// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/supply_dips.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kLeastFrames = 10;  // of a taxel, before its mean counts
constexpr double kMostFrames = 1000.0;    // that a mean remembers
constexpr double kLeastTaxels = 10.0;
constexpr double kSigmas = 3.0;
constexpr double kLeastDepth = 0.02;
constexpr std::size_t kLeastDips = 5;
constexpr double kLeastShare = 0.005;  // of the frames: more than chance
constexpr double kTold = 4.0;          // standard deviations: taxels that conduct alike do not tell a factor from hum
constexpr std::size_t kOneSided = 4;   // times as many dips as rises: noise goes both ways

}  // namespace

void SupplyDips::add(std::size_t taxel, double siemens, double sigma_siemens) {
  if (frames_[taxel] >= kLeastFrames) {
    sums_.count += 1.0;
    sums_.x += mean_[taxel];
    sums_.y += siemens;
    sums_.xx += mean_[taxel] * mean_[taxel];
    sums_.xy += mean_[taxel] * siemens;
    sums_.variance += sigma_siemens * sigma_siemens;
  }
  ++frames_[taxel];
  mean_[taxel] += (siemens - mean_[taxel]) / std::min(static_cast<double>(frames_[taxel]), kMostFrames);
}

void SupplyDips::end_frame(bool is_untouched) {
  const Sums sums = sums_;
  sums_ = {};
  if (!is_untouched || sums.count < kLeastTaxels || !(sums.x > 0.0) || !(sums.variance > 0.0)) return;
  const double spread = sums.xx - sums.x * sums.x / sums.count;
  const double slope = spread > 0.0 ? (sums.xy - sums.x * sums.y / sums.count) / spread : 1.0;
  const double weight = spread * sums.count / sums.variance;
  around_[levels_++ % kAround] = {sums.y / sums.x, std::sqrt(sums.variance) / sums.x, slope, weight};
  if (levels_ >= kAround) judge_middle();
}

/// Against the lower of the medians before and after it: drift moves one of them.
void SupplyDips::judge_middle() {
  constexpr std::size_t kHalf = kAround / 2;
  const auto at = [&](std::size_t place) { return around_[(levels_ + place) % kAround]; };
  std::vector<double> before;
  std::vector<double> after;
  for (std::size_t k = 0; k < kHalf; ++k) {
    before.push_back(at(k).share);
    after.push_back(at(kHalf + 1 + k).share);
  }
  const double earlier = upper_median(std::move(before));
  const double later = upper_median(std::move(after));
  const Level middle = at(kHalf);
  const double least = std::max(kSigmas * middle.sigma, kLeastDepth);
  if (middle.share < std::min(earlier, later) - least) {
    ++dips_;
    depth_ += 1.0 - middle.share / std::min(earlier, later);
    slope_ += middle.weight * (1.0 - middle.slope);
    weight_ += middle.weight;
  }
  if (middle.share > std::max(earlier, later) + least) ++rises_;
}

std::optional<std::string> SupplyDips::finding() const {
  const auto frames = static_cast<double>(levels_);
  if (dips_ < kLeastDips || static_cast<double>(dips_) < kLeastShare * frames || dips_ < kOneSided * rises_) return {};
  const double depth = depth_ / static_cast<double>(dips_);
  const bool tells_factors = weight_ > std::pow(kTold / depth, 2);
  if (tells_factors && slope_ < 0.5 * depth * weight_) return {};
  return fmt::format(
      "the supply falls by about {:.0f} % in {} of {} untouched frames, and nothing in the frames says so: all "
      "readings fall together; check its wires, or send its voltage; forces are too low there",
      100.0 * depth, dips_, levels_);
}

}  // namespace dermis::learn::health
