// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/byte_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace dermis::bytes::layouts {
namespace {

TEST(ByteWindow, holds_the_bytes_that_were_pushed_and_not_dropped) {
  ByteWindow window;
  std::vector<std::uint8_t> kept;
  std::uint64_t dropped = 0;
  for (std::size_t round = 0; round < 200; ++round) {
    std::vector<std::uint8_t> bytes(1 + round * 37 % 5000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(round + i);
    window.push(bytes);
    kept.insert(kept.end(), bytes.begin(), bytes.end());
    const std::size_t gone = kept.size() * (round % 4) / 3;
    window.drop(gone);
    kept.erase(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(gone));
    dropped += gone;
    ASSERT_TRUE(std::equal(kept.begin(), kept.end(), window.bytes().begin(), window.bytes().end())) << round;
    ASSERT_EQ(window.position(), dropped);
  }
}

}  // namespace
}  // namespace dermis::bytes::layouts
