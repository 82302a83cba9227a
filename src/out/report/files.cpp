// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/files.hpp"

#include <filesystem>
#include <system_error>

#include "dermis/bytes/files/atomic_file.hpp"

namespace dermis::out::report {
namespace {

Status write_file(const std::filesystem::path& path, const std::string& text) {
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path.string());
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

}  // namespace

Status write_files(const std::string& directory, const std::vector<Figure>& figures, const std::string& page) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failed("cannot make the directory '" + directory + "': " + error.message());
  const std::filesystem::path parent(directory);
  for (const Figure& figure : figures) {
    if (figure.panels.empty()) continue;
    const Drawing sheet = side_by_side(figure.panels, figure.columns);
    if (Status written = write_file(parent / figure.file, svg_document(sheet)); !written) return written;
  }
  return write_file(parent / "index.html", page);
}

}  // namespace dermis::out::report
