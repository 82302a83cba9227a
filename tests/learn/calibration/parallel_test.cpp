// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/parallel.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "support/one_core.hpp"

namespace dermis::learn::calibration {
namespace {

TEST(ParallelFor, calls_every_index_once) {
  std::vector<int> calls(10'000, 0);
  parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
  EXPECT_EQ(calls, std::vector<int>(10'000, 1));
}

TEST(ParallelFor, does_nothing_for_no_index) {
  parallel_for(0, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, nests) {
  std::vector<std::vector<int>> calls(20, std::vector<int>(20, 0));
  parallel_for(20, [&](std::size_t i) { parallel_for(20, [&](std::size_t j) { ++calls[i][j]; }); });
  EXPECT_EQ(calls, (std::vector<std::vector<int>>(20, std::vector<int>(20, 1))));
}

TEST(ParallelFor, hands_on_what_a_body_throws_and_begins_no_further_one) {
  std::atomic<int> calls = 0;
  const auto throwing = [&] {
    parallel_for(1'000'000, [&](std::size_t i) {
      ++calls;
      if (i == 3) throw std::runtime_error("of three");
    });
  };
  EXPECT_THROW(throwing(), std::runtime_error);
  EXPECT_LT(calls, 1'000'000);
  parallel_for(10, [&](std::size_t) { ++calls; });
}

/// Threads on which the calls of a loop ran that leaves each core time to come.
std::set<std::thread::id> threads_of_loop() {
  std::vector<std::thread::id> ids(200);
  parallel_for(ids.size(), [&](std::size_t i) {
    ids[i] = std::this_thread::get_id();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  return {ids.begin(), ids.end()};
}

TEST(ParallelFor, is_on_all_cores_again_after_loops_that_nested_or_failed) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  EXPECT_EQ(threads_of_loop().size(), static_cast<std::size_t>(CPU_COUNT(&allowed)));
}

TEST(ParallelFor, begins_no_thread_on_one_core) {
  support::on_one_core([] { EXPECT_EQ(threads_of_loop(), std::set{std::this_thread::get_id()}); });
}

TEST(ParallelFor, has_no_more_threads_than_cores_where_loops_nest) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  std::atomic<int> at_work = 0;
  std::atomic<int> most = 0;
  parallel_for(20, [&](std::size_t) {
    parallel_for(20, [&](std::size_t) {
      const int now = ++at_work;
      for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
      }
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      --at_work;
    });
  });
  EXPECT_LE(most, CPU_COUNT(&allowed));
}

TEST(ParallelFor, does_without_threads_that_the_system_does_not_give) {
  pthread_attr_t before;
  ASSERT_EQ(pthread_getattr_default_np(&before), 0);
  pthread_attr_t huge = before;
  pthread_attr_setstacksize(&huge, std::size_t{1} << 50U);
  ASSERT_EQ(pthread_setattr_default_np(&huge), 0);
  EXPECT_EQ(threads_of_loop(), std::set{std::this_thread::get_id()});
  pthread_setattr_default_np(&before);
  pthread_attr_destroy(&before);
}

}  // namespace
}  // namespace dermis::learn::calibration
