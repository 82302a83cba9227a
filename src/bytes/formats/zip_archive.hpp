// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <zip.h>

#include <cstddef>
#include <cstdint>
#include <istream>
#include <memory>
#include <streambuf>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// A zip archive, read by libzip: the names of its entries, and the bytes of one of them. They end early where the
/// archive is cut or damaged. Where it cannot be read they throw, as those of std::filebuf. Not thread-safe.
class ZipArchive final : public std::streambuf {
 public:
  /// `in` must be able to seek. Fails, naming the file `name`, where it is no whole archive, or where its list of
  /// contents has more than 16 MiB.
  [[nodiscard]] static Result<std::unique_ptr<ZipArchive>> open(std::unique_ptr<std::istream> in,
                                                                const std::string& name);
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;
  ~ZipArchive() override;

  [[nodiscard]] std::vector<std::string> entries() const;
  /// The bytes are those of this entry from now on. Fails where it is encrypted, or compressed in a way that libzip
  /// does not know.
  [[nodiscard]] Status enter(std::size_t entry);

  [[nodiscard]] bool is_bad() const { return in_->bad(); }
  /// Why the bytes ended early, or that they have not the checksum of the archive; empty where neither is so.
  [[nodiscard]] const std::string& damage() const noexcept { return damage_; }

 private:
  explicit ZipArchive(std::unique_ptr<std::istream> in) : in_(std::move(in)) {}
  int_type underflow() override;

  zip_int64_t answer(void* data, zip_uint64_t size, zip_source_cmd_t command);
  zip_int64_t read(char* data, zip_uint64_t size);
  zip_int64_t seek(std::streamoff offset, int whence);
  zip_int64_t describe(zip_stat_t& stat);
  zip_int64_t fail(int code);

  struct CloseArchive {
    void operator()(zip_t* archive) const { zip_discard(archive); }
  };
  struct CloseEntry {
    void operator()(zip_file_t* entry) const { zip_fclose(entry); }
  };

  std::unique_ptr<std::istream> in_;
  std::uint64_t readable_bytes_ = 0;  ///< How many libzip may still ask for.
  zip_error_t error_{};               ///< Of the last answer that failed.
  std::unique_ptr<zip_t, CloseArchive> archive_;
  std::unique_ptr<zip_file_t, CloseEntry> entry_;
  std::vector<char> piece_;
  std::string damage_;
};

}  // namespace dermis::bytes::formats
