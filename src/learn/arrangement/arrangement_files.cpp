// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cctype>
#include <filesystem>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/learn/arrangement/arrangement.hpp"

namespace dermis::learn::arrangement {
namespace {

/// A letter, then letters, digits and '_', as suit.toml has names.
std::string suit_name(const std::string& name) {
  std::string made;
  for (const char c : name) made += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  const bool is_letter = !made.empty() && std::isalpha(static_cast<unsigned char>(made.front())) != 0;
  return is_letter ? made : "array_" + made;
}

Status write_text(const std::string& path, const std::string& text) {
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path);
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

}  // namespace

ArrangementFiles arrangement_files(const std::string& array) {
  const std::filesystem::path path(array);
  const std::string stem = (path.parent_path() / path.stem()).string();
  return {array, stem + ".positions.csv", stem + ".suit.toml"};
}

Status write_arrangement(const std::string& array, const Arrangement& arrangement, const std::string& from) {
  const ArrangementFiles files = arrangement_files(array);
  if (Status written = bytes::files::write_array(files.array, arrangement.array); !written) return written;
  if (Status written = write_text(files.positions, bytes::files::positions_csv(arrangement.positions)); !written)
    return written;
  const auto beside = [](const std::string& path) {
    return bytes::files::quoted_toml(std::filesystem::path(path).filename().string());
  };
  return write_text(files.suit, "[[array]]\nname = \"" + suit_name(arrangement.array.name) + "\"\nfrom = " +
                                    bytes::files::quoted_toml(from) + "\nmodel = " + beside(files.array) +
                                    "\npositions_mm = " + beside(files.positions) + "\n");
}

}  // namespace dermis::learn::arrangement
