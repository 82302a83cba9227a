// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/layout_encoder.hpp"

#include <gtest/gtest.h>

#include "bytes/layouts/vectors.hpp"

namespace dermis::bytes::devices {
namespace {

class OfShipped : public testing::TestWithParam<layouts::ShippedLayout> {};

INSTANTIATE_TEST_SUITE_P(LayoutEncoder, OfShipped, testing::ValuesIn(layouts::shipped_layouts()), layouts::test_name);

TEST_P(OfShipped, sends_the_vector) {
  const layouts::Vector vector = layouts::vector_of(GetParam());
  LayoutEncoder encoder(GetParam().of(vector.shape));
  std::vector<std::uint8_t> sent;
  for (const RawFrame& frame : vector.frames) encoder.encode(frame, sent);
  EXPECT_EQ(sent, vector.bytes);
}

}  // namespace
}  // namespace dermis::bytes::devices
