// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "check_error.hpp"
#include "dermis/bytes/devices/source_uri.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto& uri :
       {dermis::bytes::devices::parse_source_uri(text), dermis::bytes::devices::parse_target_uri(text)}) {
    if (!uri) {
      dermis::fuzz::check_line(uri.error());
      continue;
    }
    if (!dermis::bytes::devices::is_source_uri(text) || uri->path.find('\0') != std::string::npos) std::abort();
    if (!uri->order.validate()) std::abort();
  }
  return 0;
}
