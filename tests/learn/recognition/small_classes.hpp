// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "dermis/learn/recognition/learning.hpp"
#include "simulated_touches.hpp"

namespace dermis::learn::recognition::support {

/// Classes of a few poses on an array of 12 x 10.
inline Classes small_classes() {
  const LabelledFrames data = poses(5, 1);
  const Result<LearningSet> set = LearningSet::create(data);
  EXPECT_TRUE(set);
  Result<Learned> learned = set->learn(all_labels(data));
  EXPECT_TRUE(learned);
  return std::move(learned->classes);
}

}  // namespace dermis::learn::recognition::support
