// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "learn/calibration/guided/held_out_presses.hpp"

namespace dermis::learn::calibration {

/// Fits the presses of a guided calibration on a thread of its own.
class GuideFitter {
 public:
  struct Job {
    std::shared_ptr<const std::vector<RawFrame>> unloaded;
    GuidedPresses presses;
    bool is_last = false;  ///< The model is wanted, too.
  };
  struct Outcome {
    std::optional<double> error;                     ///< On presses that were left out.
    std::optional<double> unpressed_error;           ///< On taxels that were left out; of a last job.
    std::optional<Result<Calibration>> calibration;  ///< Of a last job.
  };

  /// `on_outcome` is called on the thread of the fits; `on_progress` gets the share done of a last job, from any
  /// thread.
  GuideFitter(ArrayDescription array, std::function<void(Outcome)> on_outcome, std::function<void(double)> on_progress);
  GuideFitter(const GuideFitter&) = delete;
  GuideFitter& operator=(const GuideFitter&) = delete;
  /// Waits for the fit that is going on.
  ~GuideFitter();

  /// Fits as soon as the fit that is going on is done; a job that still waits is dropped for it.
  void fit(Job job);

 private:
  void work();
  [[nodiscard]] Outcome run(const Job& job) const;
  [[nodiscard]] Outcome run_last(const Job& job) const;

  ArrayDescription array_;
  std::function<void(Outcome)> on_outcome_;
  std::function<void(double)> on_progress_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Job> waiting_;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace dermis::learn::calibration
