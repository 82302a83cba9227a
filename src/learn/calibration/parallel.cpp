// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/parallel.hpp"

#include <sched.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace dermis::learn::calibration {
namespace {

/// Threads at work in the loops of this process, without one a loop: its caller's. Loops within loops, and loops side
/// by side, so share the cores.
std::atomic<int> cores_taken = 0;

/// Cores that this thread may run on beyond its own.
int further_cores() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return 0;
  return CPU_COUNT(&allowed) - 1;
}

bool take_core(int most) {
  int taken = cores_taken;
  while (taken < most) {
    if (cores_taken.compare_exchange_weak(taken, taken + 1)) return true;
  }
  return false;
}

class Loop {
 public:
  Loop(std::size_t count, const std::function<void(std::size_t)>& body) : count_(count), body_(body) {}

  /// Is run by the caller's thread. While indices are left, it begins a helper whenever a core is free.
  void run() {
    const int cores = further_cores();
    for (std::size_t k = next_++; k < count_; k = next_++) {
      while (next_ < count_ && take_core(cores) && begin_helper()) {
      }
      call(k);
    }
    leave();
    helpers_.clear();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  /// False: the system has no thread for it, and the others do its work.
  bool begin_helper() {
    ++at_work_;
    try {
      helpers_.emplace_back([this] {
        for (std::size_t k = next_++; k < count_; k = next_++) call(k);
        leave();
      });
      return true;
    } catch (const std::system_error&) {
      leave();
      return false;
    }
  }

  /// Gives the core back. The last one leaves it to the caller.
  void leave() {
    if (--at_work_ > 0) --cores_taken;
  }

  /// After a failure no further index is begun.
  void call(std::size_t k) {
    try {
      body_(k);
    } catch (...) {
      const std::lock_guard lock(failing_);
      if (!failure_) failure_ = std::current_exception();
      next_ = count_;
    }
  }

  std::size_t count_;
  const std::function<void(std::size_t)>& body_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<int> at_work_ = 1;
  std::mutex failing_;
  std::exception_ptr failure_;
  std::vector<std::jthread> helpers_;
};

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  Loop(count, body).run();
}

}  // namespace dermis::learn::calibration
