// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// The options that name what a calibration learns from.
struct CalibrationFiles {
  std::string array;
  std::string frames;
  std::string loads;
  double settle_s = 0.0;

  void add(Command& command);
};

/// An array, its frames, and the loads on it.
struct CalibrationInput {
  ArrayDescription array;
  Nanos settle{};
  std::vector<RawFrame> frames;
  std::vector<Load> loads;

  /// Fails before the frames are read where `out`, if it is named, cannot be written.
  [[nodiscard]] static Result<CalibrationInput> read(const CalibrationFiles& files, const std::string& out);
};

}  // namespace dermis::app
