// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/output_folder.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/output_place.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/out/datasets/summary.hpp"

namespace dermis::out::datasets {
namespace {

namespace fs = std::filesystem;

std::string without_slash(const std::string& folder) {
  const std::size_t last = folder.find_last_not_of('/');
  return folder.substr(0, last == std::string::npos ? 1 : last + 1);
}

}  // namespace

Result<std::unique_ptr<OutputFolder>> OutputFolder::create(const std::string& folder) {
  if (folder.empty()) return bad_input("the folder of the dataset has no name");
  std::string target = without_slash(folder);
  std::error_code error;
  if (fs::exists(target, error) && !(fs::is_directory(target, error) && fs::is_empty(target, error))) {
    return bad_input(bytes::files::in_quotes(folder) + " exists and is no empty folder; name another");
  }
  const fs::path parent = fs::path(target).parent_path();
  if (!parent.empty()) fs::create_directories(parent, error);
  if (error) return bytes::files::cannot_write(parent.string(), error.value());
  Result<bytes::files::UnfinishedFile> unfinished = bytes::files::UnfinishedFile::begin_folder(target);
  if (!unfinished) return unfinished.error();
  return std::unique_ptr<OutputFolder>(new OutputFolder(std::move(target), *std::move(unfinished)));
}

std::string OutputFolder::place(const std::string& name) const {
  const fs::path path = fs::path(unfinished_.path()) / name;
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
  if (!file) return bytes::files::cannot_write(path, errno);
  return Done{};
}

Status OutputFolder::commit() {
  const Result<bytes::files::Placed> placed = unfinished_.take_place();
  if (!placed) return placed.error();
  bytes::files::synchronise_folder_of(target_);
  return placed->told;
}

Status OutputFolder::commit(const EpisodeTally& tally, const std::string& notes) {
  Status written = write(notes + "tactile.json", summary_json(tally));
  if (written) written = write("summary.html", summary_page(tally, fs::path(target_).filename().string()));
  return written ? commit() : written;
}

}  // namespace dermis::out::datasets
