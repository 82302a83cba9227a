// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/missing_taxels.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/readout_parts.hpp"
#include "touch/compensation/sensed_line.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr std::uint8_t kLong = 4;  // frames without a reading, from which on the last conductance is stale
constexpr Nanos kLongestGap = std::chrono::milliseconds(50);  // likewise, since the last frame
constexpr Nanos kFresh = std::chrono::milliseconds(5);        // an estimate
constexpr double kAlike = 0.004;                              // of the supply: readings that tell the same
constexpr double kDoubtOfEstimate = 0.7;                      // relative
constexpr double kDoubtOfHeld = 0.15;
constexpr double kFloorShare = 1e-3;       // of the largest conductance: where logarithms end
constexpr double kMostRise = 1.0;          // of the logarithm above both neighbours
constexpr double kUnloadedScatter = 0.02;  // at least, of the middle of a line
constexpr double kShiftByPressed = 1.0;    // of that middle where a third is pressed, in median deviations
constexpr std::size_t kFewest = 4;         // taxels that are evidence
constexpr std::size_t kMostCompared = 32;  // likewise: of more, some spread over them tell as much
constexpr int kSteps = 8;
constexpr double kLeastChange = 1e-4;  // of a logarithm

/// The value between four of which some are known: on a parabola, as the logarithm of a Gaussian contact is. Beyond the
/// last known taxel a contact falls on as it comes, and never rises.
std::optional<double> between(const std::array<std::optional<double>, 4>& near) {
  const auto& [far_before, before, after, far_after] = near;
  if (!before || !after) {
    const std::optional<double>& next = before ? before : after;
    const std::optional<double>& far = before ? far_before : far_after;
    return next && far ? *next - std::max(*far - *next, 0.0) : next;
  }
  double value = 0.5 * (*before + *after);
  if (far_before && far_after) {
    value = (4.0 * (*before + *after) - (*far_before + *far_after)) / 6.0;
  } else if (far_before) {
    value = *before + (*after - *far_before) / 3.0;
  } else if (far_after) {
    value = *after + (*before - *far_after) / 3.0;
  }
  return std::min(value, std::max(*before, *after) + kMostRise);
}

/// Counts, for each value, the smaller ones: of few values, that is quicker than to sort them.
DERMIS_PROCESSOR_CLONES double median_of(std::span<const double> values) {
  std::array<double, kMostCompared> smaller{};
  const std::size_t size = values.size();
  const double* const all = values.data();
  double* const ranks = smaller.data();
  for (std::size_t other = 0; other < size; ++other) {
    const double value = all[other];
#pragma omp simd
    for (std::size_t k = 0; k < size; ++k) ranks[k] += value < all[k] ? 1.0 : 0.0;
  }
  const std::size_t half = size / 2;
  const auto middle = static_cast<double>(half);
  double median = 0.0;
  for (std::size_t k = 0; k < size; ++k) median = ranks[k] <= middle && all[k] > median ? all[k] : median;
  return median;
}

}  // namespace

MissingTaxels::MissingTaxels(const ArrayDescription& array, const ReferenceConductances& references)
    : array_(array),
      sharing_axis_(sharing_axis(array)),
      typical_siemens_(references.typical.begin(), references.typical.end()),
      unloaded_siemens_(references.unloaded.begin(), references.unloaded.end()),
      absent_(array.taxel_count()),
      missing_(array.taxel_count()),
      last_siemens_(array.taxel_count()),
      frames_ago_(array.taxel_count(), kLong),
      estimated_(array.taxel_count()),
      estimated_of_(array.taxel_count()),
      doubt_(array.taxel_count()),
      taken_(array.taxel_count()),
      rises_(array.taxel_count()) {
  typical_siemens_.resize(array.taxel_count(), 1.0);
  sorted_.reserve(kMostCompared);
  for (std::size_t taxel = 0; taxel < array.taxel_count() && array.readout.circuit != Circuit::none; ++taxel) {
    const std::size_t driven = line_of(array, driven_axis(array), taxel);
    const std::size_t sensed = line_of(array, crossing(driven_axis(array)), taxel);
    series_ohm_.push_back(array.readout.drive_ohm[driven] + sensed_line(array.readout, sensed).rho);
  }
  series_ohm_.resize(array.taxel_count(), std::numeric_limits<double>::max());
  for (const std::size_t taxel : array.absent) absent_[taxel] = 1;
  for (std::size_t line = 0; sharing_axis_ && line < line_count(array, *sharing_axis_); ++line) {
    const bool is_driven = *sharing_axis_ == driven_axis(array);
    const double ohm = is_driven ? array.readout.drive_ohm[line] : sensed_line(array.readout, line).rho;
    load_siemens_.push_back(ohm > 0.0 ? 1.0 / ohm : 0.0);
  }
  lacking_.resize(load_siemens_.size());
}

