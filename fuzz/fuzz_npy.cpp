// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>

#include "check_error.hpp"
#include "dermis/bytes/files/npy.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Behind the last '[', if there is one, are the words of the axes.
  const std::string all(reinterpret_cast<const char*>(data), size);
  const std::size_t open = std::min(all.rfind('['), all.size());
  auto bytes = std::make_unique<std::istringstream>(all.substr(0, open));
  const std::string axes = all.substr(std::min(open + 1, all.size()));
  const auto reader = dermis::bytes::files::NpyReader::open(std::move(bytes), "fuzz", {100.0, {}, axes});
  if (!reader) {
    dermis::fuzz::check_error(reader.error());
    return 0;
  }
  const std::size_t taxels = (*reader)->shape()->taxel_count();
  dermis::RawFrame frame;
  while (true) {
    const dermis::Result<bool> got_frame = (*reader)->next(frame);
    if (!got_frame) dermis::fuzz::check_error(got_frame.error());
    if (!got_frame || !*got_frame) return 0;
    if (frame.counts.size() != taxels) std::abort();
  }
}
