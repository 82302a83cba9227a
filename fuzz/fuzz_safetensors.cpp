// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>

#include "check_error.hpp"
#include "dermis/bytes/files/safetensors.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = dermis::bytes::files::safetensors_from_bytes({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!file) dermis::fuzz::check_error(file.error());
  return 0;
}
