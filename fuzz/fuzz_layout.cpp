// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A layout up to the first byte of 0, then how the bytes are cut, then the bytes.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>

#include "check_error.hpp"
#include "decoding.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace {
constexpr std::size_t kMostTaxels = 4096;  // quickly looked at
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dermis::fuzz;
  const auto* const end = std::find(data, data + size, 0);
  auto layout = dermis::bytes::layouts::layout_from_toml(
      {reinterpret_cast<const char*>(data), static_cast<std::size_t>(end - data)}, "fuzz");
  if (!layout) {
    check_error(layout.error());
    return 0;
  }
  if (data + size - end < 2) return 0;
  for (const dermis::bytes::layouts::LayoutArray& array : layout->arrays) {
    if (array.shape.taxel_count() > kMostTaxels) return 0;
  }
  const auto shared = std::make_shared<const dermis::bytes::layouts::Layout>(*std::move(layout));
  const std::size_t array = shared->arrays.size() - 1;
  const Bytes bytes(end + 2, data + size);
  const std::size_t piece = 1 + end[1] * std::size_t{end[1]} / 16;
  for (const bool is_ordered : {false, true}) {
    const auto whole = dermis::bytes::layouts::make_decoder(shared, array, is_ordered);
    const auto cut = dermis::bytes::layouts::make_decoder(shared, array, is_ordered);
    const std::size_t middle = is_ordered ? bytes.size() : bytes.size() / 2;
    require(decode(*whole, bytes, middle, bytes.size()) == decode(*cut, bytes, middle, piece));
    static_cast<void>(whole->advice());
  }
  return 0;
}
