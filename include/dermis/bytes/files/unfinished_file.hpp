// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <utility>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The end of an UnfinishedFile.
struct Placed {
  std::string path;
  Status told;  ///< Fails, with both names, where `path` is not the target, since another file has appeared there.
};

/// An output until it is complete: the file or folder TARGET.dermis.tmp beside its target. It is locked (flock) while
/// its process lives. So a second writer of the target is refused, and what a killed process has left has a free lock.
/// The destructor removes it, unless it has become the target.
class UnfinishedFile {
 public:
  UnfinishedFile() = default;  ///< None: the target is written directly.
  UnfinishedFile(UnfinishedFile&& other) noexcept;
  UnfinishedFile& operator=(UnfinishedFile&& other) noexcept;
  ~UnfinishedFile();

  /// An empty one. Fails where it, or the target itself, is being written, by this process or another. The first one in
  /// a folder removes what killed processes have left there. There is no moment at which remove_unfinished_files()
  /// would miss it. Thread-safe.
  [[nodiscard]] static Result<UnfinishedFile> begin(const std::string& target);
  [[nodiscard]] static Result<UnfinishedFile> begin_folder(const std::string& target);
  /// Whether this process has one for the target. Thread-safe.
  [[nodiscard]] static bool is_begun(const std::string& target);

  /// Whether there is one that has not become the target.
  [[nodiscard]] bool exists() const noexcept { return !path_.empty(); }

  /// Empty if there is none.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// A descriptor for reading and writing, which the caller closes; -1 and errno if there is none.
  [[nodiscard]] int duplicate_descriptor() const;

  /// Becomes the target, atomically. Only what stood there at begin() is replaced. Where anything else stands there
  /// now, that stays, and this one is called TARGET-20261130-101500 (UTC), before the ending. The lock stays until the
  /// descriptors are closed. Fails if the system refuses it.
  [[nodiscard]] Result<Placed> take_place();

 private:
  enum class Kind { file, folder };
  UnfinishedFile(std::string target, int lock);
  [[nodiscard]] static Result<UnfinishedFile> begin(const std::string& target, Kind kind);
  /// Device and number of the file that stood in the place of the target at begin(); zeros: there was none.
  using FileId = std::pair<unsigned long, unsigned long>;
  [[nodiscard]] static FileId id_of(const std::string& path);

  std::string target_;
  std::string path_;
  int lock_ = -1;
  FileId earlier_{};
};

/// Removes all unfinished files of the process, which must end then. A thread that begins or finishes one from now on
/// blocks for ever. Thread-safe.
void remove_unfinished_files();

[[nodiscard]] Error cannot_write(const std::string& path, int error_number);

}  // namespace dermis::bytes::files
