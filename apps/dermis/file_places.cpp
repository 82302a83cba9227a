// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "file_places.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/output_place.hpp"
#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

namespace fs = std::filesystem;

/// How results begin: forces, contacts, answers, answers of splits, answers as JSON, PNG, GIF, reports.
constexpr std::array<std::string_view, 8> kResults = {"time_s,status,",
                                                      "time_s,id,phase,",
                                                      "first,last,time_s,class,",
                                                      "split,id,class,",
                                                      "{\"first\":",
                                                      "\x89PNG",
                                                      "GIF89a",
                                                      "<!DOCTYPE html>\n<html lang=\"en\" xmlns="};

bool is_result(std::string_view first_bytes) {
  const auto begins = [&](std::string_view beginning) { return first_bytes.starts_with(beginning); };
  const bool is_drawing = first_bytes.find("<svg") != std::string_view::npos;
  return is_drawing || std::ranges::any_of(kResults, begins);
}

constexpr std::size_t kLooked = 128;
constexpr std::size_t kMostToml = std::size_t{1} << 20U;

/// Whether both names are of one file, also through links and where it does not exist yet. A terminal is read and
/// written at once.
bool is_same(const std::string& one, const std::string& other) {
  if (one == other) return true;
  std::error_code error;
  if (fs::is_character_file(one, error) || fs::is_socket(one, error)) return false;
  if (fs::equivalent(one, other, error)) return true;
  const fs::path whole = fs::weakly_canonical(one, error);
  return !whole.empty() && whole == fs::weakly_canonical(other, error);
}

bool would_be_lost(const std::string& path) {
  std::error_code error;
  return path != kStandardOutput && fs::is_regular_file(path, error) && fs::file_size(path, error) > 0;
}

/// Those of a path or of a source.
std::vector<std::string> files_of(const std::string& name) {
  const Result<live::sources::SourceName> source = live::sources::SourceName::parse(name);
  return source ? source->files() : std::vector<std::string>();
}

/// The files that a suit.toml names, which are read with it; none for any other file.
std::vector<std::string> files_of_suit(const std::string& path) {
  const Result<std::string> text = bytes::files::read_file(path, kMostToml);
  if (!text) return {};
  std::vector<std::string> named;
  const auto read_positions = [&](const std::string& positions) {
    named.push_back(positions);
    return bytes::files::read_positions(positions);
  };
  const Result<SuitDescription> suit = bytes::files::suit_from_toml(*text, path, read_positions);
  if (!suit) return named;
  named.insert(named.end(), {suit->classes, suit->body});
  for (const SuitArray& array : suit->arrays) {
    named.insert(named.end(), {array.model, array.classes});
    std::ranges::move(files_of(array.from), std::back_inserter(named));
  }
  return named;
}

std::vector<std::string> files_of(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  for (const std::string& name : names) {
    std::ranges::move(files_of(name), std::back_inserter(files));
    if (name.ends_with(".toml")) std::ranges::move(files_of_suit(name), std::back_inserter(files));
  }
  std::erase(files, "");
  return files;
}

std::vector<std::string> written_at(const std::string& path) {
  return path.empty() ? std::vector<std::string>() : std::vector{path};
}

}  // namespace

void FilePlaces::add_input(const std::string& option, const std::string& name) {
  inputs_.push_back({option, [&name] { return files_of(std::vector{name}); }});
}

void FilePlaces::add_input(const std::string& option, const std::vector<std::string>& names) {
  inputs_.push_back({option, [&names] { return files_of(names); }});
}

void FilePlaces::add_output(const std::string& option, const std::string& path) {
  outputs_.push_back({option, [&path] { return written_at(path); }});
}

void FilePlaces::add_outputs(const std::string& option, std::function<std::vector<std::string>()> paths) {
  outputs_.push_back({option, std::move(paths)});
}

void FilePlaces::add_model_output(const std::string& option, const std::string& path) {
  outputs_.push_back({option, [&path] { return written_at(path); }, true});
}

void FilePlaces::add_output_folder(const std::string& option, const std::string& folder,
                                   std::vector<std::string> files) {
  const auto paths = [&folder, files = std::move(files)] {
    std::vector<std::string> some;
    if (folder.empty()) return some;
    for (const std::string& file : files) some.push_back((fs::path(folder) / file).string());
    return some;
  };
  const auto was_simulated = [&folder] {
    std::error_code error;
    return fs::exists(fs::path(folder) / "origin.toml", error);
  };
  outputs_.push_back({option, paths, false, was_simulated});
}

Status FilePlaces::check_one_uses(const std::string& stream, const std::vector<Place>& places, const char* use) {
  std::string user;
  for (const Place& place : places) {
    for (const std::string& path : place.paths()) {
      if (path != stream) continue;
      if (!user.empty()) return bad_input(fmt::format("{}: {} {}; name a file", place.option, user, use));
      user = place.option;
    }
  }
  return Done{};
}

Status FilePlaces::check_distinct() const {
  std::vector<Place> others = inputs_;
  for (const Place& output : outputs_) {
    for (const std::string& path : output.paths()) {
      for (const Place& other : others) {
        if (std::ranges::any_of(other.paths(), [&](const std::string& taken) { return is_same(path, taken); })) {
          return bad_input(fmt::format("{}: is the file of {}; name another", output.option, other.option));
        }
      }
    }
    others.push_back(output);
  }
  return Done{};
}

/// Models have their names taken by their commands, some of which are several processes.
Status FilePlaces::claim() const {
  for (const Place& output : outputs_) {
    if (output.is_model) continue;
    for (const std::string& path : output.paths()) {
      const fs::path folder = fs::path(path).parent_path();
      std::error_code error;
      if (!folder.empty() && !fs::exists(folder, error)) continue;  // the command makes it, or says what is missing
      if (Status claimed = bytes::files::claim_output(path, bytes::files::EarlierFile::stays_unread); !claimed) {
        return claimed;
      }
    }
  }
  return Done{};
}

Status FilePlaces::check(bool is_forced) const {
  Status once = check_one_uses(kStandardInput, inputs_, "reads the standard input");
  if (once) once = check_one_uses(kStandardOutput, outputs_, "writes the standard output");
  if (!once) return once;
  if (Status distinct = check_distinct(); !distinct) return distinct;
  if (Status claimed = claim(); !claimed) return claimed;
  std::vector<std::string> replaced;
  for (const Place& output : outputs_) {
    if (output.can_be_made_again && output.can_be_made_again()) continue;
    for (const std::string& path : output.paths()) {
      if (!would_be_lost(path)) continue;
      const std::string first_bytes = bytes::files::first_bytes_of(path, kLooked);
      if (output.is_model && bytes::files::kind_of(first_bytes) == bytes::files::kSafetensorsKind) continue;
      if (!is_forced && !is_result(first_bytes)) {
        return bad_input(fmt::format("{}: '{}' exists; name another, or replace it with --force", output.option, path));
      }
      replaced.push_back(path);
    }
  }
  for (const std::string& path : replaced) print_notice(fmt::format("'{}' exists and will be replaced", path));
  return Done{};
}

}  // namespace dermis::app
