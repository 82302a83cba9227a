// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <cstdint>

#include "dermis/learn/recognition/touch_finder.hpp"
#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::recognition {
namespace {

std::size_t length_of(const Touch& touch) {
  return touch.last - touch.first + 1;
}

std::size_t overlap_of(const Touch& a, const Touch& b) {
  const std::size_t first = std::max(a.first, b.first);
  const std::size_t last = std::min(a.last, b.last);
  return last >= first ? last - first + 1 : 0;
}

bool is_match(const Touch& a, const Touch& b) {
  const std::size_t overlap = overlap_of(a, b);
  return overlap > 0 && 2 * overlap >= length_of(a) + length_of(b) - overlap;
}

/// The touches in order that overlap one.
std::span<const Touch> overlapping(std::span<const Touch> touches, const Touch& touch) {
  const auto begin = std::lower_bound(touches.begin(), touches.end(), touch.first,
                                      [](const Touch& each, std::size_t frame) { return each.last < frame; });
  auto end = begin;
  while (end != touches.end() && end->first <= touch.last) ++end;
  return {begin, end};
}

std::vector<Touch> in_order(std::span<const Touch> touches) {
  std::vector<Touch> sorted(touches.begin(), touches.end());
  std::sort(sorted.begin(), sorted.end(), [](const Touch& a, const Touch& b) { return a.first < b.first; });
  return sorted;
}

/// 2 found / (labelled + touches): the harmonic mean of the shares that are right of both.
double worth_of(std::span<const Touch> labelled, std::span<const Touch> touches) {
  const FindingReport report = judge_finding(labelled, touches);
  return 2.0 * static_cast<double>(report.found) / static_cast<double>(labelled.size() + touches.size());
}

/// How many frames more the labels have on the side of most touches that they overlap.
void set_margins(TouchLimits& limits, std::span<const Touch> labelled, std::span<const Touch> touches) {
  constexpr std::int64_t kMostMargin = 1000;
  std::vector<std::int64_t> before;
  std::vector<std::int64_t> after;
  for (const Touch& label : labelled) {
    const std::span<const Touch> found = overlapping(touches, label);
    if (found.size() != 1) continue;
    before.push_back(static_cast<std::int64_t>(found.front().first) - static_cast<std::int64_t>(label.first));
    after.push_back(static_cast<std::int64_t>(label.last) - static_cast<std::int64_t>(found.front().last));
  }
  if (before.empty()) return;
  limits.before_frames = static_cast<std::size_t>(std::clamp<std::int64_t>(upper_median(before), 0, kMostMargin));
  limits.after_frames = static_cast<std::size_t>(std::clamp<std::int64_t>(upper_median(after), 0, kMostMargin));
}

/// A low one among the peak forces of the labelled touches.
double weak_peak(std::span<const double> forces, std::span<const Touch> labelled) {
  constexpr double kWeak = 0.2;
  std::vector<double> peaks;
  for (const Touch& label : labelled) {
    const std::span<const double> held = forces.subspan(label.first, length_of(label));
    peaks.push_back(*std::max_element(held.begin(), held.end()));
  }
  return std::max(quantile(std::move(peaks), kWeak), 1e-6);
}

}  // namespace

FindingReport judge_finding(std::span<const Touch> labelled, std::span<const Touch> found) {
  const std::vector<Touch> labels = in_order(labelled);
  const std::vector<Touch> touches = in_order(found);
  FindingReport report;
  report.labelled = labels.size();
  for (const Touch& label : labels) {
    const std::span<const Touch> near = overlapping(touches, label);
    report.found += std::any_of(near.begin(), near.end(), [&](const Touch& touch) { return is_match(touch, label); });
  }
  for (const Touch& touch : touches) report.others += overlapping(labels, touch).empty() ? 1 : 0;
  return report;
}

TouchLimits learn_touch_limits(std::span<const double> forces, std::span<const Touch> labelled) {
  constexpr std::array kOnsetShares{0.1, 0.2, 0.3, 0.4, 0.5, 0.7};
  constexpr std::array kReleaseShares{0.1, 0.2, 0.3, 0.4};
  constexpr std::array<std::size_t, 6> kGaps{1, 2, 3, 4, 6, 10};
  const double peak = weak_peak(forces, labelled);
  const std::vector<Touch> labels = in_order(labelled);
  TouchLimits best;
  double best_worth = -1.0;
  for (const double onset : kOnsetShares) {
    for (const double release : kReleaseShares) {
      for (const std::size_t gap : kGaps) {
        TouchLimits limits{.onset = onset * peak, .release_share = release, .gap_frames = gap};
        set_margins(limits, labels, find_touches(limits, forces));
        const double worth = worth_of(labels, find_touches(limits, forces));
        if (worth <= best_worth) continue;
        best_worth = worth;
        best = limits;
      }
    }
  }
  return best;
}

}  // namespace dermis::learn::recognition
