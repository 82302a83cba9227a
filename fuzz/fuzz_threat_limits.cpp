// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>

#include "check_error.hpp"
#include "dermis/live/threats/threat_limits.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto limits =
      dermis::live::threats::threat_limits_from_toml({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!limits) {
    dermis::fuzz::check_error(limits.error());
  } else if (!limits->validate()) {
    std::abort();
  }
  return 0;
}
