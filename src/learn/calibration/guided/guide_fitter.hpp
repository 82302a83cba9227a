// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>

#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/guided/press_fit.hpp"

namespace dermis::learn::calibration {

/// Fits the presses of a guided calibration on a thread of its own; in a page, in a worker.
class GuideFitter {
 public:
  /// `on_outcome` is called on the thread of the fits; `on_progress` gets the share done of a last job, from any
  /// thread.
  GuideFitter(ArrayDescription array, std::function<void(FitOutcome)> on_outcome,
              std::function<void(double)> on_progress);
  GuideFitter(const GuideFitter&) = delete;
  GuideFitter& operator=(const GuideFitter&) = delete;
  /// Waits for the fit that is going on; in a page, ends it.
  ~GuideFitter();

  /// Fits as soon as the fit that is going on is done; a job that still waits is dropped for it.
  void fit(FitJob job);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::learn::calibration
