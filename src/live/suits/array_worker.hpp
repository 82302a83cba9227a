// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/suits/live_suit.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "dermis/touch/pipeline/standing_load.hpp"
#include "live/suits/latency_meter.hpp"
#include "live/suits/waiting_frames.hpp"

namespace dermis::live::suits {

/// The next step for the zero of an array.
enum class ZeroRequest { keep, tare, tare_over_load, undo, reset };

/// One array at work. acquire(), await() and process() are called by one thread at a time, the rest by any.
class ArrayWorker {
 public:
  /// `options` must outlive the worker.
  [[nodiscard]] static Result<std::unique_ptr<ArrayWorker>> create(std::size_t index, LiveArray array,
                                                                   const LiveOptions& options);

  [[nodiscard]] std::size_t taxel_count() const noexcept { return array_.model->array.taxel_count(); }
  /// That of the source; empty where await() must wait.
  [[nodiscard]] std::optional<Readiness> readiness() const { return array_.source->readiness(); }
  /// Takes the frames that have come, without waiting.
  void acquire();
  /// The same of one frame. Returns whether one has come.
  bool acquire_one();
  /// Takes the next frame, and waits for it.
  void await();
  /// Finds the contacts of the oldest frame that waits, if one does. Returns whether more wait.
  bool process();
  /// The frames that still wait are left out.
  void stop();
  [[nodiscard]] bool ended() const noexcept { return ended_.load(std::memory_order_acquire); }

  void set_settings(const LiveSettings& settings);
  void set_zero(ZeroRequest request);
  void use_zero(std::vector<double> offsets);
  [[nodiscard]] Status set_model(const touch::pipeline::Model& model);
  [[nodiscard]] ArrayStatistics statistics() const;
  [[nodiscard]] std::vector<double> zero() const;

 private:
  /// Requests of other threads.
  struct Changes {
    std::optional<LiveSettings> settings;
    ZeroRequest zero = ZeroRequest::keep;
    std::vector<double> offsets;  // empty: as they are
    std::unique_ptr<touch::pipeline::Pipeline> pipeline;
    std::optional<touch::pipeline::StandingLoadWatch> standing;  // with the pipeline
  };

  /// The worker takes the changes between two frames.
  struct Requests {
    std::mutex mutex;
    Changes changes;
    std::atomic<bool> is_any = false;
  };

  /// Results of the frame at hand.
  struct Results {
    ForceFrame force;
    ContactReport report;
    std::vector<SuitContact> contacts;
    std::optional<double> temperature_celsius;
    std::optional<double> supply_v;
  };

  struct Counts {
    LatencyMeter latencies;
    std::uint64_t frames = 0;
    std::uint64_t rejected = 0;
    std::uint64_t skipped = 0;
  };

  /// The load that rests on the array.
  struct Standing {
    touch::pipeline::StandingLoadWatch watch;
    bool since_first = true;  // frame
  };

  /// State that other threads see.
  struct Published {
    mutable std::mutex mutex;
    ArrayStatistics statistics;
    std::vector<double> zero;  // when the tare in the statistics changed
    Nanos at{};                // by the steady clock
  };

  ArrayWorker(std::size_t index, LiveArray array, std::unique_ptr<touch::pipeline::Pipeline> pipeline,
              const LiveOptions& options);
  template <typename Change>
  void request(const Change& change);
  void take(const RawFrame& frame);
  void end(Status outcome);
  void find_contacts(const RawFrame& frame);
  void take_requests();
  void set_zero_now(ZeroRequest zero);
  [[nodiscard]] bool was_sought_back(const RawFrame& frame) const noexcept;
  void begin_anew(const RawFrame& frame);
  void place_contacts();
  void follow_standing();
  [[nodiscard]] std::optional<touch::pipeline::StandingLoad> standing_load() const;
  void meter(const RawFrame& frame, Nanos now);
  void publish(Nanos now);
  void finish();

  const std::size_t index_;
  LiveArray array_;
  const LiveOptions& options_;
  std::atomic<bool> ended_ = false;

  Requests requests_;

  // Used by the thread alone that works for the array.
  WaitingFrames waiting_;
  std::optional<Status> outcome_;  // of a source that has no more
  std::unique_ptr<touch::pipeline::Pipeline> pipeline_;
  LiveSettings settings_;
  touch::contacts::ContactTracker tracker_;
  Nanos last_time_{};
  Results results_;
  Counts counts_;
  Standing standing_;

  Published published_;
};

}  // namespace dermis::live::suits
