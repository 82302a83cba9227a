// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <sstream>

#include "check_error.hpp"
#include "dermis/bytes/files/suit_toml.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream bytes(std::string(reinterpret_cast<const char*>(data), size));
  const auto places = dermis::bytes::files::read_positions(bytes, "fuzz");
  if (!places) dermis::fuzz::check_error(places.error());
  return 0;
}
