// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <poll.h>

#include <atomic>
#include <deque>
#include <thread>
#include <vector>

#include "live/suits/array_worker.hpp"

namespace dermis::live::suits {

/// A thread that works for several arrays. One wake-up serves all frames that have come by then. Acquisition goes
/// before processing. An array whose source cannot be waited for together with others has a thread for itself
/// meanwhile.
class WorkLoop {
 public:
  WorkLoop() = default;
  WorkLoop(const WorkLoop&) = delete;
  WorkLoop& operator=(const WorkLoop&) = delete;
  ~WorkLoop() { stop(); }

  /// Before start(). `worker` must outlive the loop.
  void add(ArrayWorker& worker) { members_.emplace_back(worker); }
  void start();
  /// stop() waits for the threads, each of which ends with its present frames.
  void ask_to_stop() noexcept { stopping_.store(true, std::memory_order_relaxed); }
  void stop();

 private:
  struct Member {
    explicit Member(ArrayWorker& of) : worker(of) {}

    ArrayWorker& worker;
    // Used by the loop's thread alone.
    bool is_here = false;   // the thread works for it now
    bool has_come = false;  // bytes of a frame
    Nanos due{};            // acquired then in any case

    std::atomic<bool> is_alone = false;
    std::thread alone;
  };

  [[nodiscard]] bool is_stopping() const noexcept { return stopping_.load(std::memory_order_relaxed); }
  void run();
  [[nodiscard]] bool has_any() const;
  [[nodiscard]] Nanos collect();
  void wait_until(Nanos due);
  void poll_until(Nanos due);
  void acquire();
  [[nodiscard]] bool process();
  void leave_alone(Member& member);
  void work_alone(Member& member);

  std::deque<Member> members_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;

  // Used by the thread alone.
  std::vector<pollfd> descriptors_;
  std::vector<Member*> described_;  // by descriptor
  Nanos pause_{};                   // between two wake-ups
  Nanos woken_{};
};

}  // namespace dermis::live::suits
