// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/bag_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::recordings {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 100'000;

/// Names in a folder, in their order; none of what is no folder.
std::vector<std::string> names_in(const std::string& path) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator file(path, error);
  for (; !error && file != fs::directory_iterator() && names.size() < kMostFiles; file.increment(error)) {
    names.push_back(file->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> ending_with(const std::vector<std::string>& names, std::string_view ending) {
  std::vector<std::string> found;
  std::ranges::copy_if(names, std::back_inserter(found),
                       [&](const std::string& name) { return name.ends_with(ending); });
  return found;
}

}  // namespace

std::optional<BagFolder> bag_folder(const std::string& path) {
  const std::vector<std::string> names = names_in(path);
  const std::vector<std::string> recordings = ending_with(names, ".mcap");
  if (recordings.size() == 1) return BagFolder{(fs::path(path) / recordings.front()).string(), ""};
  if (recordings.size() > 1) {
    return BagFolder{"", "is a bag of " + std::to_string(recordings.size()) + " files; name one, as " +
                             files::in_quotes((fs::path(path) / recordings.front()).string())};
  }
  if (const auto packed = ending_with(names, ".mcap.zstd"); !packed.empty()) {
    return BagFolder{"", "is a bag whose files are packed; unpack them first: zstd -d " + packed.front()};
  }
  if (ending_with(names, ".db3").empty()) return std::nullopt;
  return BagFolder{"", "is a bag in SQLite; make it MCAP by rosbags-convert of PyPI (docs/recordings.md)"};
}

}  // namespace dermis::bytes::recordings
