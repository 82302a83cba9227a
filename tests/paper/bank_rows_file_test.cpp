// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/bank_rows_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/temporary_folder.hpp"
#include "support/thread_ranks.hpp"

namespace dermis::paper {
namespace {

using support::on_ranks;
using support::TemporaryFolder;

constexpr std::size_t kNetworks = 5;
constexpr std::size_t kParameters = 3;
constexpr const char* kOther = "is another";

bytes::files::SafetensorsFile first_of(double value) {
  bytes::files::SafetensorsFile first;
  first.metadata["format"] = "test";
  bytes::files::put_tensor(first, "value", {1}, std::vector<double>{value});
  return first;
}

BankRowsFile file_of(Ranks& ranks, double value = 0.0) {
  return {first_of(value), {{"a", "b"}, kNetworks, kParameters}, ranks};
}

/// The values of a row of one of the rank's networks.
void give(const Ranks& ranks, std::size_t tensor, std::size_t network, std::span<float> values) {
  const std::size_t row = own_part(ranks, kNetworks).first + network;
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<float>(100 * tensor + 10 * row + k);
}

Status write(const std::string& path, Ranks& ranks) {
  return file_of(ranks, 42.0).write(path, [&](std::size_t tensor, std::size_t network, std::span<float> values) {
    give(ranks, tensor, network, values);
  });
}

Result<std::string> read(const std::string& path, Ranks& ranks) {
  return file_of(ranks).read(path, kOther, [](std::size_t, std::size_t, std::span<float>) {});
}

TEST(BankRowsFile, is_the_file_of_one_process_and_a_safetensors_file) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write(folder.file("alone"), one_process()));
  const bytes::files::SafetensorsFile whole = bytes::files::read_safetensors(folder.file("alone")).value();
  EXPECT_TRUE(whole.has_checksum);
  EXPECT_EQ((*whole.view<float>("b", {kNetworks, kParameters}))[7], 121.0F);
  for (std::size_t count = 2; count <= 4; ++count) {
    on_ranks(count, [&](Ranks& ranks) { ASSERT_TRUE(write(folder.file("ranks"), ranks)); });
    EXPECT_EQ(support::read_bytes(folder.file("ranks")), support::read_bytes(folder.file("alone")));
    EXPECT_EQ(folder.file_count(), 2U);
  }
}

TEST(BankRowsFile, each_rank_reads_the_rows_of_its_networks) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write(folder.file("bank"), one_process()));
  on_ranks(3, [&](Ranks& ranks) {
    std::size_t rows = 0;
    const auto take = [&](std::size_t tensor, std::size_t network, std::span<float> values) {
      std::vector<float> expected(kParameters);
      give(ranks, tensor, network, expected);
      EXPECT_TRUE(std::equal(values.begin(), values.end(), expected.begin()));
      ++rows;
    };
    const Result<std::string> first = file_of(ranks).read(folder.file("bank"), kOther, take);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(rows, 2 * own_part(ranks, kNetworks).count);
    const double value = 42.0;
    EXPECT_EQ(*first, std::string(reinterpret_cast<const char*>(&value), sizeof(value)));
  });
}

TEST(BankRowsFile, all_ranks_get_the_error_of_a_place_that_cannot_be_written) {
  const TemporaryFolder folder;
  on_ranks(2, [&](Ranks& ranks) {
    const Status written = write(folder.file("absent/bank"), ranks);
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("absent/bank"), std::string::npos);
  });
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(BankRowsFile, refuses_any_other_bytes) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write(folder.file("bank"), one_process()));
  const std::string whole = support::read_bytes(folder.file("bank"));
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = whole;
    if (trial % 3 == 0) {
      bytes.resize(random.below(bytes.size()));
    } else {
      char& byte = bytes[random.below(bytes.size())];
      byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << random.below(8)));
    }
    support::write_bytes(folder.file("damaged"), bytes);
    const Result<std::string> refused = read(folder.file("damaged"), one_process());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::bad_input);
    EXPECT_TRUE(refused.error().message.starts_with(folder.file("damaged") + ": is ")) << refused.error().message;
  }
  EXPECT_FALSE(read(folder.file("absent"), one_process()));
}

}  // namespace
}  // namespace dermis::paper
