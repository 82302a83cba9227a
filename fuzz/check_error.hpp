// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdlib>

#include "dermis/touch/frames/result.hpp"

namespace dermis::fuzz {

/// Whatever was asked for, the user gets one line.
inline void check_line(const Error& error) {
  const bool is_one_line = error.message.find('\n') == std::string::npos;
  if (error.kind != ErrorKind::bad_input || !is_one_line || error.message.empty()) std::abort();
}

/// Whatever the bytes are, the user gets one line that begins with the name of the file.
inline void check_error(const Error& error) {
  check_line(error);
  if (!error.message.starts_with("fuzz:")) std::abort();
}

}  // namespace dermis::fuzz
