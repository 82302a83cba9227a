// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/recalibration/known_presses.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kReleased = 1.0 / 3.0;  // of what was read
constexpr float kPressedSigmas = 3.0F;
constexpr double kLeastSigma = 0.005;  // relative

/// The readings of pressed taxels, together.
struct Reading {
  std::vector<double> newtons;  // of each of them, 0 where it is not pressed
  double total_n = 0.0;
  double sigma_n = 0.0;  // NaN where a force is not known, infinite where it has no upper bound
};

Reading read(const ForceFrame& force, std::span<const std::size_t> taxels) {
  Reading reading;
  double variance = 0.0;
  for (const std::size_t taxel : taxels) {
    const bool is_noise = force.signal_to_noise[taxel] < kPressedSigmas;
    const double newtons = is_noise ? 0.0 : static_cast<double>(force.newtons[taxel]);
    reading.newtons.push_back(newtons);
    reading.total_n += newtons;
    if (!is_noise) variance += std::pow(static_cast<double>(force.sigma_newtons[taxel]), 2);
  }
  reading.sigma_n = std::sqrt(variance);
  return reading;
}

/// On the taxels that are there: a pressure does not press the others.
double known_newtons(const Load& load, const ArrayDescription& array, std::size_t taxels) {
  if (load.kind == LoadKind::force) return load.value;
  return total_newtons(load, array) * static_cast<double>(taxels) / static_cast<double>(load.where.taxel_count());
}

bool is_pressed(const Load& load) {
  return load.value > 0.0;
}

}  // namespace

std::size_t pressed_taxels(std::span<const KnownPress> presses) {
  std::set<std::size_t> pressed;
  for (const KnownPress& press : presses) pressed.insert(press.taxels.begin(), press.taxels.end());
  return pressed.size();
}

void KnownPresses::add(const ForceFrame& force, std::span<const Load> loads) {
  if (has(force.status, FrameStatus::rejected)) return;
  end_if_released(force, loads);
  for (const Load& load : loads) {
    if (!is_pressed(load)) continue;
    Touch& touch = touch_of(load);
    const Reading reading = read(force, touch.taxels);
    const double relative = reading.sigma_n / reading.total_n;
    if (!(reading.total_n > 0.0) || !std::isfinite(relative)) continue;
    ++touch.frames;
    touch.last_n = reading.total_n;
    touch.log_sum += std::log(known_newtons(load, array_, touch.taxels.size()) / reading.total_n);
    touch.sigma_sum += std::max(relative, kLeastSigma);
    for (std::size_t k = 0; k < touch.taxels.size(); ++k) {
      touch.share_sum[k] += reading.newtons[k] / reading.total_n;
    }
  }
}

void KnownPresses::finish() {
  for (const Touch& touch : touches_) end(touch);
  touches_.clear();
}

/// A labelled frame that does not name its region ends a press, too.
void KnownPresses::end_if_released(const ForceFrame& force, std::span<const Load> loads) {
  std::erase_if(touches_, [&](const Touch& touch) {
    const auto is_here = [&](const Load& load) { return is_pressed(load) && load.where == touch.where; };
    const bool is_elsewhere = !loads.empty() && std::none_of(loads.begin(), loads.end(), is_here);
    const bool is_over = is_elsewhere || read(force, touch.taxels).total_n < kReleased * touch.last_n;
    if (is_over) end(touch);
    return is_over;
  });
}

KnownPresses::Touch& KnownPresses::touch_of(const Load& load) {
  const auto is_same = [&](const Touch& touch) { return touch.where == load.where; };
  const auto found = std::find_if(touches_.begin(), touches_.end(), is_same);
  if (found != touches_.end()) return *found;
  Touch touch;
  touch.where = load.where;
  touch.taxels = taxel_indices(load.where, array_.cols);
  std::erase_if(touch.taxels, [&](std::size_t taxel) { return array_.is_absent(taxel); });
  touch.share_sum.assign(touch.taxels.size(), 0.0);
  return touches_.emplace_back(std::move(touch));
}

void KnownPresses::end(const Touch& touch) {
  if (touch.frames == 0) {
    ++left_out_;
    return;
  }
  const auto frames = static_cast<double>(touch.frames);
  KnownPress press;
  press.log_ratio = touch.log_sum / frames;
  press.sigma = touch.sigma_sum / frames;
  for (std::size_t k = 0; k < touch.taxels.size(); ++k) {
    if (touch.share_sum[k] <= 0.0) continue;
    press.taxels.push_back(touch.taxels[k]);
    press.shares.push_back(touch.share_sum[k] / frames);
  }
  presses_.push_back(std::move(press));
}

}  // namespace dermis::learn::calibration