DERMIS_PROCESSOR_CLONES bool MissingTaxels::mark(std::span<const TaxelStatus> taxels,
                                                 std::span<const std::uint8_t> hidden) noexcept {
  const TaxelStatus* const status = taxels.data();
  const std::uint8_t* const is_hidden = hidden.data();
  const std::uint8_t* const is_absent = absent_.data();
  std::uint8_t* const missing = missing_.data();
  std::uint8_t any_missing = 0;
  std::uint8_t any_unread = 0;
  for (std::size_t taxel = 0; taxel < taxels.size(); ++taxel) {
    const auto is_invalid = static_cast<std::uint8_t>(status[taxel] == TaxelStatus::invalid ? 1 : 0);
    const auto is_unread = static_cast<std::uint8_t>(is_invalid & ~is_absent[taxel]);
    missing[taxel] = static_cast<std::uint8_t>(is_hidden[taxel] | is_unread);
    any_missing = static_cast<std::uint8_t>(any_missing | missing[taxel]);
    any_unread = static_cast<std::uint8_t>(any_unread | is_unread);
  }
  any_ = any_missing != 0;
  return any_unread != 0;
}

void MissingTaxels::forget() noexcept {
  std::fill(frames_ago_.begin(), frames_ago_.end(), std::uint8_t{kLong});
  std::fill(estimated_.begin(), estimated_.end(), 0.0);
  estimated_at_.reset();
}

void MissingTaxels::forget(std::size_t taxel) noexcept {
  frames_ago_[taxel] = kLong;
  estimated_[taxel] = 0.0;
}

void MissingTaxels::remember(std::span<const double> siemens) noexcept {
  if (!any_) {
    std::copy(siemens.begin(), siemens.end(), last_siemens_.begin());
    std::fill(frames_ago_.begin(), frames_ago_.end(), std::uint8_t{0});
    return;
  }
  for (std::size_t taxel = 0; taxel < missing_.size(); ++taxel) {
    if (is_missing(taxel)) continue;
    last_siemens_[taxel] = siemens[taxel];
    frames_ago_[taxel] = 0;
  }
}

void MissingTaxels::start_frame(Nanos time) noexcept {
  const Nanos since_last = time - last_time_;
  if (since_last == Nanos{}) return;  // the same frame again, with other faults
  last_time_ = time;
  if (since_last > kLongestGap || since_last < Nanos{}) forget();
  for (std::uint8_t& frames : frames_ago_) frames = static_cast<std::uint8_t>(std::min<int>(frames + 1, kLong));
}

std::optional<double> MissingTaxels::held(std::size_t taxel) const noexcept {
  if (frames_ago_[taxel] == kLong) return std::nullopt;
  return last_siemens_[taxel];
}

DERMIS_PROCESSOR_CLONES bool MissingTaxels::are_fresh(std::span<const double> ratio) const noexcept {
  if (!estimated_at_ || last_time_ < *estimated_at_ || last_time_ - *estimated_at_ >= kFresh) return false;
  const double* const now = ratio.data();
  const double* const before = estimated_of_.data();
  int changed = 0;
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    changed += std::abs(now[taxel] - before[taxel]) > kAlike ? 1 : 0;
  }
  return changed == 0;
}

