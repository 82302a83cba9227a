// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/frame_joiner.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "out/serve/named_touches.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::out::serve {
namespace {

using std::chrono::milliseconds;
using Newtons = std::vector<float>;

TEST(FrameJoiner, puts_the_last_frames_of_the_others_beside_a_frame_of_the_first) {
  FrameJoiner joiner({2, 1, 2});
  joiner.keep(2, force_frame(milliseconds(1), {5.0F, 6.0F}));
  joiner.keep(1, force_frame(milliseconds(2), {3.0F}));
  joiner.keep(1, force_frame(milliseconds(3), {4.0F}));
  const ForceFrame& joined = joiner.join(force_frame(milliseconds(3), {1.0F, 2.0F}));
  EXPECT_EQ(joined.time, milliseconds(3));
  EXPECT_EQ(joined.newtons, (Newtons{1.0F, 2.0F, 4.0F, 5.0F, 6.0F}));
}

TEST(FrameJoiner, an_array_that_was_silent_for_half_a_second_has_no_load) {
  FrameJoiner joiner({1, 1});
  EXPECT_EQ(joiner.join(force_frame(milliseconds(0), {1.0F})).newtons, (Newtons{1.0F, 0.0F})) << "nothing came";
  joiner.keep(1, force_frame(milliseconds(1000), {3.0F}));
  EXPECT_EQ(joiner.join(force_frame(milliseconds(1500), {1.0F})).newtons, (Newtons{1.0F, 3.0F}));
  EXPECT_EQ(joiner.join(force_frame(milliseconds(1501), {1.0F})).newtons, (Newtons{1.0F, 0.0F}));
  EXPECT_EQ(joiner.join(force_frame(milliseconds(400), {1.0F})).newtons, (Newtons{1.0F, 0.0F})) << "time went back";
}

TEST(FrameJoiner, passes_over_rejected_frames) {
  FrameJoiner joiner({1, 1});
  joiner.keep(1, force_frame(milliseconds(1), {3.0F}));
  ForceFrame rejected = force_frame(milliseconds(2), {9.0F});
  rejected.status |= FrameStatus::rejected;
  joiner.keep(1, rejected);
  EXPECT_EQ(joiner.join(force_frame(milliseconds(2), {1.0F})).newtons, (Newtons{1.0F, 3.0F}));
}

TEST(FrameJoiner, allocates_nothing_for_a_frame) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  FrameJoiner joiner({2, 1});
  const ForceFrame other = force_frame(milliseconds(1), {3.0F});
  const ForceFrame first = force_frame(milliseconds(1), {1.0F, 2.0F});
  const support::AllocationGuard guard;
  joiner.keep(1, other);
  static_cast<void>(joiner.join(first));
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::out::serve
