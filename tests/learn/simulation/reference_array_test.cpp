// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/reference_array.hpp"

#include <gtest/gtest.h>

#include "dermis/bytes/files/array_toml.hpp"
#include "support/places.hpp"
#include "support/reference_array.hpp"

namespace dermis::learn::simulation {
namespace {

TEST(ReferenceArray, is_that_of_the_example) {
  const auto chest = bytes::files::read_array((support::project_folder() / "examples/chest/array.toml").string());
  ASSERT_TRUE(chest) << chest.error().message;
  EXPECT_EQ(bytes::files::array_to_toml(simulation::reference_array()), bytes::files::array_to_toml(*chest));
}

TEST(ReferenceArray, is_that_of_the_tests_at_any_size) {
  ArrayDescription of_tests = support::reference_array(3, 5);
  of_tests.name = "chest";
  EXPECT_EQ(bytes::files::array_to_toml(simulation::reference_array({3, 5})), bytes::files::array_to_toml(of_tests));
}

}  // namespace
}  // namespace dermis::learn::simulation
