// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::support {

/// The text with one to four bytes flipped, inserted or deleted.
inline std::string mutated(std::string text, std::uint64_t seed) {
  Random random(seed);
  const std::uint64_t count = 1 + random.below(4);
  for (std::uint64_t i = 0; i < count && !text.empty(); ++i) {
    const auto place = static_cast<std::size_t>(random.below(text.size()));
    const auto byte = static_cast<char>(random.below(256));
    switch (random.below(3)) {
      case 0: text[place] = byte; break;
      case 1: text.insert(place, 1, byte); break;
      default: text.erase(place, 1); break;
    }
  }
  return text;
}

/// Hands `count` mutations of a valid text to `parse`, which returns a Result.
template <typename Parse>
void expect_value_or_one_line_error(const std::string& text, std::uint64_t count, const Parse& parse) {
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const auto result = parse(mutated(text, seed));
    if (result) continue;
    EXPECT_EQ(result.error().kind, ErrorKind::bad_input) << "seed " << seed;
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << "seed " << seed;
    EXPECT_TRUE(result.error().message.starts_with("mutated:")) << "seed " << seed << ": " << result.error().message;
  }
}

}  // namespace dermis::support
