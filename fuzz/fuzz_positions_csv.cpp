// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <sstream>
#include <string>

#include "check_error.hpp"
#include "dermis/bytes/files/suit_toml.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::istringstream bytes(text);
  const auto places = dermis::bytes::files::read_positions(bytes, "fuzz");
  if (!places) dermis::fuzz::check_error(places.error());
  std::istringstream again(text);
  const auto named = dermis::bytes::files::read_places(again, "fuzz");
  if (!named) dermis::fuzz::check_error(named.error());
  return 0;
}
