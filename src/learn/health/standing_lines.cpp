// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/standing_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestFrames = 30;
constexpr std::size_t kFewestOfTaxel = 55;
constexpr std::size_t kFromTheBeginning = 10;  // frames: an end that was there as soon
constexpr std::size_t kFewestLines = 3;
constexpr float kStands = 0.005F;       // of a reading: it has not changed
constexpr float kStandsFew = 2.0F;      // counts, the same
constexpr float kNearEnd = 0.01F;       // of full scale
constexpr float kClear = 4.0F;          // counts between an end and what others read,
constexpr float kFarAbove = 8.0F;       // who may be untouched then
constexpr float kFarBelow = 0.5F;       // of full scale, the same
constexpr double kMostReads = 0.5;      // of the frames before a line broke
constexpr std::size_t kMostTaxels = 8;  // one in so many
constexpr double kMostOthers = 0.15;

}  // namespace

StandingLines::StandingLines(const ArrayDescription& array) : array_(array), taxels_(array.taxel_count()) {}

void StandingLines::add(std::span<const float> counts, Nanos time) {
  if (!first_time_) first_time_ = time;
  highest_ = std::max(highest_, *std::max_element(counts.begin(), counts.end()));
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const float reading = counts[k];
    Taxel& taxel = taxels_[k];
    taxel.at_top += reading >= (1.0F - kNearEnd) * highest_ ? 1 : 0;
    if (frames_ == 0) {
      taxel = {.low = reading,
               .high = reading,
               .begin_time = time,
               .least_before = reading,
               .most_before = reading,
               .at_top = taxel.at_top};
      continue;
    }
    const float low = std::min(taxel.low, reading);
    const float high = std::max(taxel.high, reading);
    const bool changes_zero = (reading == 0.0F) != (taxel.high == 0.0F);
    if (!changes_zero && high - low <= std::max(kStandsFew, kStands * high)) {
      taxel.low = low;
      taxel.high = high;
      continue;
    }
    const bool is_first = taxel.begin == 0;
    taxel.least_before = is_first ? taxel.low : std::min(taxel.least_before, taxel.low);
    taxel.most_before = is_first ? taxel.high : std::max(taxel.most_before, taxel.high);
    taxel.last_before = taxel.high;
    taxel.read_before += taxel.high == 0.0F ? 0 : frames_ - taxel.begin;
    taxel.low = taxel.high = reading;
    taxel.begin = frames_;
    taxel.begin_time = time;
  }
  ++frames_;
}

bool StandingLines::stands_at(const End& end, const Taxel& taxel) const {
  return taxel.low >= end.least && taxel.high <= end.most && frames_ - taxel.begin >= kFewestFrames;
}

/// Since the last of its taxels came there.
std::optional<StandingLines::Standing> StandingLines::standing(const End& end, Axis axis, std::size_t line) const {
  Standing standing{.line = line, .low = end.most, .high = end.least};
  bool any = false;
  for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
    const std::size_t index = taxel_on_line(array_, axis, line, place);
    if (array_.is_absent(index)) continue;
    const Taxel& taxel = taxels_[index];
    if (!stands_at(end, taxel)) return std::nullopt;
    any = true;
    standing.low = std::min(standing.low, taxel.low);
    standing.high = std::max(standing.high, taxel.high);
    if (taxel.begin < standing.begin) continue;
    standing.begin = taxel.begin;
    standing.begin_time = taxel.begin_time;
  }
  if (!any) return std::nullopt;
  return standing;
}

/// The taxels of another line keep clear of the end, and one of them has been pressed; or all are far from it. Presses
/// may bring them to full scale.
bool StandingLines::works_beside(const End& end, Axis axis, std::size_t line) const {
  bool is_pressed = false;
  bool is_far = true;
  for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
    const std::size_t index = taxel_on_line(array_, axis, line, place);
    if (array_.is_absent(index)) continue;
    const Taxel& taxel = taxels_[index];
    const float least = taxel.begin == 0 ? taxel.low : std::min(taxel.low, taxel.least_before);
    const float most = taxel.begin == 0 ? taxel.high : std::max(taxel.high, taxel.most_before);
    const bool is_clear = end.most == 0.0F ? least >= kClear : most <= end.least - kClear;
    const bool is_taxel_far = end.most == 0.0F ? least >= kFarAbove : least <= kFarBelow * end.most;
    if (!is_clear && (end.most == 0.0F || !is_taxel_far)) return false;
    is_pressed = is_pressed || most > 2.0F * least;
    is_far = is_far && is_taxel_far;
  }
  return is_pressed || is_far;
}

