// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/touch_script.hpp"

#include <algorithm>
#include <limits>

namespace dermis::learn::simulation {
namespace {

constexpr std::uint64_t kFirstStream = std::numeric_limits<std::uint64_t>::max() - 16;  // No frame has this index.
constexpr std::size_t kSlots = 4;                                                       // As many touches at once.
constexpr double kUnloadedS = 2.0;                                                      // At the beginning.

constexpr double kWeakestPeakN = 1.0;
constexpr double kStrongestN = 50.0;
constexpr double kWeakestHoldN = 0.5;
constexpr std::uint64_t kMostLevels = 4;
constexpr double kGivingWayShare = 0.6;
constexpr double kShortGapShare = 0.35;

double draw_next_level(double force_n, Random& random) {
  const bool gives_way = random.uniform() < kGivingWayShare;
  const double ratio = gives_way ? random.uniform(0.2, 0.8) : random.uniform(1.2, 3.0);
  return std::clamp(ratio * force_n, kWeakestHoldN, kStrongestN);
}

}  // namespace

TouchScript::TouchScript(const ArrayDescription& array, double seconds, std::uint64_t seed) : array_(array) {
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    Random random = Random::stream(seed, kFirstStream - slot);
    slots_.push_back(draw_slot(slot, seconds, random));
  }
}

std::vector<TouchScript::Touch> TouchScript::draw_slot(std::size_t slot, double seconds, Random& random) const {
  std::vector<Touch> touches;
  const double longest_pause_s = 3.0 + 2.0 * static_cast<double>(slot);
  double time_s = kUnloadedS + (slot == 0 ? 0.0 : random.uniform(0.0, longest_pause_s));
  bool returns = false;
  while (time_s < seconds) {
    Touch touch;
    touch.place = returns ? touches.back().place : draw_place(array_, random);
    touch.corners = {{time_s, 0.0}};
    const auto go_to = [&](double level_n, double fastest_s, double slowest_s) {
      time_s += random.log_uniform(fastest_s, slowest_s);
      touch.corners.push_back({time_s, level_n});
    };
    const std::uint64_t levels = 1 + random.below(kMostLevels);
    double force_n = random.log_uniform(kWeakestPeakN, kStrongestN);
    for (std::uint64_t level = 0; level < levels; ++level) {
      if (level > 0) force_n = draw_next_level(force_n, random);
      go_to(force_n, 0.03, 1.0);
      go_to(force_n, 0.2, 5.0);
    }
    go_to(0.0, 0.03, 0.5);
    touches.push_back(touch);
    returns = random.uniform() < kShortGapShare;
    time_s += returns ? random.uniform(0.05, 0.5) : random.uniform(0.5, longest_pause_s);
  }
  return touches;
}

double TouchScript::Touch::force(double time_s) const {
  const auto is_before = [](double time, const Corner& corner) { return time < corner.time_s; };
  const auto next = std::upper_bound(corners.begin(), corners.end(), time_s, is_before);
  if (next == corners.begin() || next == corners.end()) return 0.0;
  const Corner& last = *(next - 1);
  return last.force_n + (next->force_n - last.force_n) * (time_s - last.time_s) / (next->time_s - last.time_s);
}

void TouchScript::add_forces(double time_s, std::vector<double>& force_n) const {
  for (const std::vector<Touch>& touches : slots_) {
    const auto begins_after = [](double time, const Touch& touch) { return time < touch.corners.front().time_s; };
    const auto next = std::upper_bound(touches.begin(), touches.end(), time_s, begins_after);
    if (next == touches.begin()) continue;
    const Touch& touch = *(next - 1);
    const double now_n = touch.force(time_s);
    if (now_n > 0.0) add_touch(array_, touch.place, now_n, force_n);
  }
  for (double& on_taxel_n : force_n) on_taxel_n = std::min(on_taxel_n, kStrongestN);
}

}  // namespace dermis::learn::simulation
