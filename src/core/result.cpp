// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/core/result.hpp"

#include <algorithm>

namespace dermis {
namespace {

std::string one_line(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20U || c == 0x7FU; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

}  // namespace

Error bad_input(std::string message) {
  return {ErrorKind::bad_input, one_line(std::move(message))};
}

Error failed(std::string message) {
  return {ErrorKind::failed, one_line(std::move(message))};
}

}  // namespace dermis
