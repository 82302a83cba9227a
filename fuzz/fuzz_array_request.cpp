// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <string_view>

#include "check_error.hpp"
#include "out/serve/requests/array_request.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto array = dermis::out::serve::array_request(text); !array) dermis::fuzz::check_line(array.error());
  if (const auto shape = dermis::out::serve::shape_request(text); !shape) dermis::fuzz::check_line(shape.error());
  return 0;
}
