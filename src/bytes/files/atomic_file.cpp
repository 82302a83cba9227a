// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/atomic_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;
constexpr std::chrono::milliseconds kReaderWaits{50};

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  Result<OutputPlace> place = open_output(path);
  if (!place) return place.error();
  return AtomicFile(*std::move(place));
}

AtomicFile::AtomicFile(OutputPlace place)
    : target_(std::move(place.target)), unfinished_(std::move(place.unfinished)), descriptor_(place.descriptor) {
  buffer_.reserve(kBufferBytes);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      unfinished_(std::move(other.unfinished_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      buffer_(std::move(other.buffer_)),
      first_error_(std::move(other.first_error_)) {}

AtomicFile::~AtomicFile() {
  close();
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty() && !first_error_) {
    const std::size_t taken = std::min(bytes.size(), kBufferBytes - buffer_.size());
    buffer_.append(bytes.substr(0, taken));
    bytes.remove_prefix(taken);
    if (buffer_.size() == kBufferBytes) flush();
  }
  if (!unfinished_.exists()) flush_for_reader();
}

/// Who reads a pipe sees what was written while more is to come.
void AtomicFile::flush_for_reader() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_flush_ < kReaderWaits) return;
  flush();
  last_flush_ = now;
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view bytes) {
  flush();
  if (!unfinished_.exists() && !first_error_) {
    first_error_ = bad_input("cannot write " + in_quotes(target_) + ": this format needs a regular file");
  }
  if (first_error_) return;
  if (const int error_number = write_all(descriptor_, std::as_bytes(std::span(bytes)), offset); error_number != 0) {
    keep_error(error_number);
  }
}

void AtomicFile::read_at(std::uint64_t offset, std::span<char> bytes) {
  flush();
  ssize_t got = 1;
  while (!bytes.empty() && got != 0) {
    got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      keep_error(errno);
      break;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  std::fill(bytes.begin(), bytes.end(), '\0');
}

Status AtomicFile::status() const {
  if (first_error_) return *first_error_;
  return Done{};
}

Status AtomicFile::commit() {
  flush();
  if (unfinished_.exists() && !first_error_ && ::fsync(descriptor_) != 0) keep_error(errno);
  close();
  if (first_error_) return *first_error_;
  if (!unfinished_.exists()) return Done{};
  const Result<Placed> placed = unfinished_.take_place();
  if (!placed) return placed.error();
  synchronise_folder_of(target_);
  return placed->told;
}

void AtomicFile::flush() {
  if (!first_error_) {
    const int error_number = write_all(descriptor_, std::as_bytes(std::span(buffer_)));
    if (error_number != 0) keep_error(error_number);
  }
  buffer_.clear();
}

void AtomicFile::keep_error(int error_number) {
  if (!first_error_) first_error_ = cannot_write(target_, error_number);
}

void AtomicFile::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (descriptor >= 0 && ::close(descriptor) != 0) keep_error(errno);
}

}  // namespace dermis::bytes::files
