// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/paper_bank_file.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::paper {
namespace {

using support::TemporaryFolder;

PaperBank random_bank(std::size_t taxels, std::optional<PaperBank::Range> celsius) {
  Random random(5);
  std::vector<PaperBank::Range> ratio;
  for (std::size_t k = 0; k < taxels; ++k) ratio.push_back({random.uniform(0.0, 0.1), random.uniform(0.2, 1.0)});
  PaperBank bank(ratio, celsius, 42.0);
  for (std::size_t k = 0; k < taxels; ++k) {
    std::vector<float> parameters(bank.networks().shape().parameter_count());
    for (float& value : parameters) value = static_cast<float>(random.normal());
    bank.networks().set_parameters(k, parameters);
  }
  return bank;
}

void expect_equal(const PaperBank& a, const PaperBank& b) {
  ASSERT_EQ(a.taxel_count(), b.taxel_count());
  ASSERT_EQ(a.celsius().has_value(), b.celsius().has_value());
  if (a.celsius()) {
    EXPECT_EQ(a.celsius()->low, b.celsius()->low);
    EXPECT_EQ(a.celsius()->high, b.celsius()->high);
  }
  EXPECT_EQ(a.heaviest_newtons(), b.heaviest_newtons());
  for (std::size_t k = 0; k < a.taxel_count(); ++k) {
    EXPECT_EQ(a.ratio()[k].low, b.ratio()[k].low);
    EXPECT_EQ(a.ratio()[k].high, b.ratio()[k].high);
    std::vector<float> of_a(a.networks().shape().parameter_count());
    std::vector<float> of_b(of_a.size());
    a.networks().parameters(k, of_a);
    b.networks().parameters(k, of_b);
    EXPECT_EQ(of_a, of_b);
  }
}

TEST(PaperBankFile, reads_what_it_wrote) {
  for (const auto& celsius : {std::optional<PaperBank::Range>{}, std::optional(PaperBank::Range{-5.0, 45.0})}) {
    const TemporaryFolder folder;
    const PaperBank bank = random_bank(6, celsius);
    ASSERT_TRUE(write_paper_bank(folder.file("bank"), bank));
    const Result<PaperBank> read = read_paper_bank(folder.file("bank"));
    ASSERT_TRUE(read) << read.error().message;
    expect_equal(bank, *read);
    EXPECT_EQ(folder.file_count(), 1U);
  }
}

/// A written bank, changed by `change`, must be refused with a line that names the file and `place`.
template <typename Change>
void expect_refused(const char* place, Change change) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_paper_bank(folder.file("bank"), random_bank(4, PaperBank::Range{0.0, 50.0})));
  bytes::files::SafetensorsFile file = bytes::files::read_safetensors(folder.file("bank")).value();
  change(file);
  ASSERT_TRUE(bytes::files::write_safetensors(folder.file("bank"), file));
  const Result<PaperBank> read = read_paper_bank(folder.file("bank"));
  ASSERT_FALSE(read) << place;
  EXPECT_EQ(read.error().kind, ErrorKind::bad_input);
  EXPECT_NE(read.error().message.find(folder.file("bank")), std::string::npos) << read.error().message;
  EXPECT_NE(read.error().message.find(place), std::string::npos) << read.error().message;
}

TEST(PaperBankFile, refuses_what_is_missing_or_out_of_range) {
  using bytes::files::SafetensorsFile;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto doubles = [](SafetensorsFile& file, const char* name) -> std::vector<double>& {
    return std::get<std::vector<double>>(file.tensors.at(name).values);
  };
  expect_refused("calibration writes one", [](SafetensorsFile& file) { file.metadata["format"] = "dermis model 1"; });
  expect_refused("calibration writes one", [](SafetensorsFile& file) { file.metadata.clear(); });
  for (const char* name : {"ratio", "heaviest_newtons", "parameters"}) {
    expect_refused(name, [&](SafetensorsFile& file) { file.tensors.erase(name); });
  }
  expect_refused("parameters", [](SafetensorsFile& file) { file.tensors.erase("celsius"); });
  expect_refused("ratio", [&](SafetensorsFile& file) { doubles(file, "ratio")[3] = doubles(file, "ratio")[2]; });
  expect_refused("ratio", [&](SafetensorsFile& file) { doubles(file, "ratio")[1] = kInfinity; });
  expect_refused("ratio", [&](SafetensorsFile& file) { file.tensors["ratio"] = {{0, 2}, std::vector<double>{}}; });
  expect_refused("celsius", [&](SafetensorsFile& file) { doubles(file, "celsius")[0] = 60.0; });
  expect_refused("heaviest_newtons", [&](SafetensorsFile& file) { doubles(file, "heaviest_newtons")[0] = 0.0; });
  expect_refused("parameters", [](SafetensorsFile& file) {
    std::get<std::vector<float>>(file.tensors.at("parameters").values)[7] = std::numeric_limits<float>::quiet_NaN();
  });
}

TEST(PaperBankFile, a_damaged_file_is_refused_or_read_as_a_sound_bank) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_paper_bank(folder.file("bank"), random_bank(3, PaperBank::Range{0.0, 50.0})));
  const std::string whole = support::read_bytes(folder.file("bank"));
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (int trial = 0; trial < 1000; ++trial) {
    std::string bytes = whole;
    if (trial % 4 == 0) bytes.resize(random.below(bytes.size()));
    for (std::uint64_t flips = random.below(4); flips > 0 && !bytes.empty(); --flips) {
      bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
    }
    support::write_bytes(folder.file("damaged"), bytes);
    Result<PaperBank> read = read_paper_bank(folder.file("damaged"));
    if (!read) continue;
    EXPECT_GT(read->heaviest_newtons(), 0.0);
    std::vector<float> newtons(read->taxel_count());
    read->estimate(std::vector<double>(read->taxel_count(), 0.5), 20.0, newtons);
  }
}

TEST(PaperBankFile, refuses_a_file_that_is_not_there_or_no_safetensors) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_paper_bank(folder.file("absent")));
  support::write_bytes(folder.file("text"), "hello");
  EXPECT_FALSE(read_paper_bank(folder.file("text")));
}

}  // namespace
}  // namespace dermis::paper
