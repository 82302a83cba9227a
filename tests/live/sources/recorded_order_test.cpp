// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/recorded_order.hpp"

#include <gtest/gtest.h>

#include "dermis/bytes/files/array_toml.hpp"
#include "live/sources/small_array.hpp"

namespace dermis::live::sources {
namespace {

ArrayDescription turned() {
  ArrayDescription array = small_array();
  array.order = {.skip_columns = 1, .flip_rows = true, .row_order = {0, 2, 1, 3}};
  return array;
}

TEST(RecordedOrder, of_a_recording_that_was_made_turned_is_well) {
  const std::string toml = bytes::files::array_to_toml(turned());
  EXPECT_TRUE(check_recorded_order("rec.mcap", toml, turned()));
  EXPECT_TRUE(check_recorded_order("rec.mcap", toml, small_array()))
      << "its frames were turned, whatever turns none now";
  EXPECT_TRUE(check_recorded_order("rec.mcap", "", turned())) << "nobody knows";
  EXPECT_TRUE(check_recorded_order("rec.mcap", "no toml [", turned()));
}

TEST(RecordedOrder, of_a_recording_that_was_made_before_is_refused_with_the_mend) {
  const Status refused = check_recorded_order("rec.mcap", bytes::files::array_to_toml(small_array()), turned());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "'rec.mcap': was recorded before its array.toml said which way round; a new recording turns it where it "
            "takes its frames from 'file:rec.mcap?skip_columns=1&flip_rows=1&row_order=0,2,1,3'");
}

TEST(RecordedOrder, of_single_taxels_is_a_parameter_with_the_shape_that_is_sent) {
  EXPECT_EQ(order_parameters({.taxel_order = {7, 3, 0, 12}, .taxel_rows = 2, .taxels_sent = {4, 8}}),
            "rows=4&cols=8&taxel_order=7,3;0,12");
}

}  // namespace
}  // namespace dermis::live::sources
