// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/pipeline/live_noise.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace dermis::touch::pipeline {
namespace {

constexpr std::size_t kTaxelsPerFrame = 16;
constexpr std::size_t kFramesPerEstimate = 16;
constexpr double kVisibleSigmas = 3.0;  // of calibrated noise: an unloaded taxel that may read so much less
constexpr double kLeastGrowth = 1.25;   // less is chance, or touches that are hardly felt
constexpr double kNothing = 1.0 / 8.0;  // of its unloaded conductance: less is cut off by the ADC, or dead
constexpr double kOutlierSigmas = 3.0;
constexpr double kCutOffSigmas = 4.0;            // some of the noise that was cut off may lie there
constexpr double kLeastDeviations = 64.0;        // on each side
constexpr double kLeastShare = 1.0 / 3.0;        // of the other side's: else the zero has moved
constexpr std::uint32_t kMostDeviations = 2048;  // on one side: then half of them is forgotten

constexpr std::size_t kFramesPerProducts = 4;
constexpr double kKept = 1.0 - 1.0 / 64.0;  // of the products of deviations, from one time to the next
constexpr double kChanceSigmas = 3.0;

// Four bins for each doubling of a deviation, which the first bits of a float tell.
constexpr float kSmallest = 0.25F;
constexpr unsigned kShift = 21;

std::uint32_t first_bits(float value) {
  return std::bit_cast<std::uint32_t>(value) >> kShift;
}

/// Mean square of the deviations in a bin.
double square_of(std::size_t bin) {
  const auto least =
      static_cast<double>(std::bit_cast<float>((first_bits(kSmallest) + static_cast<std::uint32_t>(bin)) << kShift));
  const auto most = static_cast<double>(
      std::bit_cast<float>((first_bits(kSmallest) + static_cast<std::uint32_t>(bin) + 1) << kShift));
  return (least * least + least * most + most * most) / 3.0;
}

}  // namespace

LiveNoise::LiveNoise(const ArrayDescription& array, std::span<const double> unloaded_siemens)
    : unloaded_siemens_(unloaded_siemens.begin(), unloaded_siemens.end()),
      cols_(array.cols),
      driven_(driven_axis(array)),
      lines_(array.driven_lines()),
      products_(array.driven_lines()),
      shared_(array.driven_lines()) {}

void LiveNoise::raise(ConditionedFrame& conditioned) const noexcept {
  conditioned.noise_growth = growth_;
  conditioned.sigma_ratio *= growth_;
  conditioned.shared_noise = shared_;
}

void LiveNoise::observe(const ConductanceFrame& conductance, const ForceFrame& force) noexcept {
  constexpr FrameStatus kTellsNothing = FrameStatus::rejected | FrameStatus::not_converged;
  if (has(force.status, kTellsNothing)) return;
  count(conductance, force.signal_to_noise);
  if (growth_ > 1.0 && frame_ % kFramesPerProducts == 0) correlate(conductance, force.signal_to_noise);
  if (++frame_ % kFramesPerEstimate == 0 || frame_ < kFramesPerEstimate) estimate();
}

bool LiveNoise::is_visible(const ConductanceFrame& conductance, std::size_t taxel) const noexcept {
  return growth_ * unloaded_siemens_[taxel] > kVisibleSigmas * conductance.sigma_siemens[taxel];
}

void LiveNoise::count(const ConductanceFrame& conductance, std::span<const float> deviations) noexcept {
  const std::size_t taxels = unloaded_siemens_.size();
  const std::size_t part = frame_ < kFramesPerEstimate ? taxels : kTaxelsPerFrame;
  const std::size_t from = frame_ % ((taxels + part - 1) / part) * part;
  const std::size_t to = std::min(from + part, taxels);
  const auto growth = static_cast<float>(growth_);
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    const float deviation = deviations[taxel];
    if (std::isnan(deviation) || !is_visible(conductance, taxel)) continue;
    const std::uint32_t bits = first_bits(std::max(std::abs(deviation) * growth, kSmallest)) - first_bits(kSmallest);
    const std::uint32_t bin = std::min(bits, static_cast<std::uint32_t>(kBins));
    Counts& side = deviation > 0.0F ? above_ : below_;
    ++side[conductance.siemens[taxel] > kNothing * unloaded_siemens_[taxel] ? bin : kBins];
  }
}

