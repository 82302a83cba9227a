// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "bytes/recordings/bag_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto& reading : dermis::bytes::recordings::readings_of_json(text)) {
    if (reading.shape.taxel_count() == 0 || reading.frame.counts.size() != reading.shape.taxel_count()) std::abort();
  }
  return 0;
}
