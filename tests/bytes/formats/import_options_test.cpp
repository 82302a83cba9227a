// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/import_options.hpp"

#include <gtest/gtest.h>

namespace dermis::bytes::formats {
namespace {

std::string error_of(FrameShape found, const std::optional<FrameShape>& wanted = {}) {
  const Status checked = check_shape("f.txt", found, wanted);
  return checked ? "" : checked.error().message;
}

TEST(ImportOptions, frames_must_have_the_shape_of_an_array_and_the_one_that_is_given) {
  EXPECT_EQ(error_of({1, 1}), "");
  EXPECT_EQ(error_of({1024, 1024}), "");
  EXPECT_EQ(error_of({3, 4}, FrameShape{3, 4}), "");
  EXPECT_EQ(error_of({3, 4}, FrameShape{4, 3}), "f.txt: has 3x4 taxels, the array is 4x3");
  EXPECT_EQ(error_of({0, 4}), "f.txt: has frames of 0x4 taxels; 1x1 to 1024x1024 can be read");
  EXPECT_EQ(error_of({4, 1025}), "f.txt: has frames of 4x1025 taxels; 1x1 to 1024x1024 can be read");
}

}  // namespace
}  // namespace dermis::bytes::formats
