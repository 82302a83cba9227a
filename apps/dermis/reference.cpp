// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "reference.hpp"

#include <filesystem>
#include <string_view>
#include <system_error>

#include "dermis/bytes/files/atomic_file.hpp"

namespace dermis::app {
namespace {

Status write_text(const std::filesystem::path& path, std::string_view text) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error) return failed("cannot create '" + path.parent_path().string() + "': " + error.message());
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path.string());
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

}  // namespace

Status write_reference(const CommandTable& dermis, const std::string& prefix) {
  const std::filesystem::path share = std::filesystem::path(prefix) / "share";
  for (const ManualPage& page : manual_pages(dermis)) {
    if (Status written = write_text(share / "man/man1" / (page.name + ".1"), page.text); !written) return written;
  }
  for (const ManualPage& page : command_documents(dermis)) {
    if (Status written = write_text(share / "doc/dermis" / page.name, page.text); !written) return written;
  }
  const Status bash = write_text(share / "bash-completion/completions/dermis", bash_completion(dermis));
  return bash ? write_text(share / "zsh/site-functions/_dermis", zsh_completion(dermis)) : bash;
}

}  // namespace dermis::app
