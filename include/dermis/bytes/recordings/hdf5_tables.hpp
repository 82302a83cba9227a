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

  /// Also fails where the plugin of HDF5 is not there.
  [[nodiscard]] static Result<std::unique_ptr<Hdf5Tables>> create(const std::string& path);
  Hdf5Tables() = default;
  virtual ~Hdf5Tables() = default;
  Hdf5Tables(const Hdf5Tables&) = delete;
  Hdf5Tables& operator=(const Hdf5Tables&) = delete;

  /// "/observations/tactile/chest", with the groups on the way to it. `row_shape`: of one row; empty: a number. Returns
  /// the index of the table.
  [[nodiscard]] virtual Result<std::size_t> add(const std::string& name, Number number,
                                                const std::vector<std::size_t>& row_shape) = 0;
  /// Rows of C order behind those that the table has.
  [[nodiscard]] virtual Status append(std::size_t table, std::size_t rows, const void* values) = 0;

  /// A dataset of texts of one length, which zeros fill up.
  [[nodiscard]] virtual Status write_names(const std::string& name, const std::vector<std::string>& names) = 0;

  /// Attributes of the file ("/"), a group or a table, which must exist.
  [[nodiscard]] virtual Status set_text(const std::string& object, const char* name, const std::string& text) = 0;
  [[nodiscard]] virtual Status set_number(const std::string& object, const char* name, std::int64_t number) = 0;
  /// Its type is that of the booleans of h5py.
  [[nodiscard]] virtual Status set_flag(const std::string& object, const char* name, bool flag) = 0;

  [[nodiscard]] virtual Status commit() = 0;
};

}  // namespace dermis::bytes::recordings
