// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/safetensors.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <regex>

#include "support/mutations.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

SafetensorsFile example() {
  SafetensorsFile file;
  file.metadata = {{"format", "dermis"}, {"note", "two\nlines \"quoted\""}};
  file.tensors["bytes"] = {{3}, std::vector<std::uint8_t>{1, 2, 255}};
  file.tensors["weights"] = {{2, 2}, std::vector<float>{1.5F, -2.0F, 0.25F, 4.0F}};
  file.tensors["scale"] = {{}, std::vector<double>{0.1}};
  file.tensors["counts"] = {{1, 2}, std::vector<std::int64_t>{-1, 9007199254740993}};
  file.tensors["none"] = {{0, 5}, std::vector<float>{}};
  return file;
}

/// The bytes of a file with this header.
std::string bytes_with(const std::string& header, const std::string& data) {
  const std::uint64_t length = header.size();
  std::string bytes(sizeof(length), '\0');
  std::memcpy(bytes.data(), &length, sizeof(length));
  return bytes + header + data;
}

std::string error_of_bytes(const std::string& bytes) {
  const Result<SafetensorsFile> file = safetensors_from_bytes(bytes, "m.safetensors");
  if (file) return "no error";
  EXPECT_EQ(file.error().kind, ErrorKind::bad_input);
  return file.error().message;
}

std::string error_of(const std::string& header, std::size_t data_bytes = 8) {
  return error_of_bytes(bytes_with(header, std::string(data_bytes, '\0')));
}

std::string written_bytes(const SafetensorsFile& file) {
  const support::TemporaryFolder folder;
  EXPECT_TRUE(write_safetensors(folder.file("m"), file));
  return support::read_bytes(folder.file("m"));
}

TEST(Safetensors, reads_back_what_was_written) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_safetensors(folder.file("m"), example()));
  const Result<SafetensorsFile> read = read_safetensors(folder.file("m"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, example());
}

TEST(Safetensors, reads_back_an_empty_file) {
  const Result<SafetensorsFile> read = safetensors_from_bytes(written_bytes({}), "m");
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, SafetensorsFile{});
}

TEST(Safetensors, writes_the_same_bytes_for_the_same_content) {
  EXPECT_EQ(written_bytes(example()), written_bytes(example()));
}

TEST(Safetensors, agrees_with_an_independent_reader) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_safetensors(folder.file("m"), example()));
  const std::filesystem::path script = support::project_folder() / "tests/bytes/files/read_safetensors.py";
  const std::string command = "/usr/bin/python3 '" + script.string() + "' '" + folder.file("m") + "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(::popen(command.c_str(), "r"), &::pclose);
  ASSERT_NE(output, nullptr);
  std::string text(4096, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), output.get()));
  text = std::regex_replace(text, std::regex(R"("checksum":"fnv1a64:[0-9a-f]{16}",)"), "\"checksum\":\"...\",");
  EXPECT_EQ(text, R"({"metadata":{"checksum":"...","format":"dermis","note":"two\nlines \"quoted\""},"tensors":{)"
                  R"("bytes":{"dtype":"U8","shape":[3],"values":[1,2,255]},)"
                  R"("counts":{"dtype":"I64","shape":[1,2],"values":[-1,9007199254740993]},)"
                  R"("none":{"dtype":"F32","shape":[0,5],"values":[]},)"
                  R"("scale":{"dtype":"F64","shape":[],"values":[0.1]},)"
                  R"("weights":{"dtype":"F32","shape":[2,2],"values":[1.5,-2.0,0.25,4.0]}}})"
                  "\n");
}

TEST(Safetensors, gives_a_view_of_a_tensor_of_the_expected_shape_and_type) {
  const SafetensorsFile file = example();
  const auto weights = file.view<float>("weights", {2, 2});
  ASSERT_TRUE(weights);
  EXPECT_EQ((*weights)[1], -2.0F);
  const auto missing = file.view<float>("bias", {2});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, "tensor 'bias' is missing");
  const auto other_shape = file.view<float>("weights", {4});
  ASSERT_FALSE(other_shape);
  EXPECT_EQ(other_shape.error().message, "tensor 'weights' is F32 [2, 2], expected F32 [4]");
  const auto other_type = file.view<double>("weights", {2, 2});
  ASSERT_FALSE(other_type);
  EXPECT_EQ(other_type.error().message, "tensor 'weights' is F32 [2, 2], expected F64 [2, 2]");
}