/// Where a line broke later, it suffices that few others stand at 0, or have often been at full scale.
bool StandingLines::others_move(const End& end, Axis axis, const std::vector<std::size_t>& others) const {
  std::size_t frames = 0;
  for (const std::size_t line : others) {
    for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
      const Taxel& taxel = taxels_[taxel_on_line(array_, axis, line, place)];
      if (end.most > 0.0F) frames += taxel.at_top;
      if (end.most == 0.0F && stands_at(end, taxel)) frames += frames_;
    }
  }
  const std::size_t all = frames_ * others.size() * line_length(array_, axis);
  return static_cast<double>(frames) <= kMostOthers * static_cast<double>(all);
}

/// Before it stood at the end, each taxel of the line has mostly been elsewhere.
bool StandingLines::was_alive(const End& end, const Standing& standing, Axis axis) const {
  for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
    const std::size_t index = taxel_on_line(array_, axis, standing.line, place);
    if (array_.is_absent(index)) continue;
    const Taxel& taxel = taxels_[index];
    if (end.most > 0.0F ? taxel.least_before >= end.least
                        : static_cast<double>(taxel.read_before) < kMostReads * static_cast<double>(taxel.begin)) {
      return false;
    }
  }
  return true;
}

/// All other lines must work, for an untouched line may read so, too.
std::vector<StandingLines::Standing> StandingLines::found(const End& end, Axis axis) const {
  const std::size_t lines = line_count(array_, axis);
  if (lines < kFewestLines || line_length(array_, axis) < 2) return {};
  std::vector<Standing> standing_lines;
  std::vector<std::size_t> others;
  for (std::size_t line = 0; line < lines; ++line) {
    if (const auto stands = standing(end, axis, line)) {
      standing_lines.push_back(*stands);
    } else {
      others.push_back(line);
    }
  }
  if (2 * standing_lines.size() > lines) return {};
  const auto works = [&](std::size_t line) { return works_beside(end, axis, line); };
  const bool all_work = std::all_of(others.begin(), others.end(), works);
  const bool others_break = !others_move(end, axis, others);
  std::erase_if(standing_lines, [&](const Standing& standing) {
    return standing.begin <= kFromTheBeginning ? !all_work : others_break || !was_alive(end, standing, axis);
  });
  return standing_lines;
}

std::string StandingLines::describe(const Standing& standing, Axis axis) const {
  const std::string reads = standing.low == standing.high
                                ? fmt::format("{:.0f}", standing.low)
                                : fmt::format("{:.0f} to {:.0f}", standing.low, standing.high);
  const std::string line = fmt::format("{} {}", to_string(axis), standing.line);
  const std::string frames =
      standing.begin <= kFromTheBeginning
          ? fmt::format("in all {} frames", frames_)
          : fmt::format("from {:.2f} s (frame {}) to the end",
                        std::chrono::duration<double>(standing.begin_time - *first_time_).count(), standing.begin);
  return fmt::format(
      "{0} reads {1} {2}: its wire is broken or shorted, or its pin is another one; "
      "check the wire, the crimp and the resistor of {0}",
      line, reads, frames);
}

std::vector<std::string> StandingLines::lines(std::optional<float> full_scale) const {
  std::vector<std::string> sentences;
  if (frames_ < kFewestFrames) return sentences;
  for (const Axis axis : kAxes) {
    for (const Standing& standing : found({}, axis)) sentences.push_back(describe(standing, axis));
    if (!full_scale) continue;
    const End full{.least = (1.0F - kNearEnd) * *full_scale, .most = *full_scale};
    for (const Standing& standing : found(full, axis)) sentences.push_back(describe(standing, axis));
  }
  return sentences;
}

std::vector<std::string> StandingLines::taxels_at(std::optional<float> full_scale) const {
  std::vector<std::string> sentences;
  if (!full_scale) return sentences;
  const End full{.least = (1.0F - kNearEnd) * *full_scale, .most = *full_scale};
  std::vector<bool> is_named(taxels_.size());
  for (const Axis axis : kAxes) {
    for (const Standing& standing : found(full, axis)) {
      for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
        is_named[taxel_on_line(array_, axis, standing.line, k)] = true;
      }
    }
  }
  for (std::size_t index = 0; index < taxels_.size(); ++index) {
    const Taxel& taxel = taxels_[index];
    const bool jumped = taxel.begin == 0 || taxel.last_before < kFarBelow * full.most;
    if (is_named[index] || array_.is_absent(index) || !jumped) continue;
    if (!stands_at(full, taxel) || frames_ - taxel.begin < kFewestOfTaxel) continue;
    sentences.push_back(fmt::format(
        "taxel {} stands at {:.0f} to the end from frame {} on: it is shorted, or its pin is another one, if nothing "
        "rests on it",
        array_.taxel_name(index), taxel.high, taxel.begin));
  }
  if (sentences.size() * kMostTaxels > taxels_.size()) sentences.clear();  // so many are loaded
  return sentences;
}

}  // namespace dermis::learn::health
