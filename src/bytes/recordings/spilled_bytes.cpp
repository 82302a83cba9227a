// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/spilled_bytes.hpp"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

#include "dermis/bytes/files/output_place.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::size_t kMostInMemory = std::size_t{64} << 10U;

/// Returns 0, or the errno.
int read_all(int descriptor, std::span<std::uint8_t> bytes, std::uint64_t place) {
  while (!bytes.empty()) {
    const ssize_t count = ::pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (count == 0) return EIO;
    if (count < 0 && errno != EINTR) return errno;
    const auto taken = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    bytes = bytes.subspan(taken);
    place += taken;
  }
  return 0;
}

}  // namespace

SpilledBytes::~SpilledBytes() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status SpilledBytes::append(ByteView bytes) {
  append_bytes(recent_, bytes);
  return recent_.size() < kMostInMemory ? Status(Done{}) : spill();
}

Status SpilledBytes::spill() {
  if (descriptor_ < 0) {
    const Result<files::OutputPlace> place = files::open_output(path_);
    if (!place) return place.error();
    descriptor_ = place->descriptor;  // the name goes with the place
  }
  const int error_number = files::write_all(descriptor_, std::as_bytes(std::span(recent_)), in_file_);
  if (error_number != 0) return files::cannot_write(path_, error_number);
  in_file_ += recent_.size();
  recent_.clear();
  return Done{};
}

void SpilledBytes::cut(std::uint64_t size) {
  assert(size <= this->size());
  recent_.resize(size > in_file_ ? static_cast<std::size_t>(size - in_file_) : 0);
  in_file_ = std::min(in_file_, size);
}

Status SpilledBytes::read(std::uint64_t place, std::span<std::uint8_t> bytes) const {
  assert(place + bytes.size() <= size());
  const std::uint64_t before = in_file_ - std::min(place, in_file_);
  const std::span<std::uint8_t> of_file =
      bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(before, bytes.size())));
  const std::span<std::uint8_t> of_memory = bytes.subspan(of_file.size());
  if (const int error_number = read_all(descriptor_, of_file, place); error_number != 0) {
    return failed("cannot read " + files::in_quotes(path_) + ": " + std::strerror(error_number));
  }
  if (of_memory.empty()) return Done{};
  const auto begin = static_cast<std::size_t>(place + of_file.size() - in_file_);
  std::copy_n(recent_.begin() + static_cast<std::ptrdiff_t>(begin), of_memory.size(), of_memory.begin());
  return Done{};
}

}  // namespace dermis::bytes::recordings
