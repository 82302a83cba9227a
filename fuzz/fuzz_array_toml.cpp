// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>

#include "check_error.hpp"
#include "dermis/bytes/files/array_toml.hpp"

namespace {
constexpr std::size_t kMostTaxels = 4096;  // quickly looked at
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto array = dermis::bytes::files::array_from_toml({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!array) {
    dermis::fuzz::check_error(array.error());
    return 0;
  }
  const auto again = dermis::bytes::files::array_from_toml(dermis::bytes::files::array_to_toml(*array), "fuzz");
  if (!again || again->order != array->order) std::abort();
  const dermis::FrameShape sent = array->order.sent({array->rows, array->cols});
  if (sent.taxel_count() > kMostTaxels) return 0;
  for (const std::size_t place : array->order.sent_places(sent)) {
    if (place >= sent.taxel_count()) std::abort();
  }
  return 0;
}
