// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "serve/array_request.hpp"

namespace {

void check(const dermis::Error& error) {
  const bool is_one_line = error.message.find('\n') == std::string::npos;
  if (error.kind != dermis::ErrorKind::bad_input || !is_one_line || error.message.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto array = dermis::serve::array_request(text); !array) check(array.error());
  if (const auto shape = dermis::serve::shape_request(text); !shape) check(shape.error());
  return 0;
}