void MissingTaxels::note_readings(std::span<const double> ratio) noexcept {
  estimated_at_ = last_time_;
  std::copy(ratio.begin(), ratio.end(), estimated_of_.begin());
}

void MissingTaxels::doubt_estimates() noexcept {
  for (std::size_t taxel = 0; taxel < missing_.size(); ++taxel) {
    if (!is_missing(taxel)) continue;
    const double before = estimated_[taxel] > 0.0 ? doubt_[taxel] : kDoubtOfEstimate;
    doubt_[taxel] = held(taxel) ? kDoubtOfHeld : std::min(std::hypot(before, kDoubtOfHeld), kDoubtOfEstimate);
  }
}

void MissingTaxels::keep_estimates(std::span<const double> siemens, bool are_solved) noexcept {
  for (std::size_t taxel = 0; taxel < missing_.size(); ++taxel) {
    estimated_[taxel] = is_missing(taxel) && are_solved ? siemens[taxel] : 0.0;
    if (is_missing(taxel) && doubt_[taxel] == 0.0) doubt_[taxel] = held(taxel) ? kDoubtOfHeld : kDoubtOfEstimate;
  }
}

std::optional<double> MissingTaxels::start(std::size_t taxel) const noexcept {
  if (frames_ago_[taxel] == kLong && estimated_[taxel] > 0.0) return estimated_[taxel];
  return held(taxel);
}

std::optional<double> MissingTaxels::logarithm(std::span<const double> values, std::size_t taxel,
                                               double floor) const noexcept {
  if (is_missing(taxel) || absent_[taxel] != 0) return std::nullopt;
  return std::log(std::max(values[taxel], floor) / typical_siemens_[taxel]);
}

/// On the row and on the column; the geometric mean where both give one.
void MissingTaxels::estimate(std::span<double> values) const noexcept {
  const double floor = kFloorShare * *std::max_element(values.begin(), values.end());
  if (!(floor > 0.0)) return;
  // The taxels -2, -1, +1 and +2 steps from `place` on a line.
  const auto along = [&](std::size_t taxel, std::size_t place, std::size_t size, std::size_t step) {
    std::array<std::optional<double>, 4> near;
    if (place > 1) near[0] = logarithm(values, taxel - 2 * step, floor);
    if (place > 0) near[1] = logarithm(values, taxel - step, floor);
    if (place + 1 < size) near[2] = logarithm(values, taxel + step, floor);
    if (place + 2 < size) near[3] = logarithm(values, taxel + 2 * step, floor);
    return between(near);
  };
  for (std::size_t taxel = 0; taxel < values.size(); ++taxel) {
    if (!is_missing(taxel)) continue;
    const std::optional<double> down = along(taxel, taxel / array_.cols, array_.rows, array_.cols);
    const std::optional<double> right = along(taxel, taxel % array_.cols, array_.cols, 1);
    const double count = (down ? 1.0 : 0.0) + (right ? 1.0 : 0.0);
    const double sum = down.value_or(0.0) + right.value_or(0.0);
    values[taxel] = count > 0.0 ? typical_siemens_[taxel] * std::exp(sum / count) : 0.0;
  }
}

double MissingTaxels::improve(std::span<double> siemens, bool lines_tell) noexcept {
  std::copy(siemens.begin(), siemens.end(), taken_.begin());
  lines_tell ? weigh(siemens) : estimate(siemens);
  double change = 0.0;
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    if (is_missing(taxel)) change = std::max(change, series_ohm_[taxel] * std::abs(siemens[taxel] - taken_[taxel]));
  }
  return change;
}

/// By the neighbours, and by the others of the line.
void MissingTaxels::weigh(std::span<double> siemens) noexcept {
  const bool lines_tell = sharing_axis_ && !unloaded_siemens_.empty();
  if (lines_tell) find_lacking(siemens);
  estimate(siemens);
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    if (!is_missing(taxel)) continue;
    const std::optional<double> before = held(taxel);
    siemens[taxel] = before.value_or(siemens[taxel]);
    doubt_[taxel] = before ? kDoubtOfHeld : kDoubtOfEstimate;
    if (!lines_tell) continue;
    const std::size_t line = line_of(array_, *sharing_axis_, taxel);
    if (lacking_[line]) improve(taxel, taken_[taxel], *lacking_[line], load_siemens_[line], siemens);
  }
}