TEST(Safetensors, copies_tensors_out_and_keeps_the_first_error) {
  SafetensorsFile file;
  put_tensor(file, "weights", {2, 1}, std::vector<float>{1.5F, -2.0F});
  TensorReader reader(file);
  std::vector<float> weights;
  reader.get("weights", {2, 1}, weights);
  EXPECT_EQ(weights, (std::vector<float>{1.5F, -2.0F}));
  EXPECT_FALSE(reader.first_error());
  std::vector<double> other{7.0};
  reader.get("missing", {1}, other);
  reader.get("weights", {3}, weights);
  EXPECT_EQ(other, std::vector<double>{7.0});
  ASSERT_TRUE(reader.first_error());
  EXPECT_NE(reader.first_error()->message.find("missing"), std::string::npos);
}

TEST(Safetensors, the_beginning_and_large_tensors_are_what_is_written_at_once) {
  const support::TemporaryFolder folder;
  SafetensorsFile first;
  first.metadata["format"] = "test";
  put_tensor(first, "zeros", {2}, std::vector<double>{0.5, 2.0});
  put_tensor(first, "counts", {1}, std::vector<std::int64_t>{7});
  SafetensorsFile whole = first;
  const std::vector<float> rows = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F};
  put_tensor(whole, "a", {3, 2}, rows);
  put_tensor(whole, "b", {3, 2}, rows);
  ASSERT_TRUE(write_safetensors(folder.file("whole"), whole));

  const SafetensorsBeginning beginning = begin_safetensors(first, {"a", "b"}, {3, 2});
  const std::string_view row_bytes(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(float));
  ContentHash hash = beginning.hash;
  hash.add(std::string_view(beginning.bytes).substr(beginning.header_bytes));
  hash.add(row_bytes);
  hash.add(row_bytes);
  std::string bytes = beginning.bytes;
  bytes.replace(beginning.checksum, hash.text().size(), hash.text());
  EXPECT_EQ(bytes.append(row_bytes).append(row_bytes), support::read_bytes(folder.file("whole")));
}

TEST(Safetensors, refuses_every_file_cut_short) {
  const std::string bytes = written_bytes(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string message = error_of_bytes(bytes.substr(0, size));
    EXPECT_TRUE(message.starts_with("m.safetensors: is cut short: ")) << size << ": " << message;
  }
}

TEST(Safetensors, says_where_a_file_is_cut_short) {
  EXPECT_EQ(error_of_bytes("1234"), "m.safetensors: is cut short: has 4 bytes, fewer than the length of a header");
  EXPECT_EQ(error_of_bytes(bytes_with("{     }", "").substr(0, 13)),
            "m.safetensors: is cut short: its header has 7 bytes, the file only 5 after the length");
  EXPECT_EQ(error_of(R"({"x":{"dtype":"F64","shape":[2],"data_offsets":[0,16]}})"),
            "m.safetensors: is cut short: tensor 'x' ends at byte 16 of the data, which has 8");
}

TEST(Safetensors, refuses_a_huge_header) {
  EXPECT_EQ(error_of_bytes(std::string(100, '\x7F')),
            "m.safetensors: has a header of 9187201950435737471 bytes, at most 4194304 can be read; it is no "
            "safetensors file or is damaged");
}

