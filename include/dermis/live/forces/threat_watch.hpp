// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "dermis/live/forces/operation.hpp"
#include "dermis/live/threats/threat_limits.hpp"
#include "dermis/live/threats/threat_monitor.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/frame_troubles.hpp"

namespace dermis::live::forces {

/// A threat that has begun or ended.
struct ThreatEvent {
  const threats::ThreatLimit& limit;
  const threats::ThreatState& state;
  Nanos time;        ///< Of the frame.
  Nanos first_time;  ///< Time of the first frame of the source.

  [[nodiscard]] bool begins() const noexcept { return state.phase == threats::ThreatPhase::standing; }
};

/// Compares the forces of a source with limits on a thread of its own. So it notices silence and the end of the program
/// while no frame comes. Not a safety function.
class ThreatWatch {
 public:
  /// Told of the threats that begin or end with one frame, on the thread of the watch; valid during the call. A failure
  /// ends the watch.
  using Log = std::function<Status(const std::vector<ThreatEvent>&)>;

  /// Begins. `monitor` was made of `limits` and the array of the operation. `stop`: what the source was opened with; it
  /// ends the watch, and the end of the watch sets it. All but the monitor must outlive the watch.
  ThreatWatch(Operation& operation, threats::ThreatMonitor monitor, const threats::ThreatLimits& limits,
              std::atomic<bool>& stop, Log log);
  ThreatWatch(const ThreatWatch&) = delete;
  ThreatWatch& operator=(const ThreatWatch&) = delete;
  ~ThreatWatch();

  struct News {
    bool has_begun = false;   ///< A frame with forces has come.
    bool is_over = false;     ///< The source has ended, failed or, where it is live, shown a threat.
    bool any_threat = false;  ///< One has begun.
    std::chrono::steady_clock::time_point last_frame{};  ///< When the last one with forces came.
    Status source = Done{};                              ///< The failure, or that most frames had no force.
  };

  /// Waits until it is over, or for `time`. A threat is reported here before it is logged. Thread-safe.
  [[nodiscard]] News wait(std::chrono::milliseconds time);

 private:
  void run() noexcept;
  [[nodiscard]] Status watch();
  [[nodiscard]] bool process();
  [[nodiscard]] bool begins() const;
  [[nodiscard]] bool is_over();
  [[nodiscard]] Status log();

  Operation& operation_;
  threats::ThreatMonitor monitor_;
  const threats::ThreatLimits& limits_;
  std::atomic<bool>& stop_;
  Log log_;
  touch::contacts::ContactTracker contacts_;
  touch::pipeline::FrameTroubles troubles_;
  RawFrame raw_;
  ForceFrame force_;
  ContactReport report_;
  std::optional<Nanos> first_time_;
  std::mutex mutex_;
  std::condition_variable over_;
  News news_;
  std::thread thread_;  ///< The last: it uses all others.
};

}  // namespace dermis::live::forces
