// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/pipeline/frame_troubles.hpp"

#include <fmt/core.h>

#include "dermis/preprocessing/conditioner.hpp"

namespace dermis::pipeline {
namespace {

constexpr const char* kMisfit = "do not fit the circuit of the array";

/// Where the source does not tell it, by the number of the frame.
std::string place_of(const std::string& prefix, const FrameSource* source, std::size_t number) {
  const std::string place = source != nullptr ? source->place() : "";
  return place.empty() ? fmt::format("{}frame {}", prefix, number) : place;
}

}  // namespace

FrameTroubles::FrameTroubles(const ArrayDescription& array, const std::string& from)
    : prefix_(from.empty() ? "" : from + ": "), missing_(array) {}

void FrameTroubles::add(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline,
                        const FrameSource* source) {
  ++number_;
  ++frames_;
  const bool is_outside = missing_.add(raw, pipeline.conditioned());
  const bool is_rejected = has(force.status, FrameStatus::rejected);
  const bool is_unsolved = has(force.status, FrameStatus::not_converged);
  if (is_unsolved) ++unsolved_;
  if (is_rejected || is_unsolved) ++lost_;
  if ((is_rejected || is_unsolved) && is_outside) ++lost_outside_;
  if (has(force.status, FrameStatus::line_fault)) ++faulty_;
  if (has(force.status, FrameStatus::supply_clamped | FrameStatus::supply_implausible)) add_supply(raw, pipeline);
  if (!is_rejected) return;
  if (rejected_++ > 0) return;
  first_rejection_ = fmt::format("{}: {}", place_of(prefix_, source, number_), pipeline.why_rejected());
}

void FrameTroubles::add_supply(const RawFrame& raw, const Pipeline& pipeline) {
  if (supply_clamped_++ > 0) return;
  const auto& [least_v, most_v] = pipeline.supply_bounds().trusted();
  first_supply_ = fmt::format("{:.3g} V, where {:.3g} to {:.3g} V are trusted", *raw.supply_v, least_v, most_v);
}

std::string FrameTroubles::cause() const {
  if (2 * lost_outside_ > lost_) return *missing_.describe_range();
  if (rejected_ > unsolved_) return "the first is rejected, " + first_rejection_;
  return fmt::format("their readings {}", kMisfit);
}

std::vector<std::string> FrameTroubles::describe() const {
  std::vector<std::string> lines;
  if (rejected_ > 0) {
    lines.push_back(fmt::format("{} of {} frames rejected, the first: {}", rejected_, frames_, first_rejection_));
  }
  if (missing_.any()) lines.push_back(missing_.describe());
  if (const auto range = missing_.describe_range()) lines.push_back(*range);
  if (unsolved_ > 0) {
    lines.push_back(fmt::format("{} of {} frames without forces: their readings {}", unsolved_, frames_,
                                2 * lost_outside_ > lost_ ? "lie outside of the ADC" : kMisfit));
  }
  if (faulty_ > 0) {
    lines.push_back(
        fmt::format("{} of {} frames with faulty lines or taxels, which are masked: 'dermis doctor' tells which",
                    faulty_, frames_));
  }
  if (supply_clamped_ > 0) {
    lines.push_back(fmt::format("{} of {} frames with a supply outside of the calibration, the first: {}",
                                supply_clamped_, frames_, first_supply_));
  }
  return lines;
}

Status FrameTroubles::verdict() const {
  if (2 * lost_ <= frames_) return Done{};
  return failed(fmt::format("{}{} of {} frames have no force: {}", prefix_, lost_, frames_, cause()));
}

}  // namespace dermis::pipeline
