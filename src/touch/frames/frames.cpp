// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/frames.hpp"

#include <array>
#include <utility>

namespace dermis {

std::string to_string(FrameStatus status) {
  static constexpr std::array<std::pair<FrameStatus, const char*>, 11> kNames{{
      {FrameStatus::rejected, "rejected"},
      {FrameStatus::saturated, "saturated"},
      {FrameStatus::above_range, "above_range"},
      {FrameStatus::dead_taxels, "dead_taxels"},
      {FrameStatus::temperature_unknown, "temperature_unknown"},
      {FrameStatus::temperature_clamped, "temperature_clamped"},
      {FrameStatus::not_converged, "not_converged"},
      {FrameStatus::line_fault, "line_fault"},
      {FrameStatus::supply_clamped, "supply_clamped"},
      {FrameStatus::supply_implausible, "supply_implausible"},
      {FrameStatus::doubtful, "doubtful"},
  }};
  std::string text;
  for (const auto& [flag, name] : kNames) {
    if (!has(status, flag)) continue;
    if (!text.empty()) text += '+';
    text += name;
  }
  return text.empty() ? "ok" : text;
}

}  // namespace dermis
