// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <span>
#include <string>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The numbers that a table of taxels may hold.
enum class TableValues {
  finite,        ///< Any finite number: readings.
  not_negative,  ///< Finite and >= 0: conductances.
};

/// Reads tables of one number a taxel (docs/file-formats.md) frame by frame: `rows` lines of `cols` numbers a frame.
/// Blank lines and a first line without any number are skipped. The memory is that of one line, at most 32 MiB. Errors
/// name the line, the problem and the remedy. Not thread-safe.
class TaxelTablesReader {
 public:
  [[nodiscard]] static Result<TaxelTablesReader> open(const std::string& path, std::size_t rows, std::size_t cols,
                                                      TableValues values);
  /// The same from a stream; `name` stands for the path in messages.
  [[nodiscard]] static TaxelTablesReader open(std::unique_ptr<std::istream> in, const std::string& name,
                                              std::size_t rows, std::size_t cols, TableValues values);
  TaxelTablesReader(TaxelTablesReader&&) noexcept;
  TaxelTablesReader& operator=(TaxelTablesReader&&) noexcept;
  ~TaxelTablesReader();

  /// The next frame [rows, cols]; false at the end of the file.
  [[nodiscard]] Result<bool> next(std::span<double> table);

  /// Line at which the last frame begins, from 1.
  [[nodiscard]] std::size_t line() const noexcept;

 private:
  struct State;
  explicit TaxelTablesReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes such tables, with the fewest digits that read back as the same number and a blank line between frames. "nan"
/// is a missing number. Not thread-safe.
class TaxelTablesWriter {
 public:
  [[nodiscard]] static Result<TaxelTablesWriter> create(const std::string& path, std::size_t rows, std::size_t cols);

  /// Appends a frame [rows, cols]. Returns the first write error as soon as it is known.
  [[nodiscard]] Status write(std::span<const double> table);
  /// Puts the complete file in its place. Without it, no file remains.
  [[nodiscard]] Status commit();

 private:
  TaxelTablesWriter(AtomicFile file, std::size_t rows, std::size_t cols);

  AtomicFile file_;
  std::size_t rows_;
  std::size_t cols_;
  bool is_first_ = true;
  std::string text_;
};

}  // namespace dermis::bytes::files
