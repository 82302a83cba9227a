// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/config_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

namespace dermis::bytes::files {
namespace {

/// What finish() says after the reading functions of `read`.
std::string message_after(const std::string& text, const std::function<void(ConfigFile&)>& read) {
  Result<ConfigFile> file = ConfigFile::parse(text, "c.toml");
  if (!file) {
    EXPECT_EQ(file.error().kind, ErrorKind::bad_input);
    return file.error().message;
  }
  read(*file);
  const Status status = file->finish();
  if (status) return "ok";
  EXPECT_EQ(status.error().kind, ErrorKind::bad_input);
  return status.error().message;
}

std::string parse_message(const std::string& text) {
  return message_after(text, [](ConfigFile&) {});
}

TEST(ConfigFile, fills_values_of_every_type) {
  double number = 0.0;
  double whole_as_number = 0.0;
  std::optional<double> optional;
  int integer = 0;
  std::size_t count = 0;
  bool boolean = false;
  std::string text;
  std::vector<double> per_line;
  std::vector<double> per_line_list;
  std::vector<double> numbers;
  std::size_t index = 0;
  const std::string message = message_after(
      "a = 1.5\nb = 2\nc = 0.5\nd = -3\ne = 4\nf = true\ng = \"x\"\nh = 7\ni = [1, 2.5]\nj = [3.0]\nk = \"two\"\n",
      [&](ConfigFile& file) {
        file.number("a", number);
        file.number("b", whole_as_number);
        file.number("c", optional);
        file.integer("d", integer);
        file.count("e", count);
        file.boolean("f", boolean);
        file.text("g", text);
        file.number_per_line("h", 3, per_line);
        file.number_per_line("i", 2, per_line_list);
        file.numbers("j", 1, numbers);
        file.choice("k", {"one", "two"}, index);
      });
  EXPECT_EQ(message, "ok");
  EXPECT_EQ(number, 1.5);
  EXPECT_EQ(whole_as_number, 2.0);
  EXPECT_EQ(optional, 0.5);
  EXPECT_EQ(integer, -3);
  EXPECT_EQ(count, 4U);
  EXPECT_TRUE(boolean);
  EXPECT_EQ(text, "x");
  EXPECT_EQ(per_line, (std::vector<double>{7.0, 7.0, 7.0}));
  EXPECT_EQ(per_line_list, (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(numbers, (std::vector<double>{3.0}));
  EXPECT_EQ(index, 1U);
}

TEST(ConfigFile, leaves_defaults_where_the_key_is_absent) {
  double number = 1.0;
  std::optional<double> optional;
  std::vector<double> list{1.0};
  std::size_t index = 5;
  EXPECT_EQ(message_after("",
                          [&](ConfigFile& file) {
                            file.number("t.a", number);
                            file.number("t.b", optional);
                            file.number_per_line("t.c", 3, list);
                            file.choice("t.d", {"one"}, index);
                          }),
            "ok");
  EXPECT_EQ(number, 1.0);
  EXPECT_EQ(optional, std::nullopt);
  EXPECT_EQ(list, (std::vector<double>{1.0}));
  EXPECT_EQ(index, 5U);
}

TEST(ConfigFile, takes_a_word_for_a_number_where_it_may) {
  const ConfigFile::Word fit{"fit", -1.0};
  std::vector<double> all;
  std::vector<double> some;
  EXPECT_EQ(message_after("a = \"fit\"\nb = [2, \"fit\", 3.5]\n",
                          [&](ConfigFile& file) {
                            file.number_per_line("a", 2, fit, all);
                            file.number_per_line("b", 3, fit, some);
                          }),
            "ok");
  EXPECT_EQ(all, (std::vector<double>{-1.0, -1.0}));
  EXPECT_EQ(some, (std::vector<double>{2.0, -1.0, 3.5}));
}

TEST(ConfigFile, reads_keys_in_tables_however_they_are_written) {
  for (const char* text : {"[a.b]\nc = 1\n", "a.b.c = 1\n", "a = {b = {c = 1}}\n", "[a]\nb.c = 1\n"}) {
    int value = 0;
    EXPECT_EQ(message_after(text, [&](ConfigFile& file) { file.integer("a.b.c", value); }), "ok") << text;
    EXPECT_EQ(value, 1) << text;
  }
}

TEST(ConfigFile, knows_what_it_contains) {
  Result<ConfigFile> file = ConfigFile::parse("[a]\nb = \"fit\"\n", "c.toml");
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->contains("a.b"));
  EXPECT_FALSE(file->contains("a.c"));
  EXPECT_FALSE(file->contains("a.b.c"));
  EXPECT_TRUE(file->is_text("a.b", "fit"));
  EXPECT_FALSE(file->is_text("a.b", "fi"));
  EXPECT_FALSE(file->is_text("a.c", "fit"));
}

TEST(ConfigFile, names_place_and_expectation_of_a_wrong_type) {
  double number = 0.0;
  std::vector<double> list;
  std::size_t index = 0;
  using File = ConfigFile;
  EXPECT_EQ(message_after("\na = \"1\"", [&](File& file) { file.number("a", number); }),
            "c.toml:2: a: must be a number");
  EXPECT_EQ(message_after("a = nan", [&](File& file) { file.number("a", number); }), "c.toml:1: a: must be a number");
  EXPECT_EQ(message_after("a = 1.5",
                          [](File& file) {
                            int value = 0;
                            file.integer("a", value);
                          }),
            "c.toml:1: a: must be a whole number");
  EXPECT_EQ(message_after("a = 3000000000",
                          [](File& file) {
                            int value = 0;
                            file.integer("a", value);
                          }),
            "c.toml:1: a: must be a whole number");
  EXPECT_EQ(message_after("a = -1", [&](File& file) { file.count("a", index); }),
            "c.toml:1: a: must be a whole number of 0 or more");
  EXPECT_EQ(message_after("a = 1",
                          [](File& file) {
                            bool value = false;
                            file.boolean("a", value);
                          }),
            "c.toml:1: a: must be true or false");
  EXPECT_EQ(message_after("a = 1",
                          [](File& file) {
                            std::string value;
                            file.text("a", value);
                          }),
            "c.toml:1: a: must be a text in quotes");
  EXPECT_EQ(message_after("a = [1, \"2\"]", [&](File& file) { file.number_per_line("a", 2, list); }),
            "c.toml:1: a: must be one number or a list of 2 numbers");
  EXPECT_EQ(message_after("a = [1, 2, 3]", [&](File& file) { file.number_per_line("a", 2, list); }),
            "c.toml:1: a: must be one number or a list of 2 numbers, has 3");
  const File::Word fit{"fit", -1.0};
  EXPECT_EQ(message_after("a = \"fits\"", [&](File& file) { file.number_per_line("a", 2, fit, list); }),
            "c.toml:1: a: must be a number or \"fit\", or a list of 2 of these");
  EXPECT_EQ(message_after("a = [\"fit\", 2, 3]", [&](File& file) { file.number_per_line("a", 2, fit, list); }),
            "c.toml:1: a: must be a number or \"fit\", or a list of 2 of these, has 3");
  EXPECT_EQ(message_after("a = 1", [&](File& file) { file.numbers("a", 2, list); }),
            "c.toml:1: a: must be a list of 2 numbers");
  EXPECT_EQ(message_after("a = \"x\"",
                          [&](File& file) {
                            file.choice("a", {"p", "q", "r"}, index);
                          }),
            "c.toml:1: a: must be \"p\", \"q\" or \"r\"");
}

TEST(ConfigFile, refuses_an_unknown_key_with_the_nearest_known) {
  double ohm = 0.0;
  const auto read = [&](ConfigFile& file) { file.number("readout.load_ohm", ohm); };
  EXPECT_EQ(message_after("[readout]\nload_ohms = 1", read),
            "c.toml:2: unknown key 'readout.load_ohms'; did you mean 'readout.load_ohm'?");
  EXPECT_EQ(message_after("[readout]\nwavelength = 1", read), "c.toml:2: unknown key 'readout.wavelength'");
  EXPECT_EQ(message_after("[readot]\nload_ohm = 1", read), "c.toml:1: unknown table 'readot'; did you mean 'readout'?");
  EXPECT_EQ(message_after("[[readout]]\nload_ohm = 1", read), "c.toml:1: unknown key 'readout'");
}

TEST(ConfigFile, names_the_first_unknown_key_of_the_file) {
  EXPECT_EQ(parse_message("zz = 1\naa = 2\n"), "c.toml:1: unknown key 'zz'");
}

TEST(ConfigFile, reports_an_unknown_key_before_a_missing_one) {
  const auto read = [](ConfigFile& file) { file.require("rows"); };
  EXPECT_EQ(message_after("", read), "c.toml: rows: is missing; it has no default");
  EXPECT_EQ(message_after("rowz = 1", read), "c.toml:1: unknown key 'rowz'; did you mean 'rows'?");
}

TEST(ConfigFile, keeps_the_first_error) {
  EXPECT_EQ(message_after("a = 1\nb = 2\n",
                          [](ConfigFile& file) {
                            file.fail("b", "is out of range");
                            file.fail("a", "is out of range");
                          }),
            "c.toml:2: b: is out of range");
}

TEST(ConfigFile, names_line_and_column_of_a_syntax_error) {
  const std::string message = parse_message("a = 1\nb = = 2\n");
  EXPECT_TRUE(message.starts_with("c.toml:2:5: ")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_TRUE(parse_message("a = 1\na = 2\n").starts_with("c.toml:2:"));
}

TEST(ConfigFile, keeps_messages_on_one_line) {
  EXPECT_EQ(parse_message("\"a\\nb\" = 1"), "c.toml:1: unknown key 'a?b'");
}

TEST(ConfigFile, refuses_keys_that_are_too_deep) {
  std::string deep = "a";
  for (int i = 0; i < 100'000; ++i) deep += ".a";
  EXPECT_EQ(parse_message("\n" + deep + " = 1"), "c.toml:2: too many dots in one line; break it");
  std::string quoted = "\"a b\"";
  for (int i = 0; i < 100'000; ++i) quoted += ".\"1.5\"";
  EXPECT_EQ(parse_message(quoted + " = 1"), "c.toml:1: too many dots in one line; break it");
}

TEST(ConfigFile, takes_long_lists_and_rulers_of_dots) {
  std::string list = "# " + std::string(200, '.') + "\na = [1.5";
  for (int i = 0; i < 1023; ++i) list += ", 1.5";
  std::vector<double> values;
  EXPECT_EQ(message_after(list + "]", [&](ConfigFile& file) { file.numbers("a", 1024, values); }), "ok");
}

TEST(ConfigFile, survives_the_deepest_file_it_takes) {
  std::string key = "a";
  for (int i = 0; i < 64; ++i) key += ".a.1.1";
  std::string nested;
  for (int i = 0; i < 1000; ++i) nested += "[\n{" + key + " = \n";
  EXPECT_NE(parse_message("a = " + nested), "ok");
  std::string dotted = "a";
  for (int i = 0; i < 64; ++i) dotted += ".a";
  std::string text = "a = ";
  std::string closing;
  for (int i = 0; i < 120; ++i) {
    text += "[\n{" + dotted + " = ";
    closing += "}]";
  }
  EXPECT_EQ(parse_message(text + "1" + closing), "c.toml:1: unknown key 'a'");
}

TEST(ConfigFile, refuses_more_than_a_mebibyte) {
  EXPECT_EQ(parse_message(std::string((1U << 20U) + 1, ' ')), "c.toml: is larger than 1 MiB");
}

TEST(ConfigFile, reads_a_file_and_names_one_that_cannot_be_opened) {
  const std::string path = testing::TempDir() + "config_table_test.toml";
  std::ofstream(path) << "a = 2\n";
  Result<ConfigFile> file = ConfigFile::read(path);
  ASSERT_TRUE(file);
  int value = 0;
  file->integer("a", value);
  EXPECT_EQ(value, 2);
  const Result<ConfigFile> missing = ConfigFile::read("/no/such/file");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(missing.error().message, "cannot open '/no/such/file': No such file or directory");
  EXPECT_FALSE(ConfigFile::read("/"));
}

TEST(ConfigFile, reads_a_list_of_tables_by_their_places) {
  std::vector<std::string> names;
  std::vector<double> sizes;
  const auto read = [&](ConfigFile& file) {
    for (std::size_t k = 0; k < file.table_count("part"); ++k) {
      const std::string key = "part[" + std::to_string(k) + "]";
      file.require(key + ".name");
      file.text(key + ".name", names.emplace_back());
      file.number(key + ".box.size", sizes.emplace_back());
    }
  };
  EXPECT_EQ(
      message_after("[[part]]\nname = \"a\"\nbox = {size = 2}\n[[part]]\nname = \"b\"\n[part.box]\nsize = 3\n", read),
      "ok");
  EXPECT_EQ(names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(sizes, (std::vector<double>{2.0, 3.0}));
  EXPECT_EQ(message_after("", read), "ok");
  EXPECT_EQ(message_after("[[part]]\nname = \"a\"\n[[part]]\nname = \"b\"\nnam = 1\n", read),
            "c.toml:5: unknown key 'part[1].nam'; did you mean 'part[1].name'?");
  EXPECT_EQ(message_after("[[part]]\nname = \"a\"\n[[part]]\n", read),
            "c.toml: part[1].name: is missing; it has no default");
  EXPECT_EQ(message_after("[[part]]\nname = 5\n", read), "c.toml:2: part[0].name: must be a text in quotes");
  EXPECT_EQ(message_after("[part]\nname = \"a\"\n", read),
            "c.toml:1: part: must be a list of tables, each begun by [[part]]");
  EXPECT_EQ(message_after("part = [1, 2]\n", read), "c.toml:1: part: must be a list of tables, each begun by [[part]]");
  EXPECT_EQ(message_after("[[parts]]\nname = \"a\"\n", read), "c.toml:1: unknown key 'parts'; did you mean 'part'?");
}

TEST(ConfigFile, reads_lists_of_lists_of_numbers) {
  std::vector<std::vector<double>> rows;
  const auto read = [&](ConfigFile& file) { file.number_rows("a", 2, rows); };
  EXPECT_EQ(message_after("a = [[1, 2.5], [3, 4]]\n", read), "ok");
  EXPECT_EQ(rows, (std::vector<std::vector<double>>{{1.0, 2.5}, {3.0, 4.0}}));
  constexpr const char* kWanted = "c.toml:1: a: must be a list of lists of 2 numbers";
  EXPECT_EQ(message_after("a = [[1, 2], [3]]\n", read), kWanted);
  EXPECT_EQ(message_after("a = [1, 2]\n", read), kWanted);
  EXPECT_EQ(message_after("a = [[1, nan]]\n", read), kWanted);
  EXPECT_EQ(message_after("a = 1\n", read), kWanted);
}

TEST(ConfigFile, tells_a_text_from_a_list) {
  bool is_text = false;
  const auto read = [&](ConfigFile& file) { is_text = file.holds_text("a"); };
  EXPECT_EQ(message_after("a = \"x\"\n", read), "ok");
  EXPECT_TRUE(is_text);
  EXPECT_EQ(message_after("a = [1]\n", read), "ok");
  EXPECT_FALSE(is_text);
  EXPECT_EQ(message_after("", read), "ok");
  EXPECT_FALSE(is_text);
}

}  // namespace
}  // namespace dermis::bytes::files
