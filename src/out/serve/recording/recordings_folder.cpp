// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/recordings_folder.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>

namespace dermis::out::serve {
namespace {

namespace fs = std::filesystem;

bool is_recording(const fs::path& path) {
  std::error_code error;
  return path.extension() == ".mcap" && fs::is_regular_file(fs::symlink_status(path, error));
}

std::int64_t since_1970(fs::file_time_type time) {
  const auto system = std::chrono::file_clock::to_sys(time);
  return std::chrono::duration_cast<std::chrono::seconds>(system.time_since_epoch()).count();
}

}  // namespace

std::string absolute_path(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error).lexically_normal();
  const bool is_folder = !absolute.has_filename() && absolute.has_relative_path();
  return error ? path : (is_folder ? absolute.parent_path() : absolute).string();
}

RecordingsFolder::RecordingsFolder(const std::string& recording) : path_(fs::path(recording).parent_path().string()) {
  if (path_.empty()) path_ = ".";
}

std::vector<SavedFile> RecordingsFolder::recordings() const {
  std::vector<SavedFile> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path_, error)) {
    if (!is_recording(entry.path())) continue;
    std::error_code gone;
    const std::uint64_t bytes = fs::file_size(entry.path(), gone);
    const fs::file_time_type changed = gone ? fs::file_time_type{} : fs::last_write_time(entry.path(), gone);
    if (!gone) files.push_back({entry.path().filename().string(), bytes, since_1970(changed)});
  }
  std::ranges::sort(files, [](const SavedFile& a, const SavedFile& b) {
    return a.changed_s != b.changed_s ? a.changed_s > b.changed_s : a.name < b.name;
  });
  if (files.size() > kMostFiles) files.resize(kMostFiles);
  return files;
}

Result<std::string> RecordingsFolder::recording(const std::string& name) const {
  const fs::path path = fs::path(path_) / name;
  const bool is_plain = !name.empty() && name.find('/') == std::string::npos && name.find('\0') == std::string::npos;
  if (!is_plain || !is_recording(path)) return bad_field("name", "there is no recording of that name");
  return path.string();
}

Result<std::string> RecordingsFolder::new_path(const std::string& name, std::string_view ending) const {
  const std::string file = name + std::string(ending);
  const fs::path path = fs::path(path_) / file;
  std::error_code error;
  if (fs::symlink_status(path, error).type() != fs::file_type::not_found) {
    return bad_field("name", file + " is there already; choose another");
  }
  return path.string();
}

}  // namespace dermis::out::serve
