// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/model.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_model.hpp"

namespace dermis::touch::pipeline {
namespace {

TEST(Model, is_consistent_where_all_sizes_are_those_of_the_array) {
  const Model model = support::hand_made_model(2, 3);
  EXPECT_TRUE(is_consistent(model));
  Model other = model;
  other.array.rows = 3;
  EXPECT_FALSE(is_consistent(other));
}

TEST(Model, of_a_strip_is_one_line_of_taxels) {
  Model model = support::hand_made_model(2, 3);
  model.strip = contacts::StripTable{};
  EXPECT_FALSE(is_consistent(model));
}

}  // namespace
}  // namespace dermis::touch::pipeline
