// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>

#include "check_error.hpp"
#include "dermis/bytes/formats/imports.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto picture = dermis::bytes::formats::read_grey_png({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!picture) dermis::fuzz::check_error(picture.error());
  if (picture && picture->levels.size() != picture->shape.taxel_count()) std::abort();
  return 0;
}