TEST(Safetensors, refuses_a_header_that_is_no_object) {
  EXPECT_EQ(error_of("{x"), "m.safetensors: its header is not JSON; it is no safetensors file or is damaged");
  EXPECT_EQ(error_of("\"\xFF\""), "m.safetensors: its header is not JSON; it is no safetensors file or is damaged");
  EXPECT_EQ(error_of(std::string("{}\0", 3)),
            "m.safetensors: its header is not JSON; it is no safetensors file or is damaged");
  EXPECT_EQ(error_of("[1]"), "m.safetensors: its header is not a JSON object");
  EXPECT_EQ(error_of(std::string(100'000, '[')), "m.safetensors: its header is nested too deeply");
  EXPECT_EQ(error_of(R"({"x":[[{"y":1}]]})"), "m.safetensors: its header is nested too deeply");
}

TEST(Safetensors, refuses_names_that_stand_twice) {
  EXPECT_EQ(error_of(R"({"x":1,"x":2})"), "m.safetensors: its header names 'x' twice");
  EXPECT_EQ(error_of(R"({"__metadata__":{"a":"1","a":"2"}})"), "m.safetensors: its header names 'a' twice");
  EXPECT_TRUE(safetensors_from_bytes(bytes_with(R"({"a":{"dtype":"U8","shape":[1],"data_offsets":[0,1]},)"
                                                R"("b":{"dtype":"U8","shape":[1],"data_offsets":[1,2]}})",
                                                "ab"),
                                     "m"));
}

TEST(Safetensors, refuses_metadata_that_is_no_text) {
  EXPECT_EQ(error_of(R"({"__metadata__":[]})"), "m.safetensors: __metadata__ is not an object");
  EXPECT_EQ(error_of(R"({"__metadata__":{"a":1}})"), "m.safetensors: __metadata__ 'a' is not a text");
}

TEST(Safetensors, refuses_an_incomplete_entry) {
  EXPECT_EQ(error_of(R"({"x":1})"), "m.safetensors: tensor 'x' is not described by an object");
  EXPECT_EQ(error_of(R"({"x":{}})"), "m.safetensors: tensor 'x' has no dtype");
  EXPECT_EQ(error_of(R"({"x":{"dtype":"BF16"}})"),
            "m.safetensors: tensor 'x' has type 'BF16'; F32, F64, U8 and I64 can be read");
  for (const std::string shape : {"null", "[-1]", "[1.5]", "[\"1\"]", "[18446744073709551616]"}) {
    EXPECT_EQ(error_of(R"({"x":{"dtype":"F32","shape":)" + shape + "}}"),
              "m.safetensors: tensor 'x' has no shape of whole numbers");
  }
  for (const std::string offsets : {"null", "[0]", "[8,0]", "[0,4,8]"}) {
    EXPECT_EQ(error_of(R"({"x":{"dtype":"F32","shape":[2],"data_offsets":)" + offsets + "}}"),
              "m.safetensors: tensor 'x' has no data_offsets [begin, end]");
  }
}

TEST(Safetensors, refuses_a_shape_that_does_not_fit_its_bytes) {
  EXPECT_EQ(error_of(R"({"x":{"dtype":"F32","shape":[3],"data_offsets":[0,8]}})"),
            "m.safetensors: tensor 'x' has 8 bytes, which do not fit F32 [3]");
  EXPECT_EQ(error_of(R"({"x":{"dtype":"F64","shape":[1],"data_offsets":[0,7]}})"),
            "m.safetensors: tensor 'x' has 7 bytes, which do not fit F64 [1]");
  EXPECT_EQ(error_of(R"({"x":{"dtype":"F64","shape":[4294967296,4294967296],"data_offsets":[0,0]}})"),
            "m.safetensors: tensor 'x' has 0 bytes, which do not fit F64 [4294967296, 4294967296]");
}

TEST(Safetensors, refuses_gaps_overlaps_and_bytes_left_over) {
  const std::string x = R"({"x":{"dtype":"U8","shape":[4],"data_offsets":[0,4]},)";
  EXPECT_EQ(error_of(x + R"("y":{"dtype":"U8","shape":[5],"data_offsets":[3,8]}})"),
            "m.safetensors: tensor 'y' begins at byte 3 of the data, not at 4 where the one before it ends");
  EXPECT_EQ(error_of(x + R"("y":{"dtype":"U8","shape":[3],"data_offsets":[5,8]}})"),
            "m.safetensors: tensor 'y' begins at byte 5 of the data, not at 4 where the one before it ends");
  EXPECT_EQ(error_of(x + R"("y":{"dtype":"U8","shape":[2],"data_offsets":[4,6]}})"),
            "m.safetensors: has 2 bytes after the last tensor");
}

TEST(Safetensors, leaves_the_old_file_where_the_new_one_cannot_be_written) {
  const Status written = write_safetensors("/no/such/folder/m", example());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "cannot write '/no/such/folder/m': No such file or directory");
  const Status full = write_safetensors("/dev/full", example());
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().message, "cannot write '/dev/full': No space left on device");
}

TEST(Safetensors, refuses_a_file_in_which_any_bit_was_flipped) {
  const std::string bytes = written_bytes(example());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(static_cast<unsigned char>(flipped[bit / 8]) ^ (1U << bit % 8));
    const Result<SafetensorsFile> read = safetensors_from_bytes(flipped, "m");
    // A key that is no longer "checksum" leaves a file without one, which check_format() refuses.
    EXPECT_FALSE(read && read->has_checksum) << bit;
  }
}

TEST(Safetensors, refuses_a_file_whose_tensors_were_exchanged) {
  SafetensorsFile file;
  put_tensor(file, "a", {2}, std::vector<float>{1.0F, 2.0F});
  put_tensor(file, "b", {2}, std::vector<float>{3.0F, 4.0F});
  std::string bytes = written_bytes(file);
  ASSERT_TRUE(safetensors_from_bytes(bytes, "m"));
  std::swap_ranges(bytes.end() - 8, bytes.end(), bytes.end() - 16);
  EXPECT_EQ(error_of_bytes(bytes),
            "m.safetensors: is damaged: its checksum differs; restore it from a copy, or make it again");
}

TEST(Safetensors, takes_the_same_content_in_other_words) {
  const std::string bytes = written_bytes(example());
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof(length));
  const std::string header = "  " + bytes.substr(sizeof(length), length);
  const Result<SafetensorsFile> read =
      safetensors_from_bytes(bytes_with(header, bytes.substr(sizeof(length) + length)), "m");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->has_checksum);
}

