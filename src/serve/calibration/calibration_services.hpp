// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/calibration/guided_calibration.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/sources/guide_voice.hpp"
#include "serve/suit/service_arrays.hpp"

namespace dermis::serve {

/// What there is to tell of the calibration that is going on.
struct CalibrationProgress {
  std::string array;
  calibration::GuideState state;  ///< Stage `none` after a calibration was cancelled.
};

/// What a calibration asks for, as it is said to a simulated hand.
[[nodiscard]] sources::GuideWords words_of(const calibration::GuideState& state, Nanos hold_time);

/// The services /calibration/... of docs/stream.md: one guided calibration at a time. Thread-safe.
class CalibrationServices {
 public:
  /// Takes a new model into use for an array that is at work.
  using UseModel = std::function<Status(std::size_t array, std::shared_ptr<const pipeline::Model>)>;

  /// `guide_voice`: what the calibration asks for is said to it, for simulated hands.
  CalibrationServices(ServiceArrays arrays, UseModel use_model, std::shared_ptr<sources::GuideVoice> guide_voice);

  /// "/calibration/start", ...
  [[nodiscard]] static const std::vector<std::string>& names();

  /// Every frame of every array; costs next to nothing while no calibration goes on.
  void feed(std::size_t array, const RawFrame& raw);

  /// JSON in, JSON out. Errors: an unknown service, a request that is wrong or comes at the wrong time.
  [[nodiscard]] Result<std::string> call(std::string_view service, std::string_view request);

  /// Empty until a calibration was started.
  [[nodiscard]] std::optional<CalibrationProgress> progress() const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  struct Calibration {
    std::size_t array = kNone;
    std::shared_ptr<calibration::GuidedCalibration> guide{};  ///< Null: it was cancelled.
    Nanos hold_time{};                                        ///< Of its plan.
    std::string saved_file{};
  };

  [[nodiscard]] std::shared_ptr<calibration::GuidedCalibration> guide() const;
  Result<std::string> start(std::string_view request);
  Result<std::string> save();
  Result<std::string> cancel();
  void replace(Calibration calibration);
  void say_what_to_do() const;

  const ServiceArrays arrays_;
  const UseModel use_model_;
  const std::shared_ptr<sources::GuideVoice> guide_voice_;
  std::mutex calls_mutex_;    ///< One call at a time.
  std::future<void> ending_;  ///< A calibration whose last fit is waited for.
  std::atomic<std::size_t> active_array_{kNone};
  mutable std::mutex mutex_;  ///< Of what follows; never held for long, because frames wait for it.
  Calibration last_;
};

}  // namespace dermis::serve
