// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// A file that clients may save.
struct SavedFile {
  std::string name;  ///< "walk.mcap"
  std::uint64_t bytes = 0;
  std::int64_t changed_s = 0;  ///< Seconds since 1970.
};

/// The path of a file or folder without `.` and `..`, as a person would look for it.
[[nodiscard]] std::string absolute_path(const std::string& path);

/// The folder into which clients record, and nothing outside of it. Links are passed over. Thread-safe.
class RecordingsFolder {
 public:
  static constexpr std::size_t kMostFiles = 100;

  /// `recording`: path of a recording in the folder, or empty for the current folder.
  explicit RecordingsFolder(const std::string& recording);

  /// "." for the current one.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// Its recordings (.mcap), the newest first.
  [[nodiscard]] std::vector<SavedFile> recordings() const;
  /// The path of one of recordings(), or of any older one. Fails on all other names.
  [[nodiscard]] Result<std::string> recording(const std::string& name) const;
  /// The path of a file that is not there yet; `ending`: ".mcap". Fails where there is one.
  [[nodiscard]] Result<std::string> new_path(const std::string& name, std::string_view ending) const;

 private:
  std::string path_;
};

}  // namespace dermis::out::serve
