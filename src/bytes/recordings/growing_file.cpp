// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/growing_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace dermis::bytes::recordings {
namespace {

bool is_want_of_room(int error_number) {
  return error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG;
}

}  // namespace

Result<GrowingFile> GrowingFile::create(const std::string& path) {
  Result<files::OutputPlace> place = files::open_output(path);
  if (!place) return place.error();
  return GrowingFile(*std::move(place));
}

GrowingFile::GrowingFile(files::OutputPlace place)
    : target_(std::move(place.target)), unfinished_(std::move(place.unfinished)), descriptor_(place.descriptor) {}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : target_(std::move(other.target_)),
      unfinished_(std::move(other.unfinished_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      is_full_(other.is_full_),
      told_(std::move(other.told_)) {}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status GrowingFile::append(std::span<const std::uint8_t> bytes) {
  const int error_number = files::write_all(descriptor_, std::as_bytes(bytes));
  is_full_ = is_want_of_room(error_number);
  if (error_number != 0) return files::cannot_write(target_, error_number);
  size_ += bytes.size();
  return Done{};
}

void GrowingFile::go_back_to(std::uint64_t size) {
  size_ = size;
  static_cast<void>(::lseek(descriptor_, static_cast<off_t>(size), SEEK_SET));
}

std::uint64_t GrowingFile::room() const {
  struct stat info {};
  return ::fstat(descriptor_, &info) == 0 ? static_cast<std::uint64_t>(info.st_size) : 0;
}

void GrowingFile::cut_back() const {
  const auto end = static_cast<off_t>(size_);
  if (::ftruncate(descriptor_, end) == 0) static_cast<void>(::lseek(descriptor_, end, SEEK_SET));
}

std::string GrowingFile::place_beside() const {
  std::error_code no_folder;
  if (unfinished_.exists()) return target_ + ".index";
  const std::string name = "dermis." + std::to_string(::getpid()) + ".index";
  return (std::filesystem::temp_directory_path(no_folder) / name).string();
}

Status GrowingFile::appear() {
  if (has_appeared()) return Done{};
  // Else a power failure can leave neither the earlier file nor this one.
  const bool replaces = ::access(target_.c_str(), F_OK) == 0;
  if (replaces && ::fdatasync(descriptor_) != 0) return files::cannot_write(target_, errno);
  Result<files::Placed> placed = unfinished_.take_place();
  if (!placed) return placed.error();
  target_ = std::move(placed->path);
  told_ = std::move(placed->told);
  return Done{};
}

Status GrowingFile::synchronise() const {
  const bool cannot_be = ::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS;  // a pipe or a terminal
  if (cannot_be) return files::cannot_write(target_, errno);
  files::synchronise_folder_of(target_);
  return Done{};
}

Status GrowingFile::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) return files::cannot_write(target_, errno);
  files::synchronise_folder_of(target_);
  return told_;
}

}  // namespace dermis::bytes::recordings
