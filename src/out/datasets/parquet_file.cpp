// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/parquet_file.hpp"

#include <bit>
#include <cerrno>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

#include "dermis/bytes/files/output_place.hpp"
#include "dermis/touch/frames/version.hpp"
#include "out/datasets/compact_thrift.hpp"
#include "out/datasets/in_parallel.hpp"
#include "out/datasets/zstd.hpp"

// Numbers of https://github.com/apache/parquet-format: parquet.thrift, and Encodings.md for the levels.
namespace dermis::out::datasets {
namespace {

constexpr std::string_view kMagic = "PAR1";
constexpr std::int32_t kRequired = 0;
constexpr std::int32_t kRepeated = 2;
constexpr std::int32_t kUtf8 = 0;  // converted types
constexpr std::int32_t kList = 3;
constexpr std::int32_t kPlain = 0;  // encodings
constexpr std::int32_t kRunLengths = 3;
constexpr std::int32_t kZstd = 6;  // codec
constexpr std::int32_t kDataPage = 0;
constexpr unsigned kBitsOfByte = 8;

std::int32_t number_of(ParquetType type) {
  switch (type) {
    case ParquetType::boolean: return 0;
    case ParquetType::int64: return 2;
    case ParquetType::float32: return 4;
    case ParquetType::float64: return 5;
    case ParquetType::text: break;
  }
  return 6;
}

std::size_t elements_of(const ParquetColumn& column) {
  return std::accumulate(column.shape.begin(), column.shape.end(), std::size_t{1}, std::multiplies<>());
}

/// Little-endian, as all machines are that this is built for.
std::string four_bytes(std::size_t number) {
  static_assert(std::endian::native == std::endian::little);
  const auto narrow = static_cast<std::uint32_t>(number);
  std::string bytes(sizeof narrow, '\0');
  std::memcpy(bytes.data(), &narrow, sizeof narrow);
  return bytes;
}

/// `count` times the same level.
void put_run(std::size_t count, std::size_t level, std::string& levels) {
  for (count <<= 1U; count >= 0x80; count >>= 7U) levels.push_back(static_cast<char>(count | 0x80U));
  levels.push_back(static_cast<char>(count));
  levels.push_back(static_cast<char>(level));
}

/// Repetition levels of one row: 0 where the row begins, else at which depth a list goes on.
std::string row_levels(const std::vector<std::size_t>& shape) {
  std::string levels;
  std::size_t waiting = 0;  // of the deepest level
  const std::size_t count = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t depth = shape.size();
    for (std::size_t index = k; depth > 0 && index % shape[depth - 1] == 0; index /= shape[--depth]) {
    }
    if (depth == shape.size()) {
      ++waiting;
      continue;
    }
    if (waiting > 0) put_run(std::exchange(waiting, 0), shape.size(), levels);
    put_run(1, depth, levels);
  }
  if (waiting > 0) put_run(waiting, shape.size(), levels);
  return levels;
}

std::string packed_bits(std::span<const std::byte> flags) {
  std::string bits((flags.size() + kBitsOfByte - 1) / kBitsOfByte, '\0');
  for (std::size_t k = 0; k < flags.size(); ++k) {
    if (flags[k] == std::byte{0}) continue;
    char& byte = bits[k / kBitsOfByte];
    byte = static_cast<char>(static_cast<unsigned>(byte) | (1U << (k % kBitsOfByte)));
  }
  return bits;
}

/// A list is a group of a repeated group of its elements.
void describe_list(CompactThrift& thrift, const std::string& name) {
  thrift.begin_element();
  thrift.field(3, kRequired);
  thrift.field(4, name);
  thrift.field(5, 1);
  thrift.field(6, kList);
  thrift.end_structure();
  thrift.begin_element();
  thrift.field(3, kRepeated);
  thrift.field(4, "list");
  thrift.field(5, 1);
  thrift.end_structure();
}

void describe(CompactThrift& thrift, const ParquetColumn& column) {
  std::string name = column.name;
  for (std::size_t depth = 0; depth < column.shape.size(); ++depth)
    describe_list(thrift, std::exchange(name, "element"));
  thrift.begin_element();
  thrift.field(1, number_of(column.type));
  thrift.field(3, kRequired);
  thrift.field(4, name);
  if (column.type == ParquetType::text) thrift.field(6, kUtf8);
  thrift.end_structure();
}

}  // namespace

std::string plain_text(std::string_view text) {
  return four_bytes(text.size()) + std::string(text);
}

Result<std::unique_ptr<ParquetFile>> ParquetFile::create(const std::string& path, std::vector<ParquetColumn> columns) {
  std::ofstream file(path, std::ios::binary);
  if (!file) return bytes::files::cannot_write(path, errno);
  std::unique_ptr<ParquetFile> parquet(new ParquetFile(path, std::move(file), std::move(columns)));
  if (Status begun = parquet->put(kMagic); !begun) return begun.error();
  return parquet;
}

ParquetFile::ParquetFile(std::string path, std::ofstream file, std::vector<ParquetColumn> columns)
    : path_(std::move(path)), file_(std::move(file)), columns_(std::move(columns)), chunks_(columns_.size()) {
  for (const ParquetColumn& column : columns_) row_levels_.push_back(row_levels(column.shape));
}

Status ParquetFile::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  offset_ += bytes.size();
  if (!file_) return bytes::files::cannot_write(path_, errno);
  return Done{};
}

