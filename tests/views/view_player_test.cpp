// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "views/view_player.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "support/force_mat.hpp"

namespace dermis::views {
namespace {

using support::error_of;
using support::kPressed;
using support::kShape;
using support::MatFiles;
using support::pressed;

std::unique_ptr<ArrayView> opened(const MatFiles& mat, const std::string& from, const std::atomic<bool>& stop) {
  Result<std::unique_ptr<ArrayView>> view = ArrayView::open(from, mat.model(), {.stop = &stop});
  EXPECT_TRUE(view) << error_of(view);
  return view ? *std::move(view) : nullptr;
}

out::report::TerminalPicture picture_at_end(const ViewPlayer& player) {
  out::report::TerminalPicture picture;
  while (!picture.has_ended) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    picture = player.picture();
  }
  return picture;
}

TEST(ViewPlayer, shows_the_last_frame_in_a_scale_that_has_covered_all) {
  const MatFiles mat;
  std::atomic<bool> stop = false;
  const auto view = opened(mat, mat.write("frames.csv", pressed({0.0F, 30.0F, 6.0F})), stop);
  ASSERT_TRUE(view);
  const ViewPlayer player(*view, stop);
  const out::report::TerminalPicture picture = picture_at_end(player);
  EXPECT_TRUE(player.status());
  EXPECT_EQ(picture.name, "mat");
  EXPECT_EQ(picture.unit, "N");
  EXPECT_EQ(picture.shape, kShape);
  EXPECT_NEAR(picture.values[kPressed], 6.0, 1e-4);
  EXPECT_EQ(picture.high, 50.0);
  EXPECT_TRUE(picture.has_contacts);
  EXPECT_EQ(picture.report.contacts.size(), 1U);
}

TEST(ViewPlayer, keeps_the_scale_that_it_is_given) {
  const MatFiles mat;
  std::atomic<bool> stop = false;
  const auto view = opened(mat, mat.write("frames.csv", pressed({30.0F})), stop);
  ASSERT_TRUE(view);
  const ViewPlayer player(*view, stop, 7.0);
  EXPECT_EQ(picture_at_end(player).high, 7.0);
}

TEST(ViewPlayer, tells_why_its_source_has_failed) {
  const MatFiles mat;
  std::atomic<bool> stop = false;
  support::write_bytes(mat.file("cut.csv"), support::read_bytes(mat.write("frames.csv", pressed({1.0F}))) + "1.5,7\n");
  const auto view = opened(mat, mat.file("cut.csv"), stop);
  ASSERT_TRUE(view);
  const ViewPlayer player(*view, stop);
  picture_at_end(player);
  const Status status = player.status();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("cut.csv:3"), std::string::npos) << status.error().message;
}

TEST(ViewPlayer, ends_with_its_object_while_the_source_goes_on) {
  const MatFiles mat;
  std::atomic<bool> stop = false;
  const auto view = opened(mat, "sim:idle?rate=100&rows=3&cols=4", stop);
  ASSERT_TRUE(view);
  { const ViewPlayer player(*view, stop); }
  EXPECT_TRUE(stop);
}

}  // namespace
}  // namespace dermis::views
