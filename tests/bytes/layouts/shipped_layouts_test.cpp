// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/shipped_layouts.hpp"

#include <gtest/gtest.h>

#include "bytes/layouts/vectors.hpp"

namespace dermis::bytes::layouts {
namespace {

class Shipped : public testing::TestWithParam<ShippedLayout> {};

INSTANTIATE_TEST_SUITE_P(Layout, Shipped, testing::ValuesIn(shipped_layouts()), test_name);

TEST_P(Shipped, reads_its_vector) {
  const Vector vector = vector_of(GetParam());
  const auto decoder = make_decoder({GetParam().of(vector.shape)});
  decoder->push(vector.bytes);
  decoder->finish();
  RawFrame frame;
  for (const RawFrame& expected : vector.frames) {
    ASSERT_TRUE(decoder->next(frame));
    EXPECT_EQ(frame.counts, expected.counts);
  }
  EXPECT_FALSE(decoder->next(frame));
  EXPECT_EQ(decoder->counts(), (DecoderCounts{.frames = vector.frames.size()}));
}

}  // namespace
}  // namespace dermis::bytes::layouts
