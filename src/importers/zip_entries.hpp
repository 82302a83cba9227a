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
  std::uint32_t crc32 = 0;             ///< CRC of the bytes that are not compressed.
  bool is_deflated = false;            ///< Else it stands there as it is.
};

/// The list of contents of an archive, Zip64 too, of at most 16 MiB; `in` must be able to seek. Fails, with what is
/// wrong, where there is none, and on files that are encrypted or compressed by anything but deflate.
[[nodiscard]] Result<std::vector<ZipEntry>> list_zip(std::istream& in);

/// The bytes of a file of the archive. They end early where the archive is cut or damaged, and the stream is bad()
/// where it cannot be read. Memory: 128 KiB.
class ZipEntryStream final : public std::istream {
 public:
  /// `in` stands at the first byte behind the header of the entry.
  ZipEntryStream(std::unique_ptr<std::istream> in, const ZipEntry& entry);
  ~ZipEntryStream() override;

  /// The bytes have come to their end, and are not those of which the archive has the checksum.
  [[nodiscard]] bool is_damaged() const noexcept;

 private:
  class Bytes;
  std::unique_ptr<Bytes> bytes_;
};

/// Fails, naming the file `name`, where the archive does not have the entry at its place.
[[nodiscard]] Result<std::unique_ptr<ZipEntryStream>> open_zip_entry(std::unique_ptr<std::istream> in,
                                                                     const ZipEntry& entry, const std::string& name);

}  // namespace dermis::importers
