// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/aspects.hpp"

#include <gtest/gtest.h>

#include <set>

#include "simulated_touches.hpp"

namespace dermis::learn::recognition {
namespace {

TEST(Aspects, divide_all_features_among_them) {
  Layout layout = support::one_array(8, 16);
  layout.extras = 3;
  std::multiset<std::size_t> columns;
  std::vector<std::string> names;
  for (const ExpertColumns& aspect : aspect_columns(layout, true)) {
    columns.insert(aspect.columns.begin(), aspect.columns.end());
    names.push_back(aspect.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"place", "force", "area", "shape", "time", "the further readings"}));
  const std::size_t count = feature_columns(layout, true).count;
  EXPECT_EQ(columns.size(), count);
  for (std::size_t column = 0; column < count; ++column) EXPECT_EQ(columns.count(column), 1U) << column;
}

TEST(Aspects, are_those_that_there_is_a_feature_for) {
  std::vector<std::string> names;
  for (const ExpertColumns& aspect : aspect_columns(support::one_array(8, 16), false)) names.push_back(aspect.name);
  EXPECT_EQ(names, (std::vector<std::string>{"place", "force", "area", "shape"}));
}

}  // namespace
}  // namespace dermis::learn::recognition
