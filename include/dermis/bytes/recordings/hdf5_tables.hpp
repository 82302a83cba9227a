// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// A new HDF5 file of tables: datasets of numbers, whose first dimension are the rows. Without commit(), no file
/// remains. Not thread-safe.
class Hdf5Tables {
 public:
  enum class Number { float32, int64, uint8 };

  [[nodiscard]] static Result<std::unique_ptr<Hdf5Tables>> create(const std::string& path);
  ~Hdf5Tables();
  Hdf5Tables(const Hdf5Tables&) = delete;
  Hdf5Tables& operator=(const Hdf5Tables&) = delete;

  /// "/observations/tactile/chest", with the groups on the way to it. `row_shape`: of one row; empty: a number. Returns
  /// the index of the table.
  [[nodiscard]] Result<std::size_t> add(const std::string& name, Number number,
                                        const std::vector<std::size_t>& row_shape);
  /// Rows of C order behind those that the table has.
  [[nodiscard]] Status append(std::size_t table, std::size_t rows, const void* values);

  /// Attributes of the file ("/"), a group or a table, which must exist.
  [[nodiscard]] Status set_text(const std::string& object, const char* name, const std::string& text);
  [[nodiscard]] Status set_number(const std::string& object, const char* name, std::int64_t number);
  /// Its type is that of the booleans of h5py.
  [[nodiscard]] Status set_flag(const std::string& object, const char* name, bool flag);

  [[nodiscard]] Status commit();

 private:
  struct State;
  explicit Hdf5Tables(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dermis::bytes::recordings
