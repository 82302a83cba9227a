// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Uses the files of its current folder, in which are array.toml and sheet.model, and writes to told.txt what came of
// it: the same here and in a page. Exits with 1 where that cannot be written.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/kept_copy.hpp"
#include "dermis/bytes/models/model_file.hpp"

namespace fs = std::filesystem;
using namespace dermis;  // NOLINT(google-build-using-namespace)

namespace {

std::string told;

void tell(const std::string& text) {
  told += text + "\n";
}

void tell(const Status& status) {
  tell(status ? "done" : status.error().message);
}

void tell_of_paths() {
  const std::vector<std::string> texts{"",
                                       ".",
                                       "..",
                                       "/",
                                       "a",
                                       "a/",
                                       "/a",
                                       "/a/",
                                       "//a//b",
                                       "a/b",
                                       "a/./b",
                                       "a/../b",
                                       "../a",
                                       "/../a",
                                       "a/..",
                                       "a/b/../c",
                                       "a/b/..",
                                       "./a",
                                       "a/.",
                                       ".a",
                                       "a.b.c",
                                       "a.",
                                       "...",
                                       "..a",
                                       "a/.b",
                                       "a/b.c/",
                                       "a.b/c.d",
                                       "a//",
                                       "./",
                                       "a/../..",
                                       "../..",
                                       "a/b/../../../c",
                                       "/a/../..",
                                       "/a.b/..c",
                                       "a/..b.",
                                       "x/y.z",
                                       "/a/b/c.tar.gz"};
  for (const fs::path path : texts) {
    std::string names;
    for (const fs::path& name : path) names += "<" + name.string() + ">";
    tell(path.string() + ": " + path.root_path().string() + " " + path.relative_path().string() + " " +
         path.parent_path().string() + " " + path.filename().string() + " " + path.stem().string() + " " +
         path.extension().string() + " " + path.lexically_normal().string() + " " + names + " " +
         fs::path(path).replace_extension("new").string() + " " + (path / "z").string() +
         (path.is_absolute() ? " absolute" : ""));
    for (const fs::path other : texts) {
      const int order = path.compare(other);
      tell(path.lexically_relative(other).string() + (order < 0 ? " <" : order > 0 ? " >" : " ="));
    }
  }
}

void tell_of_folder(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string() + (entry->is_directory() ? "/" : "") +
                    (entry->is_regular_file() ? " " + std::to_string(entry->file_size()) : ""));
  }
  std::ranges::sort(names);
  for (const std::string& name : names) tell(folder.string() + " has " + name);
  if (error) tell(folder.string() + ": " + error.message());
}

Status write(const std::string& path, const std::string& text) {
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path);
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

void tell_of_outputs() {
  tell(write("out/text", "first"));
  tell(write("out/text", "the second is longer"));
  tell(write("nowhere/text", "none"));
  tell(write("out", "none"));
  {
    Result<bytes::files::AtomicFile> first = bytes::files::AtomicFile::create("out/two");
    tell(write("out/two", "of two writers"));
    first->write("one of ");
    first->write_at(2, "-");
    tell_of_folder("out");
    tell(first->commit());
  }
  tell_of_folder("out");
  tell(*bytes::files::read_file("out/two", 100));
  const auto time = std::chrono::system_clock::time_point(std::chrono::seconds(1'700'000'000));
  tell(*bytes::files::keep_copy("out/text", time));
  tell(*bytes::files::keep_copy("out/text", time));
  const auto none = bytes::files::read_file("out/none", 100);
  tell(none ? "there" : none.error().message);
  const auto folder = bytes::files::read_file("out", 100);
  tell(folder ? "there" : folder.error().message);
}

void tell_of_files() {
  std::error_code error;
  fs::create_directories("out/a/b/c", error);
  std::ofstream("out/a/b/text") << "some";
  fs::last_write_time("out/a/b/text", fs::file_time_type(std::chrono::seconds(5)), error);
  tell(fs::last_write_time("out/a/b/text") == fs::file_time_type(std::chrono::seconds(5)) ? "old" : "new");
  fs::rename("out/a", "out/moved", error);
  tell_of_folder("out/moved/b");
  tell(std::string(fs::equivalent("out/moved/b/text", "out/./moved/b/text") ? "same" : "other") +
       (fs::exists("out/a") ? " there" : " gone") + (fs::is_empty("out/moved/b/c") ? " empty" : " full"));
  tell(fs::remove("out/moved", error) ? "removed" : error.message());
  tell(std::to_string(fs::remove_all("out/moved", error)) + (fs::remove("out/none", error) ? "" : " not there"));
  fs::rename("out/none", "out/other", error);
  tell(error.message());
  tell(fs::canonical("out/none", error).string() + error.message());
  tell(fs::canonical("out/./../out/text").filename().string());
  tell_of_folder("out");
  tell_of_folder("none");
}

void tell_of_copies() {
  const auto array = bytes::files::read_array("array.toml");
  tell(array ? bytes::files::write_array("out/array.toml", *array) : Status(array.error()));
  const auto model = bytes::models::read_model("sheet.model");
  tell(model ? bytes::models::write_model("out/sheet.model", *model) : Status(model.error()));
  const auto wrong = bytes::files::read_array("sheet.model");
  tell(wrong ? "array" : wrong.error().message);
  tell(write("out/wrong.toml", "[array]\nname = \n"));
  const auto no_toml = bytes::files::read_array("out/wrong.toml");
  tell(no_toml ? "array" : no_toml.error().message);
}

}  // namespace

int main() {
  std::filesystem::create_directory("out");
  tell_of_paths();
  tell_of_outputs();
  tell_of_files();
  tell_of_copies();
  return write("told.txt", told) ? 0 : 1;
}
