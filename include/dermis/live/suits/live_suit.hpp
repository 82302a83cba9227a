// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/bodies/surface.hpp"
#include "dermis/touch/compensation/line_faults.hpp"
#include "dermis/touch/compensation/offset_drift.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/standing_load.hpp"
#include "dermis/touch/pipeline/tare.hpp"

/// A suit at work: arrays share threads, one clock, one stream of results.
namespace dermis::live::suits {

/// One array of the suit, ready to work.
struct LiveArray {
  std::string name;
  std::unique_ptr<FrameSource> source;
  std::shared_ptr<const touch::pipeline::Model> model;
  ArraySurface surface;
};

/// All that was made of one frame of one array. Valid during the call.
struct ArrayResult {
  std::size_t array = 0;
  const RawFrame& raw;
  const ConductanceFrame& conductance;
  const ForceFrame& force;
  const ContactReport& report;
  std::span<const SuitContact> contacts;
  Nanos latency{};  ///< From the arrival of the last byte to now; 0 where the source does not know when that was.
  std::uint64_t tares = 0;  ///< So many were begun.
};

/// How an array is doing.
struct ArrayStatistics {
  SourceStatistics source;
  std::uint64_t frames = 0;    ///< Through the pipeline.
  std::uint64_t rejected = 0;  ///< Of them.
  std::uint64_t skipped = 0;   ///< Acquired, but left out by the pipeline: the machine did not follow.
  Nanos latency_p50{};         ///< From the arrival of the last byte to the contacts, over the last seconds;
  Nanos latency_p99{};         ///< 0 where the source does not know when its frames came.
  bool ended = false;          ///< The source has no more, or failed:
  std::string error;           ///< why; empty where it just ended.
  std::vector<touch::compensation::LineFault> faults;
  touch::pipeline::Tare tare;  ///< The last one.
  /// Has stood there since the first frame, or for a minute.
  std::optional<touch::pipeline::StandingLoad> standing;
  std::optional<double> temperature_celsius;  ///< Of the last frame,
  std::optional<double> supply_v;             ///< as measured.
};

/// How all arrays of a suit work; may be changed meanwhile.
struct LiveSettings {
  touch::contacts::ContactOptions contacts{};
  touch::compensation::OffsetDriftOptions drift{.track = true};

  /// Names the first field that is out of its range, as "contacts.onset_sigma: ...".
  [[nodiscard]] Status validate() const { return contacts.validate(); }
};

struct LiveOptions {
  LiveSettings settings{};
  /// Called for every frame of every array when it has come, before it is processed: for recordings. It may be called
  /// for several arrays at once, for each by one thread at a time. It must be quick and thread-safe, and must not call
  /// the suit.
  std::function<void(std::size_t array, const RawFrame&)> on_frame{};
  /// The same for the results of every frame that was processed.
  std::function<void(const ArrayResult&)> on_result{};
  std::function<void(const std::string&)> notice{};  ///< One line for the log; on the thread of an array.
};

/// Runs all arrays until their sources end or stop() is called. A source that fails ends only its array. Settings take
/// effect with an array's next frame. Where the machine does not follow, all frames are acquired, and old ones are not
/// processed. Thread-safe.
class LiveSuit {
 public:
  /// Fails, as "array 'chest': ...", if a model cannot work or does not fit its source or its surface.
  [[nodiscard]] static Result<std::unique_ptr<LiveSuit>> create(std::vector<LiveArray> arrays, LiveOptions options);
  LiveSuit(const LiveSuit&) = delete;
  LiveSuit& operator=(const LiveSuit&) = delete;
  /// Does the same as stop().
  ~LiveSuit();

  /// Once.
  void start();
  /// In the place of start(), where there is one thread. Takes the frames that have come, finds the contacts in all of
  /// them, and does not wait. Of a source without readiness(), it takes some at a time; its poll() must not wait.
  void work();
  /// Waits for the threads. Each ends with its present or next frame. So stop a source that may wait long first
  /// (DeviceOptions::stop).
  void stop();
  /// True if no array works any more.
  [[nodiscard]] bool ended() const noexcept;

  /// `settings` must be valid.
  void set_settings(const LiveSettings& settings);
  [[nodiscard]] LiveSettings settings() const;
  /// For one array or all: takes their state from now on as zero (touch::pipeline::Pipeline::tare).
  void tare(std::optional<std::size_t> array = {}, touch::pipeline::TareOver over = touch::pipeline::TareOver::drift);
  /// Back to the zero before the last tare.
  void undo_tare(std::optional<std::size_t> array = {});
  /// Back to the zero of the calibration.
  void reset_tare(std::optional<std::size_t> array = {});
  /// The zero of an array as it was earlier, by the same model [taxels] [S].
  void use_zero(std::size_t array, std::vector<double> offsets);
  /// Another model for an array that is at work, of the same size and pitch: after a calibration. Contacts keep their
  /// ids, faults and tare begin anew.
  [[nodiscard]] Status set_model(std::size_t array, const std::shared_ptr<const touch::pipeline::Model>& model);

  [[nodiscard]] ArrayStatistics statistics(std::size_t array) const;
  /// The offsets when the last tare began or ended [taxels] [S]; empty: there was none.
  [[nodiscard]] std::vector<double> zero(std::size_t array) const;

 private:
  class Implementation;
  explicit LiveSuit(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::live::suits
