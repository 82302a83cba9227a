// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::calibration {

/// The frames of a press, with those before it in which nothing presses: [first, end).
struct RecordedPress {
  std::size_t first = 0;
  std::size_t end = 0;

  bool operator==(const RecordedPress&) const = default;
};

/// The presses of a recording, by rising frame. One ends where frames are labelled unloaded again, or where no frame
/// came for a second and more. A piece without a load is no press.
[[nodiscard]] std::vector<RecordedPress> recorded_presses(std::span<const RawFrame> frames,
                                                          std::span<const Load> loads);

/// Judges a press by a calibration without it. `newtons`: the load on the array in each frame of the press; empty where
/// no label names one.
using PressJudge = std::function<Status(const RecordedPress& press, std::span<const std::optional<double>> newtons,
                                        const Calibration& without_it)>;

/// Calls `judge` with each press and a calibration without it, by rising frame. A few calibrations run side by side, so
/// that memory does not grow with the presses. Errors: those of calibrate() and `judge`; no two presses.
[[nodiscard]] Status judge_each_left_out(const ArrayDescription& array, std::span<const RawFrame> frames,
                                         std::span<const Load> loads, std::span<const RecordedPress> presses,
                                         const PressJudge& judge);

}  // namespace dermis::learn::calibration
