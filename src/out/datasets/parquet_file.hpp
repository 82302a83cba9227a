// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::out::datasets {

enum class ParquetType : std::uint8_t { boolean, int64, float32, float64, text };

struct ParquetColumn {
  std::string name;
  ParquetType type = ParquetType::float32;
  std::vector<std::size_t> shape{};  ///< That of one row, as lists in lists; empty: one value.
};

/// Writes a Parquet file of columns in which every row has the same shape and nothing is missing. Values are plain, and
/// compressed by zstd. Debian 12 has no library of Parquet, so the bytes are ours; readers of others test them. Not
/// thread-safe.
class ParquetFile {
 public:
  [[nodiscard]] static Result<std::unique_ptr<ParquetFile>> create(const std::string& path,
                                                                   std::vector<ParquetColumn> columns);

  /// Rows behind those that are there. `values`: of each column; a boolean is a byte, a text as plain_text().
  void write(std::size_t rows, std::span<const std::span<const std::byte>> values);
  /// Compressed bytes that wait for the end of their group of rows.
  [[nodiscard]] std::size_t waiting_bytes() const noexcept;
  /// Readers fetch a group at a time.
  [[nodiscard]] Status end_row_group();
  /// Bytes of the groups so far.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return offset_; }
  /// `notes`: key and value, for readers that know the key.
  [[nodiscard]] Status finish(const std::map<std::string, std::string>& notes = {});

 private:
  /// The pages of a column in the group of rows that is being written.
  struct Chunk {
    std::string pages;
    std::int64_t values = 0;
    std::int64_t unpacked_bytes = 0;
  };
  struct ChunkPlace {
    std::int64_t values = 0;
    std::int64_t unpacked_bytes = 0;
    std::int64_t offset = 0;
    std::int64_t bytes = 0;
  };
  struct RowGroup {
    std::int64_t rows = 0;
    std::vector<ChunkPlace> chunks;
  };

  ParquetFile(std::string path, std::ofstream file, std::vector<ParquetColumn> columns);
  void add_page(std::size_t column, std::size_t rows, std::span<const std::byte> values);
  [[nodiscard]] std::string footer(const std::map<std::string, std::string>& notes) const;
  [[nodiscard]] Status put(std::string_view bytes);

  std::string path_;
  std::ofstream file_;
  std::vector<ParquetColumn> columns_;
  std::vector<std::string> row_levels_;  ///< For each column: how a row of lists is encoded.
  std::vector<Chunk> chunks_;
  std::vector<RowGroup> groups_;
  std::int64_t rows_ = 0;  ///< Those of the group that is being written.
  std::uint64_t offset_ = 0;
};

/// A text as Parquet has it: its length, and its bytes.
[[nodiscard]] std::string plain_text(std::string_view text);

}  // namespace dermis::out::datasets