void ParquetFile::write(std::size_t rows, std::span<const std::span<const std::byte>> values) {
  rows_ += static_cast<std::int64_t>(rows);
  in_parallel(columns_.size(), [&](std::size_t column) { add_page(column, rows, values[column]); });
}

void ParquetFile::add_page(std::size_t column, std::size_t rows, std::span<const std::byte> values) {
  const std::vector<std::size_t>& shape = columns_[column].shape;
  const std::size_t count = rows * elements_of(columns_[column]);
  std::string page;
  if (!shape.empty()) {
    std::string repetitions;
    for (std::size_t row = 0; row < rows; ++row) repetitions += row_levels_[column];
    std::string definitions;
    put_run(count, shape.size(), definitions);
    page = four_bytes(repetitions.size()) + repetitions + four_bytes(definitions.size()) + definitions;
  }
  if (columns_[column].type == ParquetType::boolean) {
    page += packed_bits(values);
  } else {
    page.append(reinterpret_cast<const char*>(values.data()), values.size());
  }
  const std::string packed = zstd_compressed(std::as_bytes(std::span(page)));
  CompactThrift header;
  header.field(1, kDataPage);
  header.field(2, static_cast<std::int32_t>(page.size()));
  header.field(3, static_cast<std::int32_t>(packed.size()));
  header.begin_structure(5);
  header.field(1, static_cast<std::int32_t>(count));
  header.field(2, kPlain);
  header.field(3, kRunLengths);
  header.field(4, kRunLengths);
  header.end_structure();
  Chunk& chunk = chunks_[column];
  chunk.pages += header.bytes() + '\0' + packed;  // the structure ends
  chunk.values += static_cast<std::int64_t>(count);
  chunk.unpacked_bytes += static_cast<std::int64_t>(header.bytes().size() + 1 + page.size());
}

std::size_t ParquetFile::waiting_bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Chunk& chunk : chunks_) bytes += chunk.pages.size();
  return bytes;
}

Status ParquetFile::end_row_group() {
  if (rows_ == 0) return Done{};
  RowGroup group{std::exchange(rows_, 0), {}};
  for (Chunk& chunk : chunks_) {
    group.chunks.push_back({chunk.values, chunk.unpacked_bytes, static_cast<std::int64_t>(offset_),
                            static_cast<std::int64_t>(chunk.pages.size())});
    if (Status written = put(chunk.pages); !written) return written;
    chunk.pages.clear();
    chunk.values = chunk.unpacked_bytes = 0;
  }
  groups_.push_back(std::move(group));
  return Done{};
}

std::string ParquetFile::footer(const std::map<std::string, std::string>& notes) const {
  std::size_t elements = 1;
  for (const ParquetColumn& column : columns_) elements += 1 + 2 * column.shape.size();
  CompactThrift thrift;
  thrift.field(1, std::int32_t{2});  // the version of the format
  thrift.begin_list(2, CompactThrift::Type::structure, elements);
  thrift.begin_element();
  thrift.field(4, "schema");
  thrift.field(5, static_cast<std::int32_t>(columns_.size()));
  thrift.end_structure();
  for (const ParquetColumn& column : columns_) describe(thrift, column);
  std::int64_t rows = 0;
  for (const RowGroup& group : groups_) rows += group.rows;
  thrift.field(3, rows);
  thrift.begin_list(4, CompactThrift::Type::structure, groups_.size());
  for (const RowGroup& group : groups_) {
    std::int64_t bytes = 0;
    thrift.begin_element();
    thrift.begin_list(1, CompactThrift::Type::structure, group.chunks.size());
    for (std::size_t k = 0; k < group.chunks.size(); ++k) {
      const ChunkPlace& place = group.chunks[k];
      const ParquetColumn& column = columns_[k];
      bytes += place.unpacked_bytes;
      thrift.begin_element();
      thrift.field(2, place.offset);
      thrift.begin_structure(3);
      thrift.field(1, number_of(column.type));
      thrift.begin_list(2, CompactThrift::Type::i32, 2);
      thrift.element(kPlain);
      thrift.element(kRunLengths);
      thrift.begin_list(3, CompactThrift::Type::text, 1 + 2 * column.shape.size());
      thrift.element(column.name);
      for (std::size_t depth = 0; depth < column.shape.size(); ++depth) {
        thrift.element("list");
        thrift.element("element");
      }
      thrift.field(4, kZstd);
      thrift.field(5, place.values);
      thrift.field(6, place.unpacked_bytes);
      thrift.field(7, place.bytes);
      thrift.field(9, place.offset);
      thrift.end_structure();
      thrift.end_structure();
    }
    thrift.field(2, bytes);
    thrift.field(3, group.rows);
    thrift.end_structure();
  }
  if (!notes.empty()) {
    thrift.begin_list(5, CompactThrift::Type::structure, notes.size());
    for (const auto& [key, value] : notes) {
      thrift.begin_element();
      thrift.field(1, key);
      thrift.field(2, value);
      thrift.end_structure();
    }
  }
  thrift.field(6, std::string("dermis ") + DERMIS_VERSION);
  return thrift.bytes() + '\0';
}

Status ParquetFile::finish(const std::map<std::string, std::string>& notes) {
  if (Status ended = end_row_group(); !ended) return ended;
  const std::string description = footer(notes);
  if (Status written = put(description + four_bytes(description.size()) + std::string(kMagic)); !written) {
    return written;
  }
  file_.close();
  if (!file_) return bytes::files::cannot_write(path_, errno);
  return Done{};
}

}  // namespace dermis::out::datasets
