// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/matlab.hpp"
#include "fuzz_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto open = [](std::unique_ptr<std::istream> in, const std::string& name,
                       const dermis::bytes::formats::ImportOptions& options) {
    return dermis::bytes::formats::open_matlab(std::move(in), name, options);
  };
  dermis::fuzz::import_frames(open, {data, size}, {.shape = dermis::FrameShape{3, 2}, .rate_hz = 100.0});
  return dermis::fuzz::import_frames(open, {data, size});
}
