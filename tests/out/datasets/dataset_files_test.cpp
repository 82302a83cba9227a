// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/dataset_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "support/temporary_folder.hpp"

// tests/pypi/datasets_test.py reads the files by the packages of others.
namespace dermis::out::datasets {
namespace {

/// One episode of two steps.
Status write_dataset(EpisodeSink& sink) {
  const std::vector<Column> columns = {{"", "time_ns", ColumnType::int64, {1}, {"ns"}},
                                       {"chest", "valid", ColumnType::boolean, {2, 3}, {"rows", "cols"}}};
  StepBlock block{2, {std::vector<std::byte>(16), std::vector<std::byte>(12)}};
  Status done = sink.begin(columns);
  if (done) done = sink.write(block);
  if (done) done = sink.end_episode();
  return done ? sink.commit({.episodes = 1, .steps = 2}) : done;
}

class DatasetFiles : public testing::TestWithParam<std::string> {
 public:
  void SetUp() override {
    const bool has_writer = GetParam() != "lerobot" || std::system("python3 -c 'import pyarrow' 2>/dev/null") == 0;
    if (!has_writer) GTEST_SKIP() << "skipped: python3 has no pyarrow (tests/pypi has)";
  }

 protected:
  [[nodiscard]] DatasetOptions options() const { return {.format = *dataset_format(GetParam())}; }

  support::TemporaryFolder folder_;
};

TEST_P(DatasetFiles, appear_complete_in_a_new_folder) {
  const auto sink = create_dataset(folder_.file("set"), options());
  ASSERT_TRUE(sink) << sink.error().message;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("set")));
  const Status written = write_dataset(**sink);
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_FALSE(std::filesystem::is_empty(folder_.file("set")));
  EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_P(DatasetFiles, leave_nothing_where_they_are_not_complete) {
  ASSERT_TRUE(create_dataset(folder_.file("set"), options()));
  EXPECT_EQ(folder_.file_count(), 0U);
}

TEST_P(DatasetFiles, hold_nothing_that_a_killed_process_has_left) {
  const std::string left = folder_.file("set.dermis.tmp");
  std::filesystem::create_directory(left);
  support::write_bytes(left + "/old.parquet", "of a process that was killed");
  const auto sink = create_dataset(folder_.file("set"), options());
  ASSERT_TRUE(sink) << sink.error().message;
  ASSERT_TRUE(write_dataset(**sink));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("set/old.parquet")));
  EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_P(DatasetFiles, replace_nothing) {
  std::filesystem::create_directory(folder_.file("set"));
  support::write_bytes(folder_.file("set/thesis.txt"), "years of work");
  const auto sink = create_dataset(folder_.file("set"), options());
  ASSERT_FALSE(sink);
  EXPECT_NE(sink.error().message.find("exists and is no empty folder"), std::string::npos);
  EXPECT_EQ(folder_.file_count(), 1U);
}

INSTANTIATE_TEST_SUITE_P(formats, DatasetFiles, testing::ValuesIn(dataset_formats()));

TEST(LeRobotFiles, say_that_there_is_no_python_to_write_them) {
  support::TemporaryFolder folder;
  const auto sink = create_dataset(folder.file("set"), {.python = "no-python"});
  ASSERT_TRUE(sink);
  const Status begun = (*sink)->begin({});
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().message,
            "LeRobot datasets are written by Python and pyarrow: no-python: No such file or directory");
}

TEST(LeRobotFiles, say_what_the_python_lacks) {
  support::TemporaryFolder folder;
  const std::string bare = folder.file("bare");
  support::write_bytes(bare, "#!/bin/sh\nexec /usr/bin/python3 -S -E \"$@\"\n");  // without any package
  std::filesystem::permissions(bare, std::filesystem::perms::owner_all);
  const auto sink = create_dataset(folder.file("set"), {.python = bare});
  const Status begun = (*sink)->begin({});
  ASSERT_FALSE(begun);
  EXPECT_NE(begun.error().message.find("pip install pyarrow"), std::string::npos) << begun.error().message;
}

TEST(DatasetFormats, are_known_by_their_names) {
  EXPECT_EQ(*dataset_format("zarr"), DatasetFormat::zarr);
  const auto unknown = dataset_format("csv");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message, "format: 'csv' is none of lerobot, hdf5, robomimic, zarr");
}

}  // namespace
}  // namespace dermis::out::datasets
