// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/labels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace dermis::learn::calibration {

Status check_loads(const ArrayDescription& array, std::size_t frame_count, std::span<const Load> loads) {
  if (loads.empty()) return bad_input("the loads name no frame: known loads are needed");
  for (const Load& load : loads) {
    if (load.frame >= frame_count) {
      return bad_input(fmt::format("a load names frame {}, there are {} (counted from 0)", load.frame, frame_count));
    }
    if (load.kind == LoadKind::pressure && !array.taxel_area_m2) {
      return bad_input("loads given as pressure need array.taxel_area_mm2");
    }
  }
  return Done{};
}

double total_newtons(const Load& load, const ArrayDescription& array) {
  if (load.kind == LoadKind::force) return load.value;
  return load.value * array.taxel_area_m2.value_or(0.0) * static_cast<double>(load.where.taxel_count());
}

std::vector<std::optional<double>> newtons_of_frames(const ArrayDescription& array, std::size_t frame_count,
                                                     std::span<const Load> loads) {
  std::vector<std::optional<double>> newtons(frame_count);
  for (const Load& load : loads) newtons[load.frame] = newtons[load.frame].value_or(0.0) + total_newtons(load, array);
  return newtons;
}

LoadsOfFrames::LoadsOfFrames(std::span<const Load> loads, std::size_t frame_count)
    : loads_(loads), first_(frame_count + 1) {
  const auto is_earlier = [](const Load& a, const Load& b) { return a.frame < b.frame; };
  if (!std::is_sorted(loads.begin(), loads.end(), is_earlier)) {
    sorted_.assign(loads.begin(), loads.end());
    std::stable_sort(sorted_.begin(), sorted_.end(), is_earlier);
    loads_ = sorted_;
  }
  for (const Load& load : loads_) ++first_[load.frame + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

void expand_loads(const ArrayDescription& array, std::span<const Load> loads, Sample& sample) {
  sample.known_newtons.assign(array.taxel_count(), 0.0F);
  sample.totals.clear();
  sample.unloaded = true;
  for (const Load& load : loads) {
    std::vector<std::size_t> taxels = taxel_indices(load.where, array.cols);
    std::erase_if(taxels, [&](std::size_t taxel) { return array.is_absent(taxel); });
    if (load.value > 0.0) sample.unloaded = false;
    const bool is_shared = load.kind == LoadKind::force && taxels.size() > 1 && load.value > 0.0;
    const double known = load.kind == LoadKind::pressure ? load.value * array.taxel_area_m2.value_or(0.0) : load.value;
    for (const std::size_t taxel : taxels) {
      sample.known_newtons[taxel] = is_shared ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(known);
    }
    if (is_shared) sample.totals.push_back({std::move(taxels), load.value});
  }
  for (const std::size_t taxel : array.absent) sample.known_newtons[taxel] = std::numeric_limits<float>::quiet_NaN();
}

std::vector<float> film_newtons(std::vector<float> newtons, const std::vector<TotalForce>& totals) {
  for (const auto& [taxels, total, material_share] : totals) {
    for (const std::size_t taxel : taxels)
      newtons[taxel] = static_cast<float>(total / static_cast<double>(taxels.size()));
  }
  return newtons;
}

}  // namespace dermis::learn::calibration
