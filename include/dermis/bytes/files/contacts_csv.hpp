// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Writes contacts.csv (docs/file-formats.md): a line for each contact of each frame, none for a frame without
/// contacts. Numbers have the fewest digits that read back as the same single-precision value; `inf` is a standard
/// deviation without bound. Not thread-safe.
class ContactsCsvWriter {
 public:
  [[nodiscard]] static Result<ContactsCsvWriter> create(const std::string& path);

  /// Appends the contacts of a frame. Returns the first write error as soon as it is known.
  [[nodiscard]] Status write(const ContactReport& report);
  /// Puts the complete file in its place. Without it, no file remains.
  [[nodiscard]] Status commit();

 private:
  explicit ContactsCsvWriter(AtomicFile file);

  AtomicFile file_;
  std::string lines_;
};

}  // namespace dermis::bytes::files
