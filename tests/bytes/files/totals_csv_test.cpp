// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/totals_csv.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

TEST(TotalsCsvWriter, writes_the_sum_its_standard_deviation_and_how_many_taxels_are_left_out) {
  const support::TemporaryFolder folder;
  Result<TotalsCsvWriter> writer = TotalsCsvWriter::create(folder.file("t.csv"));
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write({Nanos(10'000'000), FrameStatus::ok, {1.0F, 2.5F}, {0.375F, 0.5F}, {}}));
  const float none = std::nanf("");
  ASSERT_TRUE(writer->write({Nanos(20'000'000), FrameStatus::dead_taxels, {0.25F, none}, {0.5F, none}, {}}));
  ASSERT_TRUE(writer->write({Nanos(30'000'000), FrameStatus::rejected, {none, none}, {none, none}, {}}));
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(support::read_bytes(folder.file("t.csv")),
            "time_s,status,total_n,sigma_total_n,left_out\n0.01,ok,3.5,0.625,0\n0.02,dead_taxels,0.25,0.5,1\n"
            "0.03,rejected,nan,nan,2\n");
}

TEST(TotalsCsvWriter, names_a_place_that_it_cannot_write) {
  const auto writer = TotalsCsvWriter::create("/nowhere/t.csv");
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("/nowhere/t.csv"), std::string::npos);
}

}  // namespace
}  // namespace dermis::bytes::files