/// On each line with missing taxels.
void MissingTaxels::find_lacking(std::span<const double> siemens) noexcept {
  find_rises(siemens);
  std::fill(lacking_.begin(), lacking_.end(), std::nullopt);
  const std::optional<Middle> whole = change_of_unloaded(std::nullopt, 0);
  for (std::size_t line = 0; whole && line < lacking_.size(); ++line) {
    if (load_siemens_[line] == 0.0 || !any_is_missing(line)) continue;
    const std::optional<Middle> of_line = change_of_unloaded(sharing_axis_, line);
    if (of_line) lacking_[line] = {of_line->value - whole->value, std::hypot(of_line->sigma, whole->sigma)};
  }
}

bool MissingTaxels::any_is_missing(std::size_t line) const noexcept {
  for (std::size_t k = 0; k < line_length(array_, *sharing_axis_); ++k) {
    if (is_missing(taxel_on_line(array_, *sharing_axis_, line, k))) return true;
  }
  return false;
}

DERMIS_PROCESSOR_CLONES void MissingTaxels::find_rises(std::span<const double> siemens) noexcept {
  const double* const solved = siemens.data();
  const double* const unloaded = unloaded_siemens_.data();
  double* const rises = rises_.data();
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    rises[taxel] = unloaded[taxel] > 0.0 ? solved[taxel] / unloaded[taxel] : 0.0;
  }
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    if (is_missing(taxel) || absent_[taxel] != 0) rises[taxel] = 0.0;
  }
}

/// The middle of ln(G / unloaded) on a line, or of all: where few are pressed, that of unloaded taxels. Logarithms keep
/// the order, so the middle of the quotients is theirs.
std::optional<MissingTaxels::Middle> MissingTaxels::change_of_unloaded(std::optional<Axis> axis,
                                                                       std::size_t line) noexcept {
  sorted_.clear();
  const std::size_t count = axis ? line_length(array_, *axis) : rises_.size();
  std::size_t step = (count + kMostCompared - 1) / kMostCompared;
  while (!axis && std::gcd(step, array_.cols) != 1) ++step;
  for (std::size_t k = 0; k < count; k += step) {
    const std::size_t taxel = axis ? taxel_on_line(array_, *axis, line, k) : k;
    if (rises_[taxel] > 0.0) sorted_.push_back(rises_[taxel]);
  }
  if (sorted_.size() < kFewest) return std::nullopt;
  const double middle = median_of(sorted_);
  for (double& value : sorted_) value = value > middle ? value / middle : middle / value;
  return Middle{std::log(middle), std::hypot(kUnloadedScatter, kShiftByPressed * std::log(median_of(sorted_)))};
}

/// The x that is most likely after both, by Gauss and Newton in ln x.
void MissingTaxels::improve(std::size_t taxel, double taken, const Middle& lacking, double load_siemens,
                            std::span<double> siemens) noexcept {
  const double prior = siemens[taxel];
  if (!(prior > 0.0)) return;
  const double weight_of_prior = 1.0 / (doubt_[taxel] * doubt_[taxel]);
  const double weight_of_line = 1.0 / (lacking.sigma * lacking.sigma);
  double log_change = 0.0;
  double information = weight_of_prior;
  for (int step = 0; step < kSteps; ++step) {
    const double x = prior * std::exp(log_change);
    const double misfit = std::log((load_siemens + x) / (load_siemens + taken)) + lacking.value;
    const double slope = x / (load_siemens + x);
    information = weight_of_prior + weight_of_line * slope * slope;
    const double change = (weight_of_prior * log_change + weight_of_line * misfit * slope) / information;
    log_change -= change;
    if (std::abs(change) < kLeastChange) break;
  }
  siemens[taxel] = prior * std::exp(log_change);
  doubt_[taxel] = 1.0 / std::sqrt(information);
}

}  // namespace dermis::touch::compensation
