// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/origin_toml.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

void write(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

TEST(OriginToml, tells_the_source_of_the_very_frames_beside_it) {
  const support::TemporaryFolder folder;
  const std::string frames = folder.file("frames.csv");
  write(frames, "time_s,r0c0\n0,12\n");
  ASSERT_TRUE(write_origin(frames, "sim:idle?seed=7").has_value());
  EXPECT_EQ(simulated_source(frames), "sim:idle?seed=7");
}

TEST(OriginToml, says_nothing_of_other_frames_in_its_folder) {
  const support::TemporaryFolder folder;
  const std::string frames = folder.file("frames.csv");
  write(frames, "time_s,r0c0\n0,12\n");
  EXPECT_EQ(simulated_source(frames), "") << "no origin.toml";
  ASSERT_TRUE(write_origin(frames, "sim:idle?seed=7").has_value());
  write(frames, "time_s,r0c0\n0,13\n");
  EXPECT_EQ(simulated_source(frames), "") << "changed";
  EXPECT_EQ(simulated_source(folder.file("missing.csv")), "");
}

TEST(OriginToml, reads_what_it_writes) {
  const FramesOrigin origin{"sim:paper?seed=3", "fnv1a64:0011223344556677"};
  const Result<FramesOrigin> read = origin_from_toml(to_toml(origin), "origin.toml");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->source, origin.source);
  EXPECT_EQ(read->hash, origin.hash);
}

TEST(OriginToml, requires_both_keys_and_knows_no_others) {
  const std::string source = "[frames]\nsource = \"sim:idle\"\n";
  for (const std::string& text : {std::string(), source, source + "hash = 3\n", source + "hash = \"a\"\nseed = 1\n"}) {
    EXPECT_FALSE(origin_from_toml(text, "origin.toml").has_value()) << text;
  }
}

}  // namespace
}  // namespace dermis::bytes::files
