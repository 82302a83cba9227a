// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "check_error.hpp"
#include "dermis/live/fleet/model_manifest.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using dermis::live::fleet::manifest_from_json;
  const auto manifest = manifest_from_json({reinterpret_cast<const char*>(data), size});
  if (!manifest) {
    dermis::fuzz::check_line(manifest.error());
    return 0;
  }
  const auto again = manifest_from_json(manifest_to_json(*manifest));
  if (!again || again->current_model().sha256 != manifest->current_model().sha256) std::abort();
  return 0;
}
