// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "dermis/bytes/files/kept_copy.hpp"
#include "dermis/bytes/files/output_place.hpp"
#include "dermis/touch/frames/result.hpp"
#include "status_line.hpp"

namespace dermis::app {

/// A folder that is missing or full, or a model that another process writes, is an error before the work, not after it.
inline Status claim_model(const std::string& path) {
  return bytes::files::claim_output(path, bytes::files::EarlierFile::may_be_read);
}

/// Keeps a copy of what is there, and says where, before a new model or new classes take its name.
inline Status keep_earlier_model(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return Done{};
  const Result<std::string> copy = bytes::files::keep_copy(path, std::chrono::system_clock::now());
  if (!copy) return copy.error();
  print_notice("'" + path + "' as it was: '" + *copy + "'");
  return Done{};
}

}  // namespace dermis::app
