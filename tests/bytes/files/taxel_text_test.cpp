// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/taxel_text.hpp"

#include <gtest/gtest.h>

namespace dermis::bytes::files {
namespace {

TEST(TaxelText, a_taxel_is_read_by_its_row_and_column) {
  const std::optional<TaxelPlace> place = parse_taxel("r12c305");
  ASSERT_TRUE(place);
  EXPECT_EQ(place->row, 12U);
  EXPECT_EQ(place->col, 305U);
}

TEST(TaxelText, anything_else_is_no_taxel) {
  for (const char* text : {"", "r", "r1", "c1", "r1c", "rc1", "r1c2x", "r-1c2", "R1C2", " r1c2"}) {
    EXPECT_FALSE(parse_taxel(text)) << text;
  }
}

TEST(TaxelText, a_region_is_a_taxel_or_two_corners_or_all) {
  const FrameShape shape{4, 5};
  EXPECT_EQ(parse_region("r3c4", shape).value(), (TaxelRegion{3, 4, 3, 4}));
  EXPECT_EQ(parse_region("r0c1:r2c3", shape).value(), (TaxelRegion{0, 1, 2, 3}));
  EXPECT_EQ(parse_region("all", shape).value(), (TaxelRegion{0, 0, 3, 4}));
  EXPECT_EQ(parse_region("left", shape).error().message, "'left' is not a place; write r3c5, r0c0:r3c3 or all");
  EXPECT_EQ(parse_region("r4c0", shape).error().message, "r4c0 does not exist in a 4x5 array");
}

TEST(TaxelText, the_names_of_a_header_go_row_by_row) {
  std::string header = "time_s";
  append_taxel_names(header, 2, 2);
  EXPECT_EQ(header, "time_s,r0c0,r0c1,r1c0,r1c1");
  EXPECT_EQ(size_text({12, 32}), "12x32");
}

}  // namespace
}  // namespace dermis::bytes::files
