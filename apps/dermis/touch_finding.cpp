// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch_finding.hpp"

#include <fmt/core.h>

#include <string>

#include "dermis/learn/recognition/learning.hpp"

namespace dermis::app {

void print_finding(const learn::recognition::LabelledFrames& data, const learn::recognition::TouchLimits& limits) {
  constexpr double kSecondsPerMinute = 60.0;
  const learn::recognition::FindingReport finding = learn::recognition::judge_touches(data, limits);
  const double per_frame = static_cast<double>(finding.others) / static_cast<double>(data.frame_count());
  const double rate_hz = data.layout.rate_hz;
  const std::string rate =
      rate_hz > 0.0 ? fmt::format(", {:.2g} a minute", per_frame * rate_hz * kSecondsPerMinute) : std::string();
  fmt::print("in the stream {} of {} touches are found, and {} where no label is{}\n", finding.found, finding.labelled,
             finding.others, rate);
}

}  // namespace dermis::app
