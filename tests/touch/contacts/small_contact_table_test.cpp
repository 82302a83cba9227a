// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/small_contact_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace dermis::touch::contacts {
namespace {

TEST(SmallContactTable, covers_a_point_anywhere_nearest_to_its_only_taxel) {
  const TaxelSpacing spacing;
  const SmallContactTable table(spacing, *PatchResponses::of(0.0));
  const std::optional<SmallContactPlace> place = table.find({.noise = 3e-3F});
  ASSERT_TRUE(place);
  const double uniform = 0.5 * spacing.col_pitch / std::sqrt(3.0);
  EXPECT_NEAR(std::sqrt(place->variance_x), 0.82 * uniform, 0.04 * uniform);
  EXPECT_NEAR(std::sqrt(place->variance_y), 0.82 * uniform, 0.04 * uniform);
}

}  // namespace
}  // namespace dermis::touch::contacts
