// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/encoder.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "dermis/bytes/devices/protocol.hpp"

namespace dermis::bytes::devices {
namespace {

TEST(Encoder, appends_and_clamps_to_what_the_protocol_carries) {
  const auto encoder = make_encoder({.name = "flexitac", .shape = FrameShape{1, 6}});
  ASSERT_TRUE(encoder);
  RawFrame frame;
  frame.counts = {-3.0F, 0.4F, 0.6F, 254.7F, 1e9F, std::numeric_limits<float>::quiet_NaN()};
  std::vector<std::uint8_t> bytes = {42};
  (*encoder)->encode(frame, bytes);
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{42, 0xAA, 0x55, 0, 0, 1, 255, 255, 0}));
}

}  // namespace
}  // namespace dermis::bytes::devices
