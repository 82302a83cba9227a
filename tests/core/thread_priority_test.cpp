// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/core/thread_priority.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <thread>

namespace dermis {
namespace {

int nice_of_this_thread() {
  return ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()));
}

int nice_of_a_thread_of(ThreadPriority priority) {
  int nice = 0;
  std::thread([&] {
    set_thread_priority(priority);
    nice = nice_of_this_thread();
  }).join();
  return nice;
}

TEST(ThreadPriority, changes_the_calling_thread_alone) {
  const int before = nice_of_this_thread();
  EXPECT_EQ(nice_of_a_thread_of(ThreadPriority::low), 5);
  EXPECT_EQ(nice_of_this_thread(), before);
}

TEST(ThreadPriority, stays_as_it_is_where_the_system_allows_no_more) {
  const int high = nice_of_a_thread_of(ThreadPriority::high);
  EXPECT_TRUE(high == -10 || high == nice_of_this_thread()) << high;
}

}  // namespace
}  // namespace dermis
