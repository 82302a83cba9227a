// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "views/array_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/force_mat.hpp"

namespace dermis::views {
namespace {

using support::error_of;
using support::force_mat;
using support::kPressed;
using support::kShape;
using support::MatFiles;
using support::pressed;

std::unique_ptr<ArrayView> opened(const std::string& from, const std::string& model = {}) {
  Result<std::unique_ptr<ArrayView>> view = ArrayView::open(from, model);
  EXPECT_TRUE(view) << error_of(view);
  return view ? *std::move(view) : nullptr;
}

TEST(ArrayView, shows_newtons_and_contacts_by_a_model) {
  const MatFiles mat;
  const auto view = opened(mat.write("frames.csv", pressed({0.0F, 6.0F})), mat.model());
  ASSERT_TRUE(view && view->next().value() && view->next().value());
  EXPECT_TRUE(view->has_model());
  EXPECT_EQ(view->name(), "mat");
  EXPECT_EQ(view->from(), mat.file("frames.csv"));
  EXPECT_STREQ(view->unit(), "N");
  EXPECT_EQ(view->row_pitch_m(), 0.004);
  EXPECT_EQ(view->shape(), kShape);
  EXPECT_NEAR(view->values()[kPressed], 6.0, 1e-4);
  EXPECT_EQ(view->contacts().contacts.size(), 1U);
  EXPECT_EQ(view->scale(6.0), 10.0);
  EXPECT_FALSE(view->next().value());
}

TEST(ArrayView, takes_a_recording_at_its_word_that_its_readings_are_forces) {
  const MatFiles mat;
  const std::string path =
      mat.write("rec.mcap", pressed({6.0F}), kShape, {"", bytes::files::array_to_toml(force_mat()), ""});
  const auto view = opened(path);
  ASSERT_TRUE(view && view->next().value());
  EXPECT_TRUE(view->has_model());
  EXPECT_EQ(view->name(), "mat");
  EXPECT_NEAR(view->values()[kPressed], 6.0, 1e-4);
}

TEST(ArrayView, shows_counts_of_the_file_where_nothing_more_is_known) {
  const MatFiles mat;
  const auto view = opened(mat.write("frames.csv", pressed({300.0F})));
  ASSERT_TRUE(view && view->next().value());
  EXPECT_FALSE(view->has_model());
  EXPECT_EQ(view->name(), "frames.csv");
  EXPECT_STREQ(view->unit(), "counts");
  EXPECT_EQ(view->values()[kPressed], 300.0);
  EXPECT_TRUE(view->contacts().contacts.empty());
  EXPECT_EQ(view->scale(200.0), 255.0);
  EXPECT_EQ(view->scale(300.0), 511.0);
}

TEST(ArrayView, knows_a_live_source) {
  const auto view = opened("sim:idle?frames=1&rows=2&cols=3");
  ASSERT_TRUE(view);
  EXPECT_TRUE(view->is_live());
  EXPECT_EQ(view->name(), "sim:idle?frames=1&rows=2&cols=3");
}

}  // namespace
}  // namespace dermis::views
