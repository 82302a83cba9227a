// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/input.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "dermis/bytes/files/output_place.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {

Result<std::unique_ptr<std::istream>> open_input(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return bad_input("cannot open " + in_quotes(path) + ": " + std::strerror(EISDIR));
  }
  if (Status readable = check_readable(path); !readable) return readable.error();
  errno = 0;
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!file->is_open()) return bad_input("cannot open " + in_quotes(path) + ": " + std::strerror(errno));
  return std::unique_ptr<std::istream>(std::move(file));
}

Error read_failure(const std::string& name) {
  return failed("cannot read " + in_quotes(name) + ": " + std::strerror(errno));
}

std::string first_bytes_of(const std::string& path, std::size_t max_bytes) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string bytes(max_bytes, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

Result<std::string> read_file(const std::string& path, std::size_t max_bytes) {
  constexpr std::size_t kFirstBytes = std::size_t{1} << 20U;
  Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  std::string bytes;
  while (!(*in)->eof() && bytes.size() <= max_bytes) {
    const std::size_t kept = bytes.size();
    bytes.resize(std::min(std::max(kFirstBytes, 2 * kept), max_bytes + 1));
    (*in)->read(bytes.data() + kept, static_cast<std::streamsize>(bytes.size() - kept));
    if ((*in)->bad()) return read_failure(path);
    bytes.resize(kept + static_cast<std::size_t>((*in)->gcount()));
  }
  if (bytes.size() > max_bytes) {
    return bad_input(path + ": is larger than " + std::to_string(max_bytes) + " bytes");
  }
  return bytes;
}

}  // namespace dermis::bytes::files
