// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/guide_fitter.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace dermis::learn::calibration {

class GuideFitter::Implementation {
 public:
  Implementation(ArrayDescription array, std::function<void(FitOutcome)> on_outcome,
                 std::function<void(double)> on_progress)
      : array_(std::move(array)),
        on_outcome_(std::move(on_outcome)),
        on_progress_(std::move(on_progress)),
        thread_([this] { work(); }) {}
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation();

  void fit(FitJob job);

 private:
  void work();

  const ArrayDescription array_;
  const std::function<void(FitOutcome)> on_outcome_;
  const std::function<void(double)> on_progress_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<FitJob> waiting_;
  bool is_ending_ = false;
  std::thread thread_;
};

GuideFitter::Implementation::~Implementation() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void GuideFitter::Implementation::fit(FitJob job) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(job);
  }
  wake_.notify_one();
}

void GuideFitter::Implementation::work() {
  for (;;) {
    FitJob job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return is_ending_ || waiting_; });
      if (is_ending_) return;
      job = *std::exchange(waiting_, std::nullopt);
    }
    on_outcome_(fit_presses(array_, job, on_progress_));
  }
}

GuideFitter::GuideFitter(ArrayDescription array, std::function<void(FitOutcome)> on_outcome,
                         std::function<void(double)> on_progress)
    : implementation_(
          std::make_unique<Implementation>(std::move(array), std::move(on_outcome), std::move(on_progress))) {}

GuideFitter::~GuideFitter() = default;

void GuideFitter::fit(FitJob job) {
  implementation_->fit(std::move(job));
}

}  // namespace dermis::learn::calibration
