// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <filesystem>
#include <string>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// A folder that is missing or full is an error before the work, not after it.
inline Status check_writable(const std::string& path) {
  const bool is_special = std::filesystem::exists(path) && !std::filesystem::is_regular_file(path);
  if (is_special) return Done{};
  const Result<bytes::files::AtomicFile> writable = bytes::files::AtomicFile::create(path);
  if (!writable) return writable.error();
  return Done{};
}

}  // namespace dermis::app
