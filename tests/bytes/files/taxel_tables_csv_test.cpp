// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/taxel_tables_csv.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <sstream>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

using Table = std::vector<double>;

/// All frames of 2x3 taxels, or the error.
Result<std::vector<Table>> tables_of(const std::string& text, const std::string& name = "g.csv",
                                     TableValues values = TableValues::not_negative) {
  TaxelTablesReader reader = TaxelTablesReader::open(std::make_unique<std::istringstream>(text), name, 2, 3, values);
  std::vector<Table> tables;
  while (true) {
    Table table(6);
    const Result<bool> got_frame = reader.next(table);
    if (!got_frame) return got_frame.error();
    if (!*got_frame) return tables;
    tables.push_back(table);
  }
}

std::string error_of(const std::string& text) {
  const auto tables = tables_of(text);
  if (tables) return "no error";
  EXPECT_EQ(tables.error().kind, ErrorKind::bad_input);
  return tables.error().message;
}

TEST(TaxelTablesReader, reads_frame_after_frame) {
  const std::vector<Table> expected{{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, {0.0, 1e-7, 0.5, 0.0, 0.0, 9.0}};
  for (const char* const text : {"1,2,3\n4,5,6\n0,1e-7,0.5\n0,0,9\n", "1,2,3\n4,5,6\n\n\n0,1e-7,0.5\n0,0,9",
                                 "a,b,c\n1,2,3\n4,5,6\n0,1e-7,.5\n0,0,9\n",
                                 "\xEF\xBB\xBF# siemens\r\n 1 , 2,3\r\n4,5,6\r\n\r\n0,1e-7,0.5\r\n0,0,9\r\n"}) {
    const auto tables = tables_of(text);
    ASSERT_TRUE(tables) << tables.error().message;
    EXPECT_EQ(*tables, expected) << text;
  }
}

TEST(TaxelTablesReader, takes_a_file_without_frames) {
  EXPECT_TRUE(tables_of("")->empty());
  EXPECT_TRUE(tables_of("c0,c1,c2\n")->empty());
}

TEST(TaxelTablesReader, names_the_line_at_which_a_frame_begins) {
  TaxelTablesReader reader = TaxelTablesReader::open(
      std::make_unique<std::istringstream>("x\n1,2,3\n4,5,6\n\n7,8,9\n1,2,3\n"), "g", 2, 3, TableValues::finite);
  std::array<double, 6> table{};
  ASSERT_TRUE(*reader.next(table));
  EXPECT_EQ(reader.line(), 2U);
  ASSERT_TRUE(*reader.next(table));
  EXPECT_EQ(reader.line(), 5U);
}

TEST(TaxelTablesReader, refuses_other_sizes) {
  EXPECT_EQ(error_of("1,2,3\n4,5\n"),
            "g.csv:2: has 2 values, the array 3 columns; write 2 lines of 3 numbers a frame, with commas");
  EXPECT_EQ(error_of("1;2;3\n4;5;6\n7,8,9\n"),
            "g.csv:1: has semicolons between its values; write commas, and decimals with a point");
  EXPECT_EQ(error_of("1,2,3\n4,5,6\n7,8,9\n"), "g.csv:3: the file ends after 1 line of a frame; the array has 2 rows");
}

TEST(TaxelTablesReader, refuses_what_is_no_number) {
  EXPECT_EQ(error_of("1,2,3\n4,x,6\n"), "g.csv:2: value 2: 'x' is not a finite number");
  EXPECT_EQ(error_of("1,2,3\n4,,6\n"), "g.csv:2: value 2: '' is not a finite number");
  EXPECT_EQ(error_of("1,2,nan\n4,5,6\n"), "g.csv:1: value 3: 'nan' is not a finite number");
  EXPECT_EQ(error_of("1,2,1e999\n4,5,6\n"), "g.csv:1: value 3: '1e999' is not a finite number");
  EXPECT_EQ(error_of("1,2,3\n-4,5,6\n"), "g.csv:2: value 1: '-4' is not a conductance; write siemens, 0 or more");
  EXPECT_EQ((*tables_of("1,2,3\n-4,5,6\n", "r.csv", TableValues::finite))[0][3], -4.0);
}

TEST(TaxelTablesReader, takes_one_header_at_the_beginning_only) {
  EXPECT_EQ(error_of("a,b,c\nd,e,f\n"), "g.csv:2: value 1: 'd' is not a finite number");
  EXPECT_EQ(error_of("1,2,3\na,b,c\n"), "g.csv:2: value 1: 'a' is not a finite number");
  EXPECT_EQ(error_of("1,b,c\n"), "g.csv:1: value 2: 'b' is not a finite number");
}

TEST(TaxelTablesReader, refuses_a_file_that_is_not_there) {
  EXPECT_EQ(TaxelTablesReader::open("/nonexistent/g.csv", 2, 3, TableValues::finite).error().kind,
            ErrorKind::bad_input);
}

TEST(TaxelTablesReader, gives_frames_or_a_one_line_error_for_mutations) {
  support::expect_value_or_one_line_error("c0,c1,c2\n0.001,2e-5,0\n1e-3,0.5,1\n\n0,0,0\n1,2,3\n", 5000,
                                          [](const std::string& text) { return tables_of(text, "mutated"); });
}

TEST(TaxelTablesWriter, writes_what_reads_back_equal_to_the_last_bit) {
  const support::TemporaryFolder folder;
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  std::vector<Table> tables(3, Table(6));
  for (Table& table : tables) {
    for (double& value : table) value = random.log_uniform(1e-9, 1.0);
  }
  Result<TaxelTablesWriter> writer = TaxelTablesWriter::create(folder.file("g.csv"), 2, 3);
  ASSERT_TRUE(writer);
  for (const Table& table : tables) ASSERT_TRUE(writer->write(table));
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(*tables_of(support::read_bytes(folder.file("g.csv"))), tables);
}

TEST(TaxelTablesWriter, writes_plain_lines_and_nan_where_there_is_no_number) {
  const support::TemporaryFolder folder;
  Result<TaxelTablesWriter> writer = TaxelTablesWriter::create(folder.file("g.csv"), 2, 2);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(std::array{0.5, 1e-9, 0.0, -2.0}));
  ASSERT_TRUE(writer->write(std::array{std::numeric_limits<double>::quiet_NaN(), 1.0, 2.0, 3.0}));
  EXPECT_EQ(folder.file_count(), 1U);  // the temporary file
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(support::read_bytes(folder.file("g.csv")), "0.5,1e-09\n0,-2\n\nnan,1\n2,3\n");
}

}  // namespace
}  // namespace dermis::bytes::files
