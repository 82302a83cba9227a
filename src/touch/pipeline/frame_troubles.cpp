// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/frame_troubles.hpp"

#include <algorithm>

#include "dermis/touch/frames/number_text.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"
#include "dermis/touch/preprocessing/temperature_unit.hpp"

namespace dermis::touch::pipeline {
namespace {

constexpr const char* kMisfit = "do not fit the circuit of the array";
constexpr const char* kPowered = "is the array connected and powered?";

/// By the number of the frame where the source has no place.
std::string place_of(const std::string& prefix, const FrameSource* source, std::size_t number) {
  const std::string place = source != nullptr ? source->place() : "";
  return place.empty() ? prefix + "frame " + std::to_string(number) : place;
}

/// "3 of 4 frames".
std::string share_of(std::size_t some, std::size_t all) {
  return std::to_string(some) + " of " + std::to_string(all) + " frames";
}

}  // namespace

FrameTroubles::FrameTroubles(const ArrayDescription& array, const std::string& from)
    : prefix_(from.empty() ? "" : from + ": "),
      missing_(array),
      zero_(array.readout.quantity == Quantity::counts ? std::optional<std::size_t>(0) : std::nullopt),
      rows_(array.rows),
      sensors_(array.temperature_sensors.size()) {}

void FrameTroubles::add(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline,
                        const FrameSource* source) {
  ++number_;
  ++frames_;
  const bool is_outside = missing_.add(raw, pipeline.conditioned());
  const bool is_rejected = has(force.status, FrameStatus::rejected);
  const bool is_unsolved = has(force.status, FrameStatus::not_converged);
  if (is_unsolved && unsolved_.frames++ == 0) unsolved_.first = place_of(prefix_, source, number_);
  const bool is_zero = std::ranges::all_of(raw.counts, [](float count) { return count == 0.0F; });
  if (is_zero && zero_) ++*zero_;
  if (is_rejected || is_unsolved) {
    ++lost_.frames;
    lost_.outside += is_outside ? 1 : 0;
    lost_.zero += is_zero ? 1 : 0;
  }
  if (has(force.status, FrameStatus::line_fault)) ++faulty_;
  add_doubts(raw, force, pipeline);
  if (!is_rejected) return;
  if (rejected_.frames++ > 0) return;
  rejected_.first = place_of(prefix_, source, number_) + ": " + pipeline.why_rejected();
}

void FrameTroubles::add_doubts(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline) {
  const bool is_supply_doubted = has(force.status, FrameStatus::supply_clamped | FrameStatus::supply_implausible);
  if (is_supply_doubted && supply_.frames++ == 0) {
    const auto& [least_v, most_v] = pipeline.supply_bounds().trusted();
    supply_.first = "with a supply outside of the calibration, the first: " + significant_digits(*raw.supply_v, 3) +
                    " V, where " + significant_digits(least_v, 3) + " to " + significant_digits(most_v, 3) +
                    " V are trusted";
  }
  const std::optional<double> kelvin = preprocessing::kelvin_in(raw);
  if (has(force.status, FrameStatus::temperature_clamped) && kelvin && kelvin_.frames++ == 0) {
    kelvin_.first = "with a temperature that no sheet has, the first: " + tenths(*kelvin) +
                    " C: it looks like kelvin, give degrees Celsius";
  }
  if (raw.sensor_celsius.size() != sensors_ && other_sensors_.frames++ == 0) {
    other_sensors_.first = "with temperatures of " + std::to_string(raw.sensor_celsius.size()) +
                           " sensors, where array.temperature_sensors has " + std::to_string(sensors_) + " places";
  }
  if (is_silent(raw, force, pipeline) && silent_.frames++ == 0) {
    silent_.first = std::string("with all readings 0, where untouched taxels read more: ") + kPowered;
  }
}

bool FrameTroubles::is_silent(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline) const {
  if (has(force.status, FrameStatus::rejected | FrameStatus::saturated)) return false;
  if (std::ranges::any_of(raw.counts, [](float count) { return count != 0.0F; })) return false;
  std::size_t reading = 0;
  for (std::size_t row = 0; row < rows_; ++row) reading += pipeline.line_faults().sees_silent_row(row) ? 1 : 0;
  return 2 * reading > rows_;
}

std::optional<std::string> FrameTroubles::silent_frames() const {
  if (silent_.frames == 0) return std::nullopt;
  return describe(silent_);
}

std::optional<std::string> FrameTroubles::silence() const {
  if (!zero_ || *zero_ < frames_ || frames_ == 0 || silent_.frames > 0) return std::nullopt;
  return "all readings of all " + std::to_string(frames_) +
         " frames are 0: nothing touches the array, or it is not connected";
}

std::optional<std::string> FrameTroubles::impossible() const {
  for (const Trouble* trouble : {&kelvin_, &silent_}) {
    if (2 * trouble->frames > frames_) return describe(*trouble);
  }
  return std::nullopt;
}

std::string FrameTroubles::cause() const {
  if (2 * lost_.zero > lost_.frames) return std::string("all readings are 0: ") + kPowered;
  if (2 * lost_.outside > lost_.frames) return *missing_.describe_range();
  if (rejected_.frames > unsolved_.frames) return "the first is rejected, " + rejected_.first;
  return std::string("their readings ") + kMisfit + ", the first at " + unsolved_.first;
}

std::vector<std::string> FrameTroubles::describe() const {
  std::vector<std::string> lines;
  if (rejected_.frames > 0) {
    lines.push_back(share_of(rejected_.frames, frames_) + " rejected, the first: " + rejected_.first);
  }
  if (missing_.any()) lines.push_back(missing_.describe());
  if (const auto range = missing_.describe_range()) lines.push_back(*range);
  if (unsolved_.frames > 0) {
    lines.push_back(share_of(unsolved_.frames, frames_) + " without forces: their readings " +
                    (2 * lost_.outside > lost_.frames ? "lie outside of the ADC" : kMisfit) + ", the first at " +
                    unsolved_.first);
  }
  if (faulty_ > 0) {
    lines.push_back(share_of(faulty_, frames_) +
                    " with faulty lines or taxels, which are masked: a diagnosis tells which");
  }
  for (const Trouble* trouble : {&supply_, &kelvin_, &other_sensors_, &silent_}) {
    if (trouble->frames > 0) lines.push_back(describe(*trouble));
  }
  if (const auto line = silence()) lines.push_back(*line);
  return lines;
}

std::string FrameTroubles::describe(const Trouble& trouble) const {
  return share_of(trouble.frames, frames_) + " " + trouble.first;
}

Status FrameTroubles::verdict() const {
  if (const auto why = impossible()) return failed(prefix_ + *why);
  if (2 * lost_.frames <= frames_) return Done{};
  return failed(prefix_ + share_of(lost_.frames, frames_) + " have no force: " + cause());
}

}  // namespace dermis::touch::pipeline
