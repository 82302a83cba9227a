// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/kept_copy.hpp"

#include <fmt/chrono.h>

#include <cstddef>
#include <filesystem>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/input.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30U;

}  // namespace

std::string time_stamp(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y%m%d-%H%M%S}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

std::string unused_name(const std::string& path, const std::string& suffix) {
  const std::filesystem::path whole(path);
  const std::string stem = (whole.parent_path() / whole.stem()).string() + "-" + suffix;
  std::string name = stem + whole.extension().string();
  for (int number = 2; std::filesystem::exists(name); ++number) {
    name = fmt::format("{}-{}{}", stem, number, whole.extension().string());
  }
  return name;
}

Result<std::string> keep_copy(const std::string& path, std::chrono::system_clock::time_point time) {
  const Result<std::string> bytes = read_file(path, kMostBytes);
  if (!bytes) return bytes.error();
  const std::string copy = unused_name(path, "before-" + time_stamp(time));
  Result<AtomicFile> out = AtomicFile::create(copy);
  if (!out) return out.error();
  out->write(*bytes);
  if (Status written = out->commit(); !written) return written.error();
  return copy;
}

}  // namespace dermis::bytes::files
