// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/samples/sample_choice.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>

#include "dermis/learn/calibration/sample_database.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostOfPlace = 4000;         // as many points as a network of its own is trained on
constexpr std::size_t kLeastShareOfUnloaded = 16;  // one of so many samples may be: each shows the zero of all taxels
constexpr std::size_t kMostBytes = 180'000'000;
constexpr std::size_t kBytesPerTaxel = 17;  // of a sample: ratio, siemens, sigma, status, force
constexpr std::size_t kAllocations = 5;     // of a sample, and what each of them costs
constexpr std::size_t kBytesPerAllocation = 16;

/// A labelled frame and where it is pressed.
struct Candidate {
  std::uint64_t place = 0;
  double load = 0.0;  // sum of the values
  std::uint32_t frame = 0;

  [[nodiscard]] auto order() const { return std::tie(place, load, frame); }
};

/// FNV-1a over the regions that carry a load.
std::uint64_t place_of(std::span<const Load> loads) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto mix = [&](std::uint64_t value) { hash = (hash ^ value) * 0x100000001b3; };
  for (const Load& load : loads) {
    if (load.value <= 0.0) continue;
    mix(load.where.first_row);
    mix(load.where.first_col);
    mix(load.where.last_row);
    mix(load.where.last_col);
  }
  return hash;
}

/// By place, those of one place by rising load.
std::vector<Candidate> candidates_of(const LoadsOfFrames& loads) {
  std::vector<Candidate> candidates;
  candidates.reserve(loads.frame_count());
  for (std::size_t frame = 0; frame < loads.frame_count(); ++frame) {
    const std::span<const Load> of_frame = loads[frame];
    if (of_frame.empty()) continue;
    Candidate candidate{place_of(of_frame), 0.0, static_cast<std::uint32_t>(frame)};
    for (const Load& load : of_frame) candidate.load += load.value > 0.0 ? load.value : 0.0;
    candidates.push_back(candidate);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.order() < b.order(); });
  return candidates;
}

std::vector<std::span<const Candidate>> by_place(std::span<const Candidate> candidates) {
  std::vector<std::span<const Candidate>> places;
  for (std::size_t first = 0; first < candidates.size();) {
    std::size_t last = first;
    while (last < candidates.size() && candidates[last].place == candidates[first].place) ++last;
    places.push_back(candidates.subspan(first, last - first));
    first = last;
  }
  return places;
}

std::size_t count_of(std::span<const Candidate> place, std::size_t quota, std::size_t most) {
  const bool is_unloaded = place.back().load == 0.0;
  return std::min(place.size(), is_unloaded ? std::max(quota, most / kLeastShareOfUnloaded) : quota);
}

/// The most samples of one place with which all together are at most `most`; at least 1.
std::size_t quota_of(const std::vector<std::span<const Candidate>>& places, std::size_t most) {
  std::size_t low = 1;
  std::size_t high = kMostOfPlace;
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    std::size_t sum = 0;
    for (const auto& place : places) sum += count_of(place, middle, most);
    if (sum <= most) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

/// `count` of the values, evenly, both ends included.
template <typename Visit>
void for_each_evenly(std::span<const Candidate> values, std::size_t count, Visit visit) {
  for (std::size_t k = 0; k < count; ++k) {
    visit(values[count == 1 ? values.size() / 2 : k * (values.size() - 1) / (count - 1)]);
  }
}

}  // namespace

std::vector<bool> choose_samples(std::size_t taxels, const LoadsOfFrames& loads) {
  const std::size_t most = kMostBytes / (sizeof(Sample) + kAllocations * kBytesPerAllocation + kBytesPerTaxel * taxels);
  const std::vector<Candidate> candidates = candidates_of(loads);
  const std::vector<std::span<const Candidate>> places = by_place(candidates);
  const std::size_t quota = candidates.size() <= most ? candidates.size() : quota_of(places, most);
  std::vector<Candidate> chosen;
  for (const auto& place : places) {
    for_each_evenly(place, count_of(place, quota, most), [&](const Candidate& one) { chosen.push_back(one); });
  }
  std::vector<bool> is_chosen(loads.frame_count());
  for_each_evenly(chosen, std::min(chosen.size(), most), [&](const Candidate& one) { is_chosen[one.frame] = true; });
  return is_chosen;
}

}  // namespace dermis::learn::calibration
