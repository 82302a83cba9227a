// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/result.hpp"

#include <cstddef>
#include <utility>

#include "dermis/touch/frames/one_line.hpp"

namespace dermis {

std::string one_line(std::string text) {
  unsigned char before = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    const bool is_beyond_ascii = before == 0xC2U && byte >= 0x80U && byte < 0xA0U;
    if (byte < 0x20U || byte == 0x7FU || is_beyond_ascii) text[k] = '?';
    if (is_beyond_ascii) text[k - 1] = '?';
    before = byte;
  }
  return text;
}

Error bad_input(std::string message) {
  return {ErrorKind::bad_input, one_line(std::move(message))};
}

Error bad_field(const std::string& field, const std::string& message) {
  Error error = bad_input(field + ": " + message);
  error.field = field;
  return error;
}

Error failed(std::string message) {
  return {ErrorKind::failed, one_line(std::move(message))};
}

}  // namespace dermis
