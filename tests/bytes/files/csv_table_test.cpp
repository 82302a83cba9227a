// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/csv_table.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "support/mutations.hpp"

namespace dermis::bytes::files {
namespace {

Result<CsvTable> table_of(const std::string& text) {
  std::istringstream in(text);
  return CsvTable::read(in, "t.csv");
}

std::string error_of(const std::string& text) {
  const Result<CsvTable> table = table_of(text);
  if (table) return "no error";
  EXPECT_EQ(table.error().kind, ErrorKind::bad_input);
  return table.error().message;
}

TEST(CsvTable, gives_its_cells_by_the_names_of_its_columns) {
  const Result<CsvTable> table = table_of("id, first ,class\r\na,3,cup\r\n\r\nb,4,\r\n");
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_EQ(table->rows(), 2U);
  ASSERT_EQ(table->column("class"), 2U);
  EXPECT_EQ(table->at(0, 2), "cup");
  EXPECT_EQ(table->at(1, 2), "");
  EXPECT_EQ(table->count_at(1, 1).value(), 4U);
  EXPECT_EQ(table->column("last"), std::nullopt);
}

TEST(CsvTable, names_the_columns_that_it_has_where_one_is_missing) {
  const Result<CsvTable> table = table_of("id,first\na,1\n");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->needed_column("class").error().message, "t.csv: has no column 'class'; its header is 'id,first'");
}

TEST(CsvTable, names_the_line_of_a_number_that_is_none) {
  const Result<CsvTable> table = table_of("id,first\na,1\n\nb,-1\nc,nan\n");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->count_at(1, 1).error().message, "t.csv:4: first '-1' is not a whole number of 0 or more");
  EXPECT_EQ(table->number_at(1, 1).value(), -1.0);
  EXPECT_EQ(table->number_at(2, 1).error().message, "t.csv:5: first 'nan' is not a number");
}

TEST(CsvTable, refuses_lines_that_do_not_fit_the_header) {
  EXPECT_EQ(error_of("id,first\na,1,2\n"),
            "t.csv:2: has 3 values, the header 2: write decimals with a point, as each comma begins a value");
  EXPECT_EQ(error_of("id,first,id\n"), "t.csv:1: names a column twice");
  EXPECT_EQ(error_of("\n"), "t.csv:1: is empty; a line with the names of its columns is expected");
}

TEST(CsvTable, that_was_damaged_gives_a_table_or_one_line) {
  dermis::support::expect_value_or_one_line_error("id,first,class\na,1,cup\nb,2,pen\n", 300,
                                                  [](const std::string& text) {
                                                    std::istringstream in(text);
                                                    return CsvTable::read(in, "mutated");
                                                  });
}

TEST(CsvTable, refuses_more_cells_than_memory_is_bound_to) {
  std::string text = "c0";
  for (int column = 1; column < 4096; ++column) text += ",c" + std::to_string(column);
  const std::string line = "\n" + std::string(4095, ',');
  for (int row = 0; row < 2100; ++row) text += line;
  std::istringstream in(text);
  const Result<CsvTable> table = CsvTable::read(in, "labels.csv");
  ASSERT_FALSE(table);
  EXPECT_TRUE(table.error().message.starts_with("labels.csv:")) << table.error().message;
  EXPECT_TRUE(table.error().message.ends_with("is beyond 256 MiB of cells; divide the table")) << table.error().message;
}

}  // namespace
}  // namespace dermis::bytes::files
