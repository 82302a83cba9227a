// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <string>

#include "check_error.hpp"
#include "dermis/bytes/files/suit_toml.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto suit =
      dermis::bytes::files::suit_from_toml({reinterpret_cast<const char*>(data), size}, "fuzz", [](const std::string&) {
        return std::vector<dermis::Vector3>{{0.0, 0.0, 0.0}};
      });
  if (!suit) {
    dermis::fuzz::check_error(suit.error());
  } else if (!suit->validate()) {
    std::abort();
  }
  return 0;
}
