// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>

#include "check_error.hpp"
#include "dermis/files/array_toml.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto array = dermis::files::array_from_toml({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!array) {
    dermis::fuzz::check_error(array.error());
  } else if (!dermis::files::array_from_toml(dermis::files::array_to_toml(*array), "fuzz")) {
    std::abort();
  }
  return 0;
}
