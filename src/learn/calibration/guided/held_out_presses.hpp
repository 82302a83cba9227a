// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "dermis/learn/calibration/guided_calibration.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::calibration {

/// A press that was kept.
struct GuidedPress {
  std::size_t taxel = 0;
  double newtons = 0.0;
  std::vector<RawFrame> frames;
  std::optional<std::size_t> together_with = {};  // another taxel, with as much
};
using GuidedPresses = std::vector<std::shared_ptr<const GuidedPress>>;

/// The unloaded frames, then those of the presses, with their loads.
[[nodiscard]] GuidedData labelled_frames(const ArrayDescription& array, const std::vector<RawFrame>& unloaded,
                                         const GuidedPresses& presses);

/// Median relative error on presses that a fit without them finds; empty where there are too few. `array` is to be
/// known in full. The taxels have other presses: one press of every second taxel is left out. It is never the heaviest,
/// because forces beyond that are less sure.
[[nodiscard]] std::optional<double> error_on_left_out_presses(const ArrayDescription& array,
                                                              const std::vector<RawFrame>& unloaded,
                                                              const GuidedPresses& presses);

/// The same on taxels without a press: all presses of a quarter of the taxels are left out, four times. Empty where
/// every taxel is pressed. `progress` gets the share done.
[[nodiscard]] std::optional<double> error_on_left_out_taxels(const ArrayDescription& array,
                                                             const std::vector<RawFrame>& unloaded,
                                                             const GuidedPresses& presses,
                                                             const std::function<void(double)>& progress);

}  // namespace dermis::learn::calibration
