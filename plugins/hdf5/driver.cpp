// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "driver.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <string_view>

namespace dermis::bytes::recordings {
namespace {

struct DriverInfo {
  files::AtomicFile* file = nullptr;
};

/// HDF5 knows an open file by a pointer to its H5FD_t.
struct OpenFile : H5FD_t {
  explicit OpenFile(files::AtomicFile& target) : H5FD_t{}, file(&target) {}

  files::AtomicFile* file;
  haddr_t allocated = 0;
  haddr_t written = 0;
};

OpenFile& of(H5FD_t* file) {
  return *static_cast<OpenFile*>(file);
}

H5FD_t* open_file(const char* /*name*/, unsigned /*flags*/, hid_t file_access, haddr_t /*max_address*/) {
  const auto* const info = static_cast<const DriverInfo*>(H5Pget_driver_info(file_access));
  if (info == nullptr) return nullptr;
  return new OpenFile(*info->file);
}

herr_t close_file(H5FD_t* file) {
  delete &of(file);
  return 0;
}

herr_t query(const H5FD_t* /*file*/, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t get_allocated(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return static_cast<const OpenFile*>(file)->allocated;
}

herr_t set_allocated(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t address) {
  of(file).allocated = address;
  return 0;
}

haddr_t get_end(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return static_cast<const OpenFile*>(file)->written;
}

herr_t read(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address, std::size_t size, void* bytes) {
  of(file).file->read_at(address, std::span(static_cast<char*>(bytes), size));
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address, std::size_t size,
             const void* bytes) {
  of(file).file->write_at(address, std::string_view(static_cast<const char*>(bytes), size));
  of(file).written = std::max(of(file).written, address + size);
  return 0;
}

/// The file must be as long as HDF5 thinks, or it cannot be opened.
herr_t truncate(H5FD_t* file, hid_t /*transfer*/, hbool_t /*is_closing*/) {
  OpenFile& open = of(file);
  if (open.written < open.allocated) {
    open.file->write_at(open.allocated - 1, std::string_view("\0", 1));
    open.written = open.allocated;
  }
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
  driver.name = "dermis_atomic_file";
  driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<std::int64_t>::max());
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = get_allocated;
  driver.set_eoa = set_allocated;
  driver.get_eof = get_end;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  std::fill(std::begin(driver.fl_map), std::end(driver.fl_map), H5FD_MEM_DEFAULT);
  return driver;
}

}  // namespace

bool set_atomic_file_driver(hid_t file_access, files::AtomicFile& file) {
  static const H5FD_class_t kClass = driver_class();
  static const hid_t kDriver = H5FDregister(&kClass);
  const DriverInfo info{&file};
  return kDriver >= 0 && H5Pset_driver(file_access, kDriver, &info) >= 0;
}

}  // namespace dermis::bytes::recordings
