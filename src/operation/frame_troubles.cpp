// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/operation/frame_troubles.hpp"

#include <fmt/core.h>

#include <utility>

#include "dermis/preprocessing/conditioner.hpp"

namespace dermis::operation {
namespace {

/// Where the source does not tell it, by the number of the frame.
std::string place_of(const std::string& from, const FrameSource& source, std::size_t number) {
  const std::string place = source.place();
  return place.empty() ? fmt::format("{}: frame {}", from, number) : place;
}

}  // namespace

FrameTroubles::FrameTroubles(const Operation& operation, std::string from)
    : operation_(operation), from_(std::move(from)), missing_(operation.model.array) {}

void FrameTroubles::add(const ForceFrame& force, std::size_t number) {
  ++frames_;
  missing_.add(operation_.pipeline.conditioned());
  if (has(force.status, FrameStatus::not_converged)) ++unsolved_;
  if (has(force.status, FrameStatus::line_fault)) ++faulty_;
  if (!has(force.status, FrameStatus::rejected)) return;
  if (rejected_++ > 0) return;
  first_rejection_ = fmt::format("{}: {}", place_of(from_, *operation_.frames, number),
                                 preprocessing::to_string(operation_.pipeline.rejection()));
}

std::vector<std::string> FrameTroubles::describe() const {
  std::vector<std::string> lines;
  if (rejected_ > 0) {
    lines.push_back(fmt::format("{} of {} frames rejected, the first: {}", rejected_, frames_, first_rejection_));
  }
  if (missing_.any()) lines.push_back(missing_.describe());
  if (unsolved_ > 0) {
    lines.push_back(fmt::format("{} of {} frames without forces: their readings do not fit the circuit of the array",
                                unsolved_, frames_));
  }
  if (faulty_ > 0) {
    lines.push_back(
        fmt::format("{} of {} frames with faulty lines or taxels, which are masked: 'dermis doctor' tells which",
                    faulty_, frames_));
  }
  return lines;
}

}  // namespace dermis::operation
