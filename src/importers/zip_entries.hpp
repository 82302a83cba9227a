// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "dermis/core/result.hpp"

namespace dermis::importers {

/// A file in a zip archive.
struct ZipEntry {
  std::string name;
  std::uint64_t offset = 0;            ///< Of its header.
  std::uint64_t compressed_bytes = 0;  ///< Behind the header.
  bool is_deflated = false;            ///< Else it stands there as it is.
};

/// The list of contents of an archive, Zip64 too, of at most 16 MiB; `in` must be able to seek. Fails, with what is
/// wrong, where there is none, and on files that are encrypted or compressed by anything but deflate.
[[nodiscard]] Result<std::vector<ZipEntry>> list_zip(std::istream& in);

/// The bytes of a file of the archive; they end early where the archive is cut or damaged. Memory: 128 KiB.
[[nodiscard]] Result<std::unique_ptr<std::istream>> open_zip_entry(std::unique_ptr<std::istream> in,
                                                                   const ZipEntry& entry);

}  // namespace dermis::importers
