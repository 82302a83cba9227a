// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/known_arrays.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "out/serve/requests/json_request.hpp"
#include "out/serve/suit/model_or_array.hpp"

namespace dermis::out::serve {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 100;

struct Candidate {
  fs::path path;
  bool is_model = false;
  fs::file_time_type changed{};
};

/// Models before descriptions, the newest first.
std::vector<Candidate> candidates() {
  std::vector<Candidate> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(".", error)) {
    const bool is_model = entry.path().extension() == ".safetensors";
    std::error_code gone;
    if ((!is_model && entry.path().extension() != ".toml") || !entry.is_regular_file(gone)) continue;
    found.push_back({entry.path().filename(), is_model, entry.last_write_time(gone)});
  }
  std::ranges::sort(found, [](const Candidate& a, const Candidate& b) {
    if (a.is_model != b.is_model) return a.is_model;
    return a.changed != b.changed ? a.changed > b.changed : a.path < b.path;
  });
  if (found.size() > kMostFiles) found.resize(kMostFiles);
  return found;
}

/// An array.toml describes it, beside an array.suit.toml, too.
std::optional<KnownArray> array_of(live::sources::ArrayFolder folder) {
  const std::string file = folder.is_suit() ? (fs::path(folder.path) / "array.toml").string() : folder.model;
  Result<ModelOrArray> read = read_model_or_array(file);
  if (!read) return std::nullopt;
  return KnownArray{folder.model, std::move(read->array), folder.is_calibrated(), std::move(folder)};
}

std::vector<KnownArray> arrays_of_folders() {
  std::vector<fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(".", error)) {
    const std::string path = entry.path().filename().string();
    if (live::sources::is_array_folder(path)) paths.emplace_back(path);
    if (paths.size() == kMostFiles) break;
  }
  std::ranges::sort(paths, std::greater<>(), [](const fs::path& path) {
    std::error_code gone;
    return std::pair(fs::last_write_time(path, gone), path);
  });
  std::vector<KnownArray> known;
  for (const fs::path& path : paths) {
    Result<live::sources::ArrayFolder> folder = live::sources::read_array_folder(path.string());
    if (!folder) continue;
    if (std::optional<KnownArray> one = array_of(*std::move(folder))) known.push_back(*std::move(one));
  }
  return known;
}

}  // namespace

std::vector<KnownArray> known_arrays() {
  std::vector<KnownArray> known = arrays_of_folders();
  for (const Candidate& candidate : candidates()) {
    Result<ModelOrArray> read = read_model_or_array(candidate.path.string());
    if (!read) continue;  // of something else
    const auto has_its_name = [&](const KnownArray& one) { return one.array.name == read->array.name; };
    if (std::ranges::any_of(known, has_its_name)) continue;
    known.push_back({candidate.path.string(), std::move(read->array), candidate.is_model});
  }
  return known;
}

Result<KnownArray> known_array(const std::string& file) {
  std::vector<KnownArray> known = known_arrays();
  const auto found = std::ranges::find(known, file, &KnownArray::file);
  if (found == known.end()) return bad_field("file", "is none of the arrays of this folder");
  return std::move(*found);
}

std::string known_arrays_json() {
  nlohmann::ordered_json answer;
  answer["arrays"] = nlohmann::ordered_json::array();
  for (const KnownArray& known : known_arrays()) {
    answer["arrays"].push_back({{"file", known.file},
                                {"name", known.array.name},
                                {"rows", known.array.rows},
                                {"cols", known.array.cols},
                                {"calibrated", known.is_calibrated},
                                {"from", known.folder ? known.folder->from : ""}});
  }
  return json_text(answer);
}

Result<std::string> new_array_file(const std::string& array, const char* name) {
  std::string path = (fs::path(array) / name).string();
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return path;
  return bad_field("name", path + " is there already: choose another name, or take the array from last time");
}

Status make_array_folder(const std::string& array) {
  std::error_code error;
  fs::create_directory(array, error);
  if (!error) return Done{};
  return failed(fmt::format("cannot make the folder '{}' of the array: {}", array, error.message()));
}

}  // namespace dermis::out::serve
