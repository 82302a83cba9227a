// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/system/thread_priority.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <thread>

namespace dermis {
namespace {

int nice_of_this_thread() {
  return ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()));
}

TEST(ThreadPriority, rises_for_the_calling_thread_alone_where_that_is_allowed) {
  const int before = nice_of_this_thread();
  int raised = 0;
  std::thread([&] {
    raise_thread_priority();
    raised = nice_of_this_thread();
  }).join();
  EXPECT_TRUE(raised == -10 || raised == before) << raised;
  EXPECT_EQ(nice_of_this_thread(), before);
}

}  // namespace
}  // namespace dermis
