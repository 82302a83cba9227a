// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/learn/calibration/guided_calibration.hpp"
#include "dermis/live/sources/guide_voice.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "out/serve/calibration/calibration_message.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/suit/service_arrays.hpp"

namespace dermis::out::serve {

/// The request of a calibration, in the words of a simulated hand.
[[nodiscard]] live::sources::GuideWords words_of(const learn::calibration::GuideState& state, Nanos hold_time);

/// The services /calibration/... of docs/stream.md: one guided calibration at a time. Services are called by one
/// thread, as websocket::Server promises; the rest by any.
class CalibrationServices final : public Part {
 public:
  /// Takes a new model into use for an array that is at work.
  using UseModel = std::function<Status(std::size_t array, std::shared_ptr<const touch::pipeline::Model>)>;

  /// Whether a calibration may begin now; the error says why not.
  using MayBegin = std::function<Status()>;
  /// Is called ten times a second; asks progress() where somebody wants to know.
  using Notify = std::function<void(const CalibrationServices&)>;

  /// `guide_voice`: gets the requests of the calibration, for simulated hands.
  CalibrationServices(ServiceArrays arrays, UseModel use_model, std::shared_ptr<live::sources::GuideVoice> guide_voice,
                      MayBegin may_begin = {}, Notify notify = {});

  /// "/calibration/start", ... Errors: a request that is wrong or comes at the wrong time.
  [[nodiscard]] std::vector<websocket::Service> services() override;
  /// Costs next to nothing while no calibration goes on.
  void hear(const live::suits::ArrayResult& result) override { feed(result.array, result.raw); }
  void tick(std::int64_t tick) override;

  void feed(std::size_t array, const RawFrame& raw);

  /// Empty until a calibration was started.
  [[nodiscard]] std::optional<CalibrationProgress> progress() const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  struct Calibration {
    std::size_t array = kNone;
    std::shared_ptr<learn::calibration::GuidedCalibration> guide{};  ///< Null: it was cancelled.
    Nanos hold_time{};                                               ///< Of its plan.
    std::string saved_file{};
  };

  [[nodiscard]] std::shared_ptr<learn::calibration::GuidedCalibration> guide() const;
  using Step = Status (learn::calibration::GuidedCalibration::*)();

  Result<std::string> start(std::string_view request);
  Result<std::string> take(Step step);
  Result<std::string> save();
  Result<std::string> cancel();
  void replace(Calibration calibration);
  void say_what_to_do() const;

  const ServiceArrays arrays_;
  const UseModel use_model_;
  const std::shared_ptr<live::sources::GuideVoice> guide_voice_;
  const MayBegin may_begin_;
  const Notify notify_;
  std::shared_ptr<void> ending_;  ///< A calibration whose last fit is waited for.
  std::atomic<std::size_t> active_array_{kNone};
  mutable std::mutex mutex_;  ///< Guards the members below; never held for long, because frames wait for it.
  Calibration last_;
};

}  // namespace dermis::out::serve
