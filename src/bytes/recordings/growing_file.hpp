// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dermis/bytes/files/output_place.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// A file that grows record by record. It lies beside its place until appear().
class GrowingFile {
 public:
  [[nodiscard]] static Result<GrowingFile> create(const std::string& path);

  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&&) = delete;
  /// Removes a file that has not appeared.
  ~GrowingFile();

  /// Appends the bytes. Bytes that it has written when it fails stay until cut_back().
  [[nodiscard]] Status append(std::span<const std::uint8_t> bytes);
  /// The last append() failed for want of room.
  [[nodiscard]] bool is_full() const noexcept { return is_full_; }
  /// append() goes on at an earlier size. The bytes behind stay on the disk until cut_back(): within room(), append()
  /// needs no more of it. A pipe cannot go back.
  void go_back_to(std::uint64_t size);
  /// How many bytes the file has on the disk, with those that cut_back() would remove.
  [[nodiscard]] std::uint64_t room() const;
  /// To what append() has written whole. A pipe cannot be: its reader sees a cut file.
  void cut_back() const;
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

  /// A name for further files, on the same disk where this file is on one.
  [[nodiscard]] std::string place_beside() const;

  /// Puts the file in its place; nothing where it is there already. A file that it replaces is gone only when the bytes
  /// of this one are on the disk. Where another file has appeared there meanwhile, this one gets another name, and
  /// close() fails and says so.
  [[nodiscard]] Status appear();
  [[nodiscard]] bool has_appeared() const noexcept { return !unfinished_.exists(); }

  /// Waits until the bytes appended so far, and the name of the file, are on the disk. May be called while another
  /// thread appends.
  [[nodiscard]] Status synchronise() const;
  /// The name is on the disk then; the bytes are where synchronise() came before.
  [[nodiscard]] Status close();

 private:
  explicit GrowingFile(files::OutputPlace place);

  std::string target_;
  files::UnfinishedFile unfinished_;  ///< None where the file is in its place.
  int descriptor_;
  std::uint64_t size_ = 0;
  bool is_full_ = false;
  Status told_ = Done{};  ///< Of the name (files::Placed).
};

}  // namespace dermis::bytes::recordings
