// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/forces_csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "dermis/touch/frames/random.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

TEST(ForcesCsvWriter, writes_time_status_and_newtons) {
  const support::TemporaryFolder folder;
  Result<ForcesCsvWriter> writer = ForcesCsvWriter::create(folder.file("f.csv"), 1, 3);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write({Nanos(10'000'000), FrameStatus::ok, {0.0F, 9.81F, 50.0F}, {}, {}}));
  ASSERT_TRUE(writer->write({Nanos(20'000'000),
                             FrameStatus::saturated | FrameStatus::dead_taxels,
                             {std::nanf(""), -std::nanf(""), 0.125F},
                             {},
                             {}}));
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(support::read_bytes(folder.file("f.csv")),
            "time_s,status,r0c0,r0c1,r0c2\n0.01,ok,0,9.81,50\n0.02,saturated+dead_taxels,nan,nan,0.125\n");
}

TEST(ForcesCsvWriter, writes_standard_deviations_in_the_same_shape) {
  const support::TemporaryFolder folder;
  auto writer = ForcesCsvWriter::create(folder.file("s.csv"), 1, 3, ForceColumn::sigma_newtons);
  ASSERT_TRUE(writer);
  const float infinity = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(writer->write({Nanos(10'000'000),
                             FrameStatus::saturated | FrameStatus::dead_taxels,
                             {5.0F, 50.0F, std::nanf("")},
                             {0.25F, infinity, std::nanf("")},
                             {}}));
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(support::read_bytes(folder.file("s.csv")),
            "time_s,status,r0c0,r0c1,r0c2\n0.01,saturated+dead_taxels,0.25,inf,nan\n");
}

TEST(ForcesCsvWriter, writes_newtons_that_read_back_equal) {
  const support::TemporaryFolder folder;
  Random random(1);
  ForceFrame frame;
  for (int i = 0; i < 256; ++i) frame.newtons.push_back(static_cast<float>(random.log_uniform(1e-6, 1e3)));
  Result<ForcesCsvWriter> writer = ForcesCsvWriter::create(folder.file("f.csv"), 16, 16);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(frame));
  ASSERT_TRUE(writer->commit());
  std::istringstream text(support::read_bytes(folder.file("f.csv")));
  std::string line;
  std::getline(text, line);
  std::getline(text, line);
  std::istringstream cells(line.substr(std::string("0,ok,").size()));
  for (const float newtons : frame.newtons) {
    std::string cell;
    std::getline(cells, cell, ',');
    EXPECT_EQ(std::stof(cell), newtons);
  }
}

TEST(ForcesCsvWriter, reports_a_full_disk) {
  Result<ForcesCsvWriter> writer = ForcesCsvWriter::create("/dev/full", 1, 1);
  ASSERT_TRUE(writer);
  const Status committed = writer->commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().message, "cannot write '/dev/full': No space left on device");
}

}  // namespace
}  // namespace dermis::bytes::files
