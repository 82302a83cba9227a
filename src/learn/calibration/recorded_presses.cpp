// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/recorded_presses.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "dermis/learn/calibration/parallel.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr Nanos kLeastPause = std::chrono::seconds(1);
constexpr std::size_t kSideBySide = 16;  // calibrations that are kept at a time

enum class Label : std::uint8_t { none, unloaded, loaded };

std::vector<Label> labels_of(std::size_t frames, std::span<const Load> loads) {
  std::vector<Label> labels(frames, Label::none);
  for (const Load& load : loads)
    labels[load.frame] = std::max(labels[load.frame], load.value > 0.0 ? Label::loaded : Label::unloaded);
  return labels;
}

/// The recording without a press.
struct Rest {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;

  Rest(std::span<const RawFrame> all, std::span<const Load> all_loads, const RecordedPress& press) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(press.first);
    frames.assign(all.begin(), first);
    frames.insert(frames.end(), all.begin() + static_cast<std::ptrdiff_t>(press.end), all.end());
    for (Load load : all_loads) {
      if (load.frame >= press.first && load.frame < press.end) continue;
      if (load.frame >= press.end) load.frame -= press.end - press.first;
      loads.push_back(load);
    }
  }
};

}  // namespace

std::vector<RecordedPress> recorded_presses(std::span<const RawFrame> frames, std::span<const Load> loads) {
  const std::vector<Label> labels = labels_of(frames.size(), loads);
  std::vector<RecordedPress> presses;
  RecordedPress piece;
  bool is_press = false;
  const auto end_at = [&](std::size_t frame) {
    piece.end = frame;
    if (is_press) presses.push_back(piece);
    piece.first = frame;
    is_press = false;
  };
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const bool is_pause = k > 0 && frames[k].time - frames[k - 1].time >= kLeastPause;
    if (is_pause || (is_press && labels[k] == Label::unloaded)) end_at(k);
    is_press = is_press || labels[k] == Label::loaded;
  }
  end_at(frames.size());
  return presses;
}

Status judge_each_left_out(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
                           std::span<const RecordedPress> presses, const PressJudge& judge) {
  if (presses.size() < 2) return bad_input("fewer than two presses: none can be left out");
  const std::vector<std::optional<double>> newtons = newtons_of_frames(array, frames.size(), loads);
  for (std::size_t first = 0; first < presses.size(); first += kSideBySide) {
    const auto some = presses.subspan(first, std::min(kSideBySide, presses.size() - first));
    std::vector<std::optional<Result<Calibration>>> calibrations(some.size());
    parallel_for(some.size(), [&](std::size_t k) {
      const Rest rest(frames, loads, some[k]);
      calibrations[k] = calibrate(array, rest.frames, rest.loads);
    });
    for (std::size_t k = 0; k < some.size(); ++k) {
      const Result<Calibration>& without_it = *calibrations[k];
      if (!without_it) return without_it.error();
      const auto [begin, end] = some[k];
      const std::span known = std::span(newtons).subspan(begin, end - begin);
      if (Status judged = judge(some[k], known, *without_it); !judged) return judged;
    }
  }
  return Done{};
}

}  // namespace dermis::learn::calibration