/// Touches lie beyond the noise: the largest sizes are left out until all are within a few standard deviations.
/// Readings that are cut off have no size of their own. They come last and take sizes in again, so dead taxels beside
/// touches are no noise.
void LiveNoise::estimate() noexcept {
  std::size_t end = kBins;
  Noise noise = noise_below(end);
  for (std::size_t next = end_of_noise(noise, kOutlierSigmas); next < end; next = end_of_noise(noise, kOutlierSigmas)) {
    end = next;
    noise = noise_below(end);
  }
  add_cut_off(noise);
  for (std::size_t next = end_of_noise(noise, kCutOffSigmas); next > end; next = end_of_noise(noise, kCutOffSigmas)) {
    end = next;
    noise = noise_below(end);
    add_cut_off(noise);
  }
  const auto seen = std::accumulate(above_.begin(), above_.end(), std::uint32_t{0});
  if (seen > kMostDeviations) forget_half();
  if (noise.count < std::max(kLeastDeviations, kLeastShare * noise.more)) return;
  measured_ = noise.rms();
  const double chance = kChanceSigmas * measured_ / std::sqrt(4.0 * noise.count);
  growth_ = measured_ - chance > kLeastGrowth ? measured_ : 1.0;
  if (growth_ > 1.0) return;
  std::fill(products_.begin(), products_.end(), Products{});
  squares_ = {};
  std::fill(shared_.begin(), shared_.end(), 0.0F);
}

/// The first bin beyond some standard deviations.
std::size_t LiveNoise::end_of_noise(const Noise& noise, double sigmas) noexcept {
  std::size_t bin = 0;
  const double most = sigmas * std::max(noise.rms(), 1.0);
  while (bin < kBins && square_of(bin) <= most * most) ++bin;
  return bin;
}

/// The deviations in bins before `end` that both sides have.
LiveNoise::Noise LiveNoise::noise_below(std::size_t end) const noexcept {
  Noise noise;
  std::uint32_t above = 0;
  std::uint32_t below = 0;
  for (std::size_t bin = end; bin-- > 0;) {
    const std::uint32_t larger = std::min(above, below);
    above += above_[bin];
    below += below_[bin];
    const auto count = static_cast<double>(std::min(above, below) - larger);
    const double left = static_cast<double>(above_[bin]) - count;
    noise.count += count;
    noise.squares += count * square_of(bin);
    noise.left_above += left;
    noise.left_squares += left * square_of(bin);
  }
  noise.more = std::max(above, below);
  return noise;
}

/// Deviations that were cut off below have the sizes of those which are left above.
void LiveNoise::add_cut_off(Noise& noise) const noexcept {
  const double matched = std::min(static_cast<double>(below_[kBins]), noise.left_above);
  if (matched <= 0.0) return;
  noise.count += matched;
  noise.squares += matched * noise.left_squares / noise.left_above;
}

void LiveNoise::correlate(const ConductanceFrame& conductance, std::span<const float> deviations) noexcept {
  sum_lines(conductance, deviations);
  for (Products& products : products_) products = {kKept * products.count, kKept * products.sum};
  squares_ = {kKept * squares_.count, kKept * squares_.sum};
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    const LineSum& one = lines_[line];
    squares_ = {squares_.count + one.count, squares_.sum + one.squares};
    products_[0].count += 0.5 * one.count * (one.count - 1.0);
    products_[0].sum += 0.5 * (one.sum * one.sum - one.squares);
    for (std::size_t distance = 1; line + distance < lines_.size(); ++distance) {
      const LineSum& other = lines_[line + distance];
      products_[distance].count += one.count * other.count;
      products_[distance].sum += one.sum * other.sum;
    }
  }
  const double variance = squares_.sum / std::max(squares_.count, 1.0);
  for (std::size_t distance = 0; distance < products_.size(); ++distance) {
    const auto& [count, sum] = products_[distance];
    const double share = sum / std::max(count * variance, std::numeric_limits<double>::min());
    const double least = distance == 0 ? 0.0 : -static_cast<double>(shared_[0]);
    const double most = distance == 0 ? 1.0 : static_cast<double>(shared_[0]);
    const bool is_chance = share * share * count < kChanceSigmas * kChanceSigmas;
    shared_[distance] = is_chance ? 0.0F : static_cast<float>(std::clamp(share, least, most));
  }
}

void LiveNoise::sum_lines(const ConductanceFrame& conductance, std::span<const float> deviations) noexcept {
  std::fill(lines_.begin(), lines_.end(), LineSum{});
  for (std::size_t taxel = 0; taxel < deviations.size(); ++taxel) {
    const auto deviation = static_cast<double>(deviations[taxel]);
    if (!(std::abs(deviation) < kOutlierSigmas) || !is_visible(conductance, taxel)) continue;
    LineSum& line = lines_[driven_ == Axis::row ? taxel / cols_ : taxel % cols_];
    line.count += 1.0;
    line.sum += deviation;
    line.squares += deviation * deviation;
  }
}

void LiveNoise::forget_half() noexcept {
  for (std::uint32_t& count : above_) count /= 2;
  for (std::uint32_t& count : below_) count /= 2;
}

}  // namespace dermis::touch::pipeline
