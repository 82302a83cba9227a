// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace dermis::bytes::files {
namespace {

template <typename Number>
std::optional<Number> parsed(std::string_view text) {
  Number value{};
  return parse_number(text, value) ? std::optional(value) : std::nullopt;
}

TEST(Numbers, real_ones_have_a_sign_a_point_and_an_exponent_where_they_like) {
  for (const auto& [text, value] : {std::pair{"12", 12.0},
                                    {"-0.5", -0.5},
                                    {"3.", 3.0},
                                    {".25", 0.25},
                                    {"1e3", 1000.0},
                                    {"16777217", 16777217.0},
                                    {"00012", 12.0}}) {
    EXPECT_EQ(parsed<double>(text), value) << text;
    EXPECT_EQ(parsed<float>(text), static_cast<float>(value)) << text;
  }
  EXPECT_TRUE(std::isnan(*parsed<float>("nan")));
  EXPECT_TRUE(std::isinf(*parsed<double>("-inf")));
  for (const char* text : {"", "+1", " 1", "1 ", "1,5", "0x1", "1e", "e1", "1e400", "--1"}) {
    EXPECT_FALSE(parsed<double>(text)) << text;
    EXPECT_FALSE(parsed<float>(text)) << text;
  }
}

TEST(Numbers, whole_ones_are_digits_that_their_type_holds) {
  EXPECT_EQ(parsed<std::size_t>("18446744073709551615"), SIZE_MAX);
  EXPECT_EQ(parsed<int>("-7"), -7);
  for (const char* text : {"", "-1", "+1", "1.0", "18446744073709551616", "0x10", "1 "}) {
    EXPECT_FALSE(parsed<std::size_t>(text)) << text;
  }
  EXPECT_EQ(number_within<int>("5", 5, 6), 5);
  EXPECT_FALSE(number_within<int>("7", 5, 6));
  EXPECT_FALSE(number_within<double>("nan", 0.0, 1.0));
}

TEST(Numbers, one_that_a_text_begins_with_ends_where_it_cannot_go_on) {
  unsigned whole = 9;
  EXPECT_EQ(number_at("12:30", whole), 2U);
  EXPECT_EQ(whole, 12U);
  EXPECT_EQ(number_at("x12", whole), 0U);
  EXPECT_EQ(whole, 12U);
  EXPECT_EQ(hexadecimal_at("0Fg", whole), 2U);
  EXPECT_EQ(whole, 15U);
  EXPECT_FALSE(parse_hexadecimal("0x1F", whole));
  EXPECT_TRUE(parse_hexadecimal("1f", whole));
  EXPECT_EQ(whole, 31U);
}

TEST(Numbers, decimals_of_devices_have_few_digits) {
  const auto taken = [](const std::string& text, std::ptrdiff_t most) -> std::optional<double> {
    const std::string line = text + "\n";
    const auto* at = reinterpret_cast<const std::uint8_t*>(line.data());
    double value = 0.0;
    const bool is_one = take_decimal(at, most, value) && *at == '\n';
    return is_one ? std::optional(value) : std::nullopt;
  };
  EXPECT_EQ(taken("00000007", 8), 7.0);
  EXPECT_EQ(taken("12.25", 8), 12.25);
  EXPECT_EQ(taken("999999999999999", 15), 999999999999999.0);
  for (const char* text : {"", "-1", "123456789", "1.", ".5", "1.123456789", "1e3", "nan"}) {
    EXPECT_FALSE(taken(text, 8)) << text;
  }
}

}  // namespace
}  // namespace dermis::bytes::files
