// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/pipeline/frame_troubles.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "dermis/preprocessing/conditioner.hpp"

namespace dermis::pipeline {
namespace {

constexpr const char* kMisfit = "do not fit the circuit of the array";
constexpr double kHottestCelsius = 200.0;  // of a sheet; -73 C, where it is in kelvin

/// Where the source does not tell it, by the number of the frame.
std::string place_of(const std::string& prefix, const FrameSource* source, std::size_t number) {
  const std::string place = source != nullptr ? source->place() : "";
  return place.empty() ? fmt::format("{}frame {}", prefix, number) : place;
}

}  // namespace

FrameTroubles::FrameTroubles(const ArrayDescription& array, const std::string& from)
    : prefix_(from.empty() ? "" : from + ": "), missing_(array), rows_(array.rows) {}

void FrameTroubles::add(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline,
                        const FrameSource* source) {
  ++number_;
  ++frames_;
  const bool is_outside = missing_.add(raw, pipeline.conditioned());
  const bool is_rejected = has(force.status, FrameStatus::rejected);
  const bool is_unsolved = has(force.status, FrameStatus::not_converged);
  if (is_unsolved && unsolved_++ == 0) first_unsolved_ = place_of(prefix_, source, number_);
  if (is_rejected || is_unsolved) ++lost_;
  if ((is_rejected || is_unsolved) && is_outside) ++lost_outside_;
  if (has(force.status, FrameStatus::line_fault)) ++faulty_;
  add_doubts(raw, force, pipeline);
  if (!is_rejected) return;
  if (rejected_++ > 0) return;
  first_rejection_ = fmt::format("{}: {}", place_of(prefix_, source, number_), pipeline.why_rejected());
}

void FrameTroubles::add_doubts(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline) {
  const bool is_supply_doubted = has(force.status, FrameStatus::supply_clamped | FrameStatus::supply_implausible);
  if (is_supply_doubted && supply_.frames++ == 0) {
    const auto& [least_v, most_v] = pipeline.supply_bounds().trusted();
    supply_.what = fmt::format(
        "with a supply outside of the calibration, the first: {:.3g} V, where {:.3g} to {:.3g} V are trusted",
        *raw.supply_v, least_v, most_v);
  }
  const bool is_clamped = has(force.status, FrameStatus::temperature_clamped);
  if (is_clamped && *raw.temperature_celsius > kHottestCelsius && kelvin_.frames++ == 0) {
    kelvin_.what = fmt::format(
        "with a temperature that no sheet has, the first: {:.1f} C: it looks like kelvin, give degrees Celsius",
        *raw.temperature_celsius);
  }
  if (is_silent(raw, force, pipeline) && silent_.frames++ == 0) {
    silent_.what = "with all readings 0, where untouched taxels read more: is the array connected and powered?";
  }
}

/// Whether nothing reads anything, of an array most of whose rows read something where nothing presses.
bool FrameTroubles::is_silent(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline) const {
  if (has(force.status, FrameStatus::rejected | FrameStatus::saturated)) return false;
  if (std::any_of(raw.counts.begin(), raw.counts.end(), [](float count) { return count != 0.0F; })) return false;
  std::size_t reading = 0;
  for (std::size_t row = 0; row < rows_; ++row) reading += pipeline.line_faults().sees_silent_row(row) ? 1 : 0;
  return 2 * reading > rows_;
}

std::string FrameTroubles::cause() const {
  if (2 * lost_outside_ > lost_) return *missing_.describe_range();
  if (rejected_ > unsolved_) return "the first is rejected, " + first_rejection_;
  return fmt::format("their readings {}, the first at {}", kMisfit, first_unsolved_);
}

std::vector<std::string> FrameTroubles::describe() const {
  std::vector<std::string> lines;
  if (rejected_ > 0) {
    lines.push_back(fmt::format("{} of {} frames rejected, the first: {}", rejected_, frames_, first_rejection_));
  }
  if (missing_.any()) lines.push_back(missing_.describe());
  if (const auto range = missing_.describe_range()) lines.push_back(*range);
  if (unsolved_ > 0) {
    lines.push_back(fmt::format("{} of {} frames without forces: their readings {}, the first at {}", unsolved_,
                                frames_, 2 * lost_outside_ > lost_ ? "lie outside of the ADC" : kMisfit,
                                first_unsolved_));
  }
  if (faulty_ > 0) {
    lines.push_back(
        fmt::format("{} of {} frames with faulty lines or taxels, which are masked: 'dermis doctor' tells which",
                    faulty_, frames_));
  }
  for (const Doubt* doubt : {&supply_, &kelvin_, &silent_}) {
    if (doubt->frames > 0) lines.push_back(describe(*doubt));
  }
  return lines;
}

std::string FrameTroubles::describe(const Doubt& doubt) const {
  return fmt::format("{} of {} frames {}", doubt.frames, frames_, doubt.what);
}

Status FrameTroubles::verdict() const {
  for (const Doubt* doubt : {&kelvin_, &silent_}) {
    if (2 * doubt->frames > frames_) return failed(prefix_ + describe(*doubt));
  }
  if (2 * lost_ <= frames_) return Done{};
  return failed(fmt::format("{}{} of {} frames have no force: {}", prefix_, lost_, frames_, cause()));
}

}  // namespace dermis::pipeline
