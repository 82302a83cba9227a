// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "datasets/output_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "dermis/files/output_place.hpp"
#include "dermis/files/text.hpp"

namespace dermis::datasets {
namespace {

namespace fs = std::filesystem;

std::string without_slash(const std::string& folder) {
  const std::size_t last = folder.find_last_not_of('/');
  return folder.substr(0, last == std::string::npos ? 1 : last + 1);
}

bool is_hdf5(const fs::directory_entry& entry) {
  return entry.path().extension() == ".hdf5";
}

/// As dermis writes them, so not one with images.
bool has_dataset(const std::string& folder) {
  std::error_code error;
  const auto has = [&](const char* name) { return fs::exists(fs::path(folder) / name, error); };
  if (has("meta/info.json")) return !has("videos") && !has("images");
  return has(".zgroup") || std::all_of(fs::directory_iterator(folder, error), fs::directory_iterator(), is_hdf5);
}

Status check_target(const std::string& target, bool replaces) {
  std::error_code error;
  if (!fs::exists(target, error)) return Done{};
  if (fs::is_directory(target, error)) {
    if (fs::is_empty(target, error) || (replaces && has_dataset(target))) return Done{};
  }
  const char* what = replaces ? " exists and holds more than a dataset of dermis" : " exists and is no empty folder";
  return bad_input(files::in_quotes(target) + what + "; name another");
}

}  // namespace

Result<std::unique_ptr<OutputFolder>> OutputFolder::create(const std::string& folder, bool replaces) {
  if (folder.empty()) return bad_input("the folder of the dataset has no name");
  std::string target = without_slash(folder);
  std::error_code error;
  if (Status free = check_target(target, replaces); !free) return free.error();
  std::string unfinished = target + "." + std::to_string(::getpid()) + ".tmp";
  fs::create_directories(unfinished, error);
  if (error) return files::cannot_write(unfinished, error.value());
  return std::unique_ptr<OutputFolder>(new OutputFolder(std::move(target), std::move(unfinished), replaces));
}

OutputFolder::~OutputFolder() {
  std::error_code error;
  if (!unfinished_.empty()) fs::remove_all(unfinished_, error);
}

std::string OutputFolder::place(const std::string& name) const {
  const fs::path path = fs::path(unfinished_) / name;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  return path.string();
}

Status OutputFolder::write(const std::string& name, std::string_view bytes) const {
  const std::string path = place(name);
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return files::cannot_write(path, errno);
  return Done{};
}

Status OutputFolder::commit() {
  const std::string replaced = unfinished_ + ".old";
  std::error_code error;
  std::error_code no_matter;
  if (replaces_ && fs::exists(target_, error)) fs::rename(target_, replaced, error);
  if (!error) fs::rename(unfinished_, target_, error);
  if (error) {
    if (replaces_) fs::rename(replaced, target_, no_matter);
    return files::cannot_write(target_, error.value());
  }
  unfinished_.clear();
  fs::remove_all(replaced, no_matter);
  files::synchronise_folder_of(target_);
  return Done{};
}

}  // namespace dermis::datasets