constexpr FileFormat kFormat{"f 2", "f 1", "is no f"};

TEST(Safetensors, a_file_of_before_there_were_checksums_is_read_and_noted) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("old"), bytes_with(R"({"__metadata__":{"format":"f 1"}})", ""));
  const Result<SafetensorsFile> old = read_safetensors(folder.file("old"));
  ASSERT_TRUE(old);
  EXPECT_FALSE(old->has_checksum);
  EXPECT_EQ(checksum_note(folder.file("old"), kFormat).value_or(""),
            folder.file("old") + ": is of an older dermis and has no checksum, so damage to it would not show");
  ASSERT_TRUE(write_safetensors(folder.file("new"), *old));
  EXPECT_TRUE(read_safetensors(folder.file("new"))->has_checksum);
  EXPECT_FALSE(checksum_note(folder.file("new"), kFormat));
  EXPECT_FALSE(checksum_note(folder.file("absent"), kFormat));
  for (const char* const other : {"f 2", "f 3"}) {
    support::write_bytes(folder.file("other"),
                         bytes_with(fmt::format(R"({{"__metadata__":{{"format":"{}"}}}})", other), ""));
    EXPECT_FALSE(checksum_note(folder.file("other"), kFormat)) << other;
  }
}

TEST(Safetensors, a_file_of_a_format_with_a_checksum_must_not_have_lost_it) {
  const auto verdict = [&](const char* format, bool has_checksum) {
    SafetensorsFile file;
    file.metadata["format"] = format;
    file.has_checksum = has_checksum;
    const Status right = check_format(file, kFormat);
    return right ? "" : right.error().message;
  };
  EXPECT_EQ(verdict("f 2", true), "");
  EXPECT_EQ(verdict("f 1", false), "");
  EXPECT_EQ(verdict("f 2", false), "is damaged: it has lost its checksum; restore it from a copy, or make it again");
  EXPECT_EQ(verdict("f 3", true), "is no f");
  EXPECT_EQ(check_format(SafetensorsFile{}, kFormat).error().message, "is no f");
}

TEST(Safetensors, gives_a_value_or_a_one_line_error_for_mutations) {
  support::expect_value_or_one_line_error(written_bytes(example()), 5000, [](const std::string& bytes) {
    return safetensors_from_bytes(bytes, "mutated");
  });
}

}  // namespace
}  // namespace dermis::bytes::files
