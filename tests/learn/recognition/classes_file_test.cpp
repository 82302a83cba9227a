// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/classes_file.hpp"

#include <gtest/gtest.h>

#include "dermis/bytes/files/safetensors.hpp"
#include "small_classes.hpp"
#include "support/mutations.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::learn::recognition {
namespace {

using dermis::support::TemporaryFolder;

std::string error_of(const std::string& path) {
  const Result<Classes> classes = read_classes(path);
  if (classes) return "no error";
  EXPECT_EQ(classes.error().kind, ErrorKind::bad_input);
  return classes.error().message;
}

TEST(ClassesFile, reads_back_what_was_written) {
  const TemporaryFolder folder;
  Classes classes = support::small_classes();
  classes.layout.arrays[0].name = "two words, \"quoted\" \xC3\xA4";
  for (const Quantity quantity : {Quantity::counts, Quantity::pressure, Quantity::force}) {
    classes.layout.quantity = quantity;
    ASSERT_TRUE(write_classes(folder.file("c"), classes));
    const Result<Classes> read = read_classes(folder.file("c"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, classes);
  }
}

/// Small classes whose description has `text` in the place of what says that they are of forces.
std::string with_quantity(const TemporaryFolder& folder, const std::string& text) {
  Classes classes = support::small_classes();
  classes.layout.quantity = Quantity::force;
  EXPECT_TRUE(write_classes(folder.file("q"), classes));
  Result<bytes::files::SafetensorsFile> file = bytes::files::read_safetensors(folder.file("q"));
  EXPECT_TRUE(file);
  std::string& description = file->metadata["classes"];
  const std::string key = R"("quantity":"force",)";
  const std::size_t place = description.find(key);
  EXPECT_NE(place, std::string::npos) << description;
  description.replace(place, key.size(), text);
  EXPECT_TRUE(bytes::files::write_safetensors(folder.file("q"), *file));
  return folder.file("q");
}

TEST(ClassesFile, of_before_its_quantity_was_written_is_of_forces_by_its_least_reading) {
  const TemporaryFolder folder;
  const Result<Classes> of_forces = read_classes(with_quantity(folder, ""));
  ASSERT_TRUE(of_forces) << of_forces.error().message;
  EXPECT_TRUE(of_forces->layout.has_forces());
}

TEST(ClassesFile, of_a_quantity_that_there_is_not_is_damaged) {
  const TemporaryFolder folder;
  for (const char* const text : {R"("quantity":"torque",)", R"("quantity":2,)"}) {
    EXPECT_NE(error_of(with_quantity(folder, text)).find("is damaged"), std::string::npos) << text;
  }
}

TEST(ClassesFile, gives_the_same_bytes_for_the_same_classes) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_classes(folder.file("a"), support::small_classes()));
  ASSERT_TRUE(write_classes(folder.file("b"), support::small_classes()));
  EXPECT_EQ(dermis::support::read_bytes(folder.file("a")), dermis::support::read_bytes(folder.file("b")));
}

TEST(ClassesFile, writes_no_classes_that_are_not_valid) {
  const TemporaryFolder folder;
  Classes classes = support::small_classes();
  classes.names.clear();
  EXPECT_FALSE(write_classes(folder.file("c"), classes));
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(ClassesFile, names_a_file_that_holds_something_else) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of(folder.file("absent")).find("absent"), std::string::npos);
  ASSERT_TRUE(bytes::files::write_safetensors(folder.file("m"), {{{"format", "dermis model 3"}}, {}}));
  EXPECT_EQ(error_of(folder.file("m")), folder.file("m") + ": holds no classes; learning writes them");
}

TEST(ClassesFile, names_a_description_that_is_damaged) {
  const TemporaryFolder folder;
  for (const char* const text : {"", "[]", "{", "{}", R"({"layout":[],"names":{},"experts":3})", "null",
                                 R"({"names":["a","b"],"experts":[{"columns":18446744073709551615}]})"}) {
    ASSERT_TRUE(
        bytes::files::write_safetensors(folder.file("m"), {{{"format", "dermis classes 1"}, {"classes", text}}, {}}));
    EXPECT_EQ(error_of(folder.file("m")),
              folder.file("m") + ": its description of the classes is damaged; learn them again")
        << text;
  }
}

TEST(ClassesFile, names_a_table_that_is_missing) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_classes(folder.file("c"), support::small_classes()));
  Result<bytes::files::SafetensorsFile> file = bytes::files::read_safetensors(folder.file("c"));
  ASSERT_TRUE(file);
  file->tensors.erase("expert.1.axes");
  ASSERT_TRUE(bytes::files::write_safetensors(folder.file("c"), *file));
  EXPECT_EQ(error_of(folder.file("c")), folder.file("c") + ": tensor 'expert.1.axes' is missing");
}

TEST(ClassesFile, that_was_damaged_anywhere_gives_classes_or_one_line) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_classes(folder.file("c"), support::small_classes()));
  // The second has no checksum, so that more than damage as such is found.
  const std::string old = (dermis::support::project_folder() / "fuzz/seeds/classes/two_poses.safetensors").string();
  for (const std::string& path : {folder.file("c"), old}) {
    EXPECT_TRUE(read_classes(path)) << path;
    dermis::support::expect_value_or_one_line_error(
        dermis::support::read_bytes(path), 200,
        [](const std::string& bytes) { return classes_from_bytes(bytes, "mutated"); });
  }
}

}  // namespace
}  // namespace dermis::learn::recognition
