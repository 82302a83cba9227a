// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/known_arrays.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

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

}  // namespace

std::vector<KnownArray> known_arrays() {
  std::vector<KnownArray> known;
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

}  // namespace dermis::out::serve
