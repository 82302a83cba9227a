// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>

#include "dermis/learn/calibration/calibrate.hpp"

namespace dermis::app {

/// The report of a calibration for people.
struct CalibrationText {
  const learn::calibration::Calibration& calibration;
  std::string model_file;
  std::size_t touches = 0;  ///< Whose positions along a strip were learned.

  /// Five lines: what was fitted, how well on loads that it did not see, what is doubted, what to do, where it lies.
  void print_summary() const;
  /// How it came about: labels, circuit, networks, uncertainty, time.
  void print_details() const;
};

}  // namespace dermis::app
