// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

std::string little_endian(std::uint64_t number, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(i < 8 ? number >> (8 * i) & 0xFFU : 0U);
  return bytes;
}

std::string npy(const std::string& shape, const std::string& data) {
  const std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': " + shape + ", }\n";
  return std::string("\x93NUMPY\1\0", 8) + little_endian(header.size(), 2) + header + data;
}

std::string deflated(const std::string& bytes) {
  std::string packed(bytes.size() + 100, '\0');
  z_stream state{};
  EXPECT_EQ(deflateInit2(&state, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string source = bytes;
  state.next_in = reinterpret_cast<Bytef*>(source.data());
  state.avail_in = static_cast<uInt>(source.size());
  state.next_out = reinterpret_cast<Bytef*>(packed.data());
  state.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&state, Z_FINISH), Z_STREAM_END);
  packed.resize(state.total_out);
  deflateEnd(&state);
  return packed;
}

/// An archive by hand, after the specification.
class Zip {
 public:
  Zip& add(const std::string& name, const std::string& bytes, int method, bool is_zip64 = false) {
    const std::string data = method == 8 ? deflated(bytes) : bytes;
    const std::uint64_t offset = files_.size();
    const std::string field64 = little_endian(1, 2) + little_endian(16, 2) + little_endian(bytes.size(), 8);
    const std::string field = is_zip64 ? field64 + little_endian(data.size(), 8) : "";
    const std::string sizes =
        is_zip64 ? little_endian(~0ULL, 8) : little_endian(data.size(), 4) + little_endian(bytes.size(), 4);
    const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
    const std::string common = little_endian(20, 2) + little_endian(0, 2) +
                               little_endian(static_cast<unsigned>(method), 2) + little_endian(0, 4) +
                               little_endian(checksum, 4) + sizes + little_endian(name.size(), 2) +
                               little_endian(field.size(), 2);
    files_ += "PK\3\4" + common + name + field + data;
    list_ += "PK\1\2" + little_endian(20, 2) + common + little_endian(0, 10) + little_endian(offset, 4) + name + field;
    ++count_;
    return *this;
  }

  [[nodiscard]] std::string bytes() const {
    return files_ + list_ + "PK\5\6" + little_endian(0, 4) + little_endian(count_, 2) + little_endian(count_, 2) +
           little_endian(list_.size(), 4) + little_endian(files_.size(), 4) + little_endian(0, 2);
  }

 private:
  std::string files_;
  std::string list_;
  unsigned count_ = 0;
};

const std::string kArray = npy("(2, 1, 2)", "abcd");
const Frames kCounts = {{97, 98}, {99, 100}};

TEST(Npz, reads_an_array_that_is_stored_or_deflated) {
  Importer importer(open_npz, {.rate_hz = 10.0});
  for (const int method : {0, 8}) {
    for (const bool is_zip64 : {false, true}) {
      EXPECT_EQ(importer.counts(Zip().add("arr_0.npy", kArray, method, is_zip64).bytes()), kCounts)
          << method << is_zip64;
    }
  }
  EXPECT_EQ(importer.seconds(Zip().add("arr_0.npy", kArray, 0).bytes()), (std::vector<double>{0.0, 0.1}));
}

TEST(Npz, reads_the_one_that_is_named) {
  const std::string bytes = Zip().add("labels.npy", npy("(1,)", "x"), 8).add("frames.npy", kArray, 8).bytes();
  EXPECT_EQ(Importer(open_npz, {.rate_hz = 10.0, .array = "frames"}).counts(bytes), kCounts);
  EXPECT_EQ(Importer(open_npz, {.rate_hz = 10.0}).error(bytes),
            "f: name one, as 'f#labels'; it has: 'labels', 'frames'");
  EXPECT_EQ(Importer(open_npz, {.rate_hz = 10.0, .array = "noise"}).error(bytes),
            "f: has no array 'noise', as 'f#labels'; it has: 'labels', 'frames'");
  EXPECT_EQ(Importer(open_npz, {.rate_hz = 10.0, .array = "labels"}).error(bytes),
            "f#labels: has 1 dimensions; frames x rows x cols is expected");
}

TEST(Npz, reads_large_arrays_piece_by_piece) {
  std::string data;
  for (std::uint64_t i = 0; i < 300000; ++i) data += static_cast<char>(i * i % 251);
  const auto frames =
      Importer(open_npz, {.rate_hz = 10.0}).counts(Zip().add("a.npy", npy("(300, 10, 100)", data), 8).bytes());
  ASSERT_EQ(frames.size(), 300U);
  EXPECT_EQ(frames[299][999], static_cast<float>(static_cast<unsigned char>(data.back())));
}

TEST(Npz, names_what_is_wrong) {
  Importer importer(open_npz, {.rate_hz = 10.0});
  const std::string whole = Zip().add("a.npy", kArray, 8).bytes();
  EXPECT_EQ(importer.error(""), "f: holds no array");
  EXPECT_EQ(importer.error(whole.substr(0, whole.size() - 1)), "f: cannot be read as a zip archive: Not a zip archive");
  EXPECT_EQ(importer.error(Zip().bytes()), "f: holds no array");
  EXPECT_EQ(importer.error(Zip().add("a.npy", kArray, 97).bytes()),
            "f: 'a.npy' in it cannot be read: Compression method not supported");
  EXPECT_EQ(importer.error(Zip().add("a.npy", npy("(2, 1, 2)", "abc"), 8).bytes()),
            "f: is cut short in frame 1 of 2; save it again");
}

TEST(Npz, tells_readings_that_are_damaged) {
  Importer importer(open_npz, {.rate_hz = 10.0});
  for (const std::string& data : {std::string("abcd"), std::string(300'000, 'x') + "abcd"}) {
    std::string bytes = Zip().add("a.npy", npy("(" + std::to_string(data.size() / 2) + ", 1, 2)", data), 0).bytes();
    bytes[bytes.find("abcd")] = 'b';
    EXPECT_EQ(importer.error(bytes), "f: is damaged: CRC error; save it again");
  }
}

TEST(Npz, tells_a_file_that_cannot_be_read) {
  std::string bytes = Zip().add("a.npy", kArray, 0).bytes();
  constexpr std::size_t kSizeInList = 20;
  bytes.replace(bytes.find("PK\1\2") + kSizeInList, 4, little_endian(1'000'000, 4));  // beyond the end
  EXPECT_EQ(Importer(open_npz, {.rate_hz = 10.0}).fault(bytes, BadFile::Fault::read).message,
            "cannot read 'f': Input/output error");
}

TEST(Npz, gives_a_value_or_a_one_line_error_for_mutations) {
  Importer importer(open_npz, {.rate_hz = 10.0});
  importer.expect_value_or_one_line_error(Zip().add("a.npy", kArray, 8, true).bytes(), 10000);
  importer.expect_value_or_one_line_error(Zip().add("a.npy", kArray, 0).bytes(), 10000);
}

}  // namespace
}  // namespace dermis::bytes::formats
