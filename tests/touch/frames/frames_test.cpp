// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/frames.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(FrameStatus, is_ok_by_default) {
  EXPECT_EQ(ConditionedFrame{}.status, FrameStatus::ok);
  EXPECT_EQ(ConductanceFrame{}.status, FrameStatus::ok);
  EXPECT_EQ(ForceFrame{}.status, FrameStatus::ok);
}

TEST(FrameStatus, collects_flags) {
  FrameStatus status = FrameStatus::ok;
  status |= FrameStatus::saturated;
  status |= FrameStatus::not_converged;
  EXPECT_TRUE(has(status, FrameStatus::saturated));
  EXPECT_TRUE(has(status, FrameStatus::not_converged));
  EXPECT_FALSE(has(status, FrameStatus::rejected));
  EXPECT_EQ(status | FrameStatus::saturated, status);
}

TEST(FrameStatus, is_written_as_ok_or_its_flags_joined) {
  EXPECT_EQ(to_string(FrameStatus::ok), "ok");
  EXPECT_EQ(to_string(FrameStatus::rejected), "rejected");
  EXPECT_EQ(to_string(FrameStatus::not_converged | FrameStatus::saturated), "saturated+not_converged");
}

TEST(FrameStatus, has_a_name_for_every_flag) {
  for (unsigned bit = 0; bit < 10; ++bit) {
    const std::string name = to_string(static_cast<FrameStatus>(1U << bit));
    EXPECT_NE(name, "ok") << bit;
    EXPECT_EQ(name.find('+'), std::string::npos) << bit;
  }
}

}  // namespace
}  // namespace dermis
