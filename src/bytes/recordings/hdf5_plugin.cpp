// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/hdf5_plugin.hpp"

#include "dermis/bytes/system/plugin.hpp"

namespace dermis::bytes::recordings {

Result<const Hdf5Plugin*> load_hdf5() {
  const Result<void*> function = find_plugin_function(
      {"HDF5", "libdermis_hdf5.so", "(Debian: dermis), and its library (Debian: libhdf5-103-1)"}, kFindHdf5);
  if (!function) return function.error();
  const Hdf5Plugin* found = nullptr;
  reinterpret_cast<FindHdf5>(*function)(found, files::process_outputs());
  return found;
}

Result<std::unique_ptr<Hdf5Tables>> Hdf5Tables::create(const std::string& path) {
  return by_hdf5(&Hdf5Plugin::create_tables, path);
}

}  // namespace dermis::bytes::recordings
