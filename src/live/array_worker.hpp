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
#include "live/latency_meter.hpp"

namespace dermis::live {

/// What becomes of the zero of an array.
enum class ZeroRequest { keep, tare, reset };

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
  /// What other threads ask for; the worker takes it between two frames.
  struct Requests {
    std::optional<LiveSettings> settings;
    ZeroRequest zero = ZeroRequest::keep;
    std::unique_ptr<pipeline::Pipeline> pipeline;
  };

  ArrayWorker(std::size_t index, LiveArray array, std::unique_ptr<pipeline::Pipeline> pipeline,
              const LiveOptions& options);
  template <typename Change>
  void request(const Change& change);
  void run();
  [[nodiscard]] Result<bool> step();
  void take_requests();
  [[nodiscard]] bool was_sought_back() const noexcept;
  void begin_anew();
  void place_contacts();
  void meter(Nanos now);
  void publish(Nanos now);
  void finish(const Status& outcome);

  const std::size_t index_;
  LiveArray array_;
  const LiveOptions& options_;
  std::thread thread_;
  std::atomic<bool> stopping_ = false;
  std::atomic<bool> ended_ = false;

  std::mutex requests_mutex_;
  Requests requests_;
  std::atomic<bool> has_requests_ = false;

  // Of the worker's thread alone.
  std::unique_ptr<pipeline::Pipeline> pipeline_;
  LiveSettings settings_;
  fusion::ContactTracker tracker_;
  Nanos last_time_{};
  RawFrame raw_;
  ForceFrame force_;
  ContactReport report_;
  std::vector<SuitContact> contacts_;
  LatencyMeter latencies_;
  std::uint64_t frames_ = 0;
  std::uint64_t rejected_ = 0;

  mutable std::mutex published_mutex_;
  ArrayStatistics published_;
  Nanos published_at_{};  // by the steady clock
};

}  // namespace dermis::live
