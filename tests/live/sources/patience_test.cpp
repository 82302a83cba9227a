// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/patience.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace dermis::live::sources {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

void await(const std::atomic<bool>& flag) {
  while (!flag) std::this_thread::sleep_for(milliseconds(1));
}

TEST(Patience, is_over_after_its_time) {
  const Patience patience(nullptr, milliseconds(1));
  await(*patience.over());
}

TEST(Patience, is_over_when_all_is_to_stop) {
  std::atomic<bool> stop = false;
  const Patience patience(&stop, hours(1));
  EXPECT_FALSE(*patience.over());
  stop = true;
  await(*patience.over());
}

TEST(Patience, ends_at_once_where_nobody_waits_any_more) {
  const Patience patience(nullptr, hours(1));
  EXPECT_FALSE(*patience.over());
}

}  // namespace
}  // namespace dermis::live::sources
