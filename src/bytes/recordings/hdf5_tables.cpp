// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/hdf5_tables.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bytes/recordings/hdf5.hpp"
#include "bytes/recordings/hdf5_columns.hpp"

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

}  // namespace

struct Hdf5Tables::State {
  struct Table {
    Hdf5Id id;
    Number number = Number::float32;
    hsize_t rows = 0;
  };
  Hdf5Output file;
  std::vector<Table> tables{};

  [[nodiscard]] Status set(const std::string& object, const char* name, hid_t type, const void* value) const {
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Id attribute(
        H5Acreate_by_name(file.id(), object.c_str(), name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    if (!attribute || H5Awrite(attribute.get(), type, value) < 0) return file.failure();
    return file.status();
  }
};

Hdf5Tables::Hdf5Tables(std::unique_ptr<State> state) : state_(std::move(state)) {}

Hdf5Tables::~Hdf5Tables() {
  const QuietHdf5 quiet;
  state_.reset();
}

Result<std::unique_ptr<Hdf5Tables>> Hdf5Tables::create(const std::string& path) {
  const QuietHdf5 quiet;
  Result<Hdf5Output> file = Hdf5Output::create(path);
  if (!file) return file.error();
  return std::unique_ptr<Hdf5Tables>(new Hdf5Tables(std::make_unique<State>(State{*std::move(file)})));
}

Result<std::size_t> Hdf5Tables::add(const std::string& name, Number number, const std::vector<std::size_t>& row_shape) {
  const QuietHdf5 quiet;
  Hdf5Sizes sizes{0};
  Hdf5Sizes limits{H5S_UNLIMITED};
  const hid_t type = type_of(number);
  std::size_t row_bytes = H5Tget_size(type);
  for (const std::size_t size : row_shape) row_bytes *= size;
  Hdf5Sizes chunk{std::clamp<hsize_t>(kBytesOfChunk / row_bytes, 1, kRowsOfChunk)};
  for (Hdf5Sizes* const list : {&sizes, &limits, &chunk}) list->insert(list->end(), row_shape.begin(), row_shape.end());
  const Hdf5Id space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), limits.data()), H5Sclose);
  const Hdf5Id plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Hdf5Id way(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_chunk(plan.get(), static_cast<int>(chunk.size()), chunk.data());
  H5Pset_create_intermediate_group(way.get(), 1);
  Hdf5Id id(H5Dcreate2(state_->file.id(), name.c_str(), type, space.get(), way.get(), plan.get(), H5P_DEFAULT),
            H5Dclose);
  if (!id) return state_->file.failure();
  state_->tables.push_back({std::move(id), number, 0});
  return state_->tables.size() - 1;
}

Status Hdf5Tables::append(std::size_t table, std::size_t rows, const void* values) {
  const QuietHdf5 quiet;
  State::Table& to = state_->tables[table];
  Status appended = state_->file.append(to.id, to.rows, rows, type_of(to.number), values);
  to.rows += rows;
  return appended;
}

Status Hdf5Tables::set_text(const std::string& object, const char* name, const std::string& text) {
  const QuietHdf5 quiet;
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const char* const bytes = text.c_str();
  return state_->set(object, name, type.get(), static_cast<const void*>(&bytes));
}

Status Hdf5Tables::set_number(const std::string& object, const char* name, std::int64_t number) {
  const QuietHdf5 quiet;
  return state_->set(object, name, H5T_NATIVE_INT64, &number);
}

Status Hdf5Tables::set_flag(const std::string& object, const char* name, bool flag) {
  const QuietHdf5 quiet;
  const Hdf5Id type = boolean_type();
  const std::int8_t value = flag ? 1 : 0;
  return state_->set(object, name, type.get(), &value);
}

Status Hdf5Tables::commit() {
  const QuietHdf5 quiet;
  state_->tables.clear();
  return state_->file.commit();
}

}  // namespace dermis::bytes::recordings
