// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "tables.hpp"

#include <algorithm>
#include <utility>

#include "hdf5.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::size_t kBytesOfChunk = std::size_t{1} << 18U;
constexpr std::size_t kRowsOfChunk = 4096;

hid_t type_of(Hdf5Tables::Number number) {
  switch (number) {
    case Hdf5Tables::Number::float32: return H5T_NATIVE_FLOAT;
    case Hdf5Tables::Number::int64: return H5T_NATIVE_INT64;
    case Hdf5Tables::Number::uint8: break;
  }
  return H5T_NATIVE_UINT8;
}

/// The enumeration FALSE, TRUE of bytes.
Hdf5Id boolean_type() {
  Hdf5Id type(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose);
  for (const auto& [name, value] : {std::pair<const char*, std::int8_t>{"FALSE", 0}, {"TRUE", 1}}) {
    H5Tenum_insert(type.get(), name, &value);
  }
  return type;
}

class TablesFile final : public Hdf5Tables {
 public:
  explicit TablesFile(Hdf5Output file) : file_(std::move(file)) {}
  ~TablesFile() override {
    const QuietHdf5 quiet;
    tables_.clear();
    [[maybe_unused]] const Hdf5Output closed = std::move(file_);
  }

  Result<std::size_t> add(const std::string& name, Number number, const std::vector<std::size_t>& row_shape) override {
    const QuietHdf5 quiet;
    const hid_t type = type_of(number);
    std::size_t row_bytes = H5Tget_size(type);
    for (const std::size_t size : row_shape) row_bytes *= size;
    const hsize_t rows = std::clamp<hsize_t>(kBytesOfChunk / row_bytes, 1, kRowsOfChunk);
    const Hdf5Sizes sizes(row_shape.begin(), row_shape.end());
    Hdf5Id id = file_.create_dataset(name.c_str(), type, sizes, rows, Hdf5Packing::plain);
    if (!id) return file_.failure();
    tables_.push_back({std::move(id), type, 0});
    return tables_.size() - 1;
  }

  Status append(std::size_t table, std::size_t rows, const void* values) override {
    const QuietHdf5 quiet;
    Table& to = tables_[table];
    Status appended = file_.append(to.id, to.rows, rows, to.type, values);
    to.rows += rows;
    return appended;
  }

  Status write_names(const std::string& name, const std::vector<std::string>& names) override {
    const QuietHdf5 quiet;
    std::size_t length = 1;
    for (const std::string& one : names) length = std::max(length, one.size());
    std::string bytes;
    for (const std::string& one : names) bytes += one + std::string(length - one.size(), '\0');
    const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), length);
    H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
    Hdf5Id id = file_.create_dataset(name.c_str(), type.get(), {}, kRowsOfChunk, Hdf5Packing::plain);
    if (!id) return file_.failure();
    return file_.append(id, 0, names.size(), type.get(), bytes.data());
  }

  Status set_text(const std::string& object, const char* name, const std::string& text) override {
    const QuietHdf5 quiet;
    return file_.set_text(object.c_str(), name, text);
  }

  Status set_number(const std::string& object, const char* name, std::int64_t number) override {
    const QuietHdf5 quiet;
    return file_.set(object.c_str(), name, H5T_NATIVE_INT64, &number);
  }

  Status set_flag(const std::string& object, const char* name, bool flag) override {
    const QuietHdf5 quiet;
    const Hdf5Id type = boolean_type();
    const std::int8_t value = flag ? 1 : 0;
    return file_.set(object.c_str(), name, type.get(), &value);
  }

  Status commit() override {
    const QuietHdf5 quiet;
    tables_.clear();
    return file_.commit();
  }

 private:
  struct Table {
    Hdf5Id id;
    hid_t type = H5I_INVALID_HID;
    hsize_t rows = 0;
  };
  Hdf5Output file_;
  std::vector<Table> tables_;
};

}  // namespace

Result<std::unique_ptr<Hdf5Tables>> create_tables(const std::string& path) {
  const QuietHdf5 quiet;
  Result<Hdf5Output> file = Hdf5Output::create(path);
  if (!file) return file.error();
  return std::unique_ptr<Hdf5Tables>(std::make_unique<TablesFile>(*std::move(file)));
}

}  // namespace dermis::bytes::recordings
