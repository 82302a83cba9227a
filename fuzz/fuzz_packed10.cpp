// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/imports.hpp"
#include "fuzz_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dermis::fuzz::import_frames(dermis::bytes::formats::open_packed10, {data, size},
                                     {.shape = dermis::FrameShape{2, 3}, .rate_hz = 100.0});
}
