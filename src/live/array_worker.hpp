// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/live_suit.hpp"
#include "dermis/pipeline/pipeline.hpp"
#include "dermis/pipeline/standing_load.hpp"
#include "live/latency_meter.hpp"

namespace dermis::live {

/// The next step for the zero of an array.
enum class ZeroRequest { keep, tare, tare_over_load, undo, reset };

/// One array at work on a thread of its own. Thread-safe.
class ArrayWorker {
 public:
  /// `options` must outlive the worker.
  [[nodiscard]] static Result<std::unique_ptr<ArrayWorker>> create(std::size_t index, LiveArray array,
                                                                   const LiveOptions& options);

  void start();
  void ask_to_stop() noexcept { stopping_.store(true, std::memory_order_relaxed); }
  void join();
  [[nodiscard]] bool ended() const noexcept { return ended_.load(std::memory_order_acquire); }

  void set_settings(const LiveSettings& settings);
  void set_zero(ZeroRequest request);
  [[nodiscard]] Status set_model(const pipeline::Model& model);
  [[nodiscard]] ArrayStatistics statistics() const;

 private:
  /// Requests of other threads.
  struct Changes {
    std::optional<LiveSettings> settings;
    ZeroRequest zero = ZeroRequest::keep;
    std::unique_ptr<pipeline::Pipeline> pipeline;
    std::optional<pipeline::StandingLoadWatch> standing;  // with the pipeline
  };

  /// The worker takes the changes between two frames.
  struct Requests {
    std::mutex mutex;
    Changes changes;
    std::atomic<bool> is_any = false;
  };

  /// The frame at hand, from its readings to its contacts.
  struct Frame {
    RawFrame raw;
    ForceFrame force;
    ContactReport report;
    std::vector<SuitContact> contacts;
  };

  struct Counts {
    LatencyMeter latencies;
    std::uint64_t frames = 0;
    std::uint64_t rejected = 0;
  };

  /// The load that rests on the array.
  struct Standing {
    pipeline::StandingLoadWatch watch;
    bool since_first = true;  // frame
  };

  /// State that other threads see.
  struct Published {
    mutable std::mutex mutex;
    ArrayStatistics statistics;
    Nanos at{};  // by the steady clock
  };

  ArrayWorker(std::size_t index, LiveArray array, std::unique_ptr<pipeline::Pipeline> pipeline,
              const LiveOptions& options);
  template <typename Change>
  void request(const Change& change);
  void run();
  [[nodiscard]] Result<bool> step();
  void take_requests();
  void set_zero_now(ZeroRequest zero);
  [[nodiscard]] bool was_sought_back() const noexcept;
  void begin_anew();
  void place_contacts();
  void follow_standing();
  [[nodiscard]] std::optional<pipeline::StandingLoad> standing_load() const;
  void meter(Nanos now);
  void publish(Nanos now);
  void finish(const Status& outcome);

  const std::size_t index_;
  LiveArray array_;
  const LiveOptions& options_;
  std::thread thread_;
  std::atomic<bool> stopping_ = false;
  std::atomic<bool> ended_ = false;

  Requests requests_;

  // Used by the worker's thread alone.
  std::unique_ptr<pipeline::Pipeline> pipeline_;
  LiveSettings settings_;
  contacts::ContactTracker tracker_;
  Nanos last_time_{};
  Frame frame_;
  Counts counts_;
  Standing standing_;

  Published published_;
};

}  // namespace dermis::live
