// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::files {
namespace {

TEST(Text, is_quoted_for_toml_with_escapes_for_what_a_string_cannot_hold) {
  EXPECT_EQ(quoted_toml("a \"b\" \\ \t\r\n\x7F\x01"), R"("a \"b\" \\ \t\r\u000A\u007F\u0001")");
}

TEST(Text, quotes_are_put_around_and_long_text_is_cut) {
  EXPECT_EQ(in_quotes("a.csv"), "'a.csv'");
  EXPECT_EQ(in_quotes(std::string(10'000, 'x')), "'" + std::string(200, 'x') + "...'");
}

TEST(Text, blanks_at_both_ends_are_trimmed) {
  EXPECT_EQ(trimmed(" \t a b\f\r"), "a b");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed("\r \f"), "");
  EXPECT_FALSE(is_blank('\n'));
}

TEST(Text, a_number_is_the_whole_text) {
  double value = 7.0;
  EXPECT_TRUE(parse_number("-1.5e3", value));
  EXPECT_EQ(value, -1500.0);
  for (const char* text : {"", " 1", "1 ", "1x", "0x10", "1,5"}) EXPECT_FALSE(parse_number(text, value)) << text;
  std::size_t count = 0;
  EXPECT_TRUE(parse_number("18446744073709551615", count));
  EXPECT_FALSE(parse_number("-1", count));
  EXPECT_FALSE(parse_number("18446744073709551616", count));
}

TEST(Text, numbers_are_read_back_with_every_bit) {
  const std::uint64_t seed = 1;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Random random(seed);
  for (int i = 0; i < 10'000; ++i) {
    const double written = random.normal() * std::pow(10.0, 300.0 * (2.0 * random.uniform() - 1.0));
    std::string text;
    append_number(text, written);
    double value = 0.0;
    ASSERT_TRUE(parse_number(text, value)) << text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(written)) << text;
  }
}

TEST(Text, every_nan_is_written_alike) {
  std::string text;
  append_number(text, -std::numeric_limits<double>::quiet_NaN());
  append_number(text, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(text, "nannan");
}

TEST(Text, seconds_are_exact_to_the_nanosecond) {
  Nanos time{};
  ASSERT_TRUE(parse_seconds("8999999999.123456789", time));
  EXPECT_EQ(time.count(), 8'999'999'999'123'456'789);
  std::string text;
  append_seconds(text, time);
  EXPECT_EQ(text, "8999999999.123456789");
  text.clear();
  append_seconds(text, Nanos(1'500'000'000));
  EXPECT_EQ(text, "1.5");
}

TEST(Text, what_is_no_time_gives_none) {
  Nanos time{};
  for (const char* text : {"nan", "inf", "1e10", "-1e10", "", "one"}) EXPECT_FALSE(parse_seconds(text, time)) << text;
  EXPECT_FALSE(nanos_from_seconds(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(nanos_from_seconds(9.1e9));
  EXPECT_EQ(nanos_from_seconds(1e-9), Nanos(1));
}

TEST(Text, whole_microseconds_become_the_nearest_double) {
  EXPECT_EQ(seconds_of(Nanos(100'000'000)), 0.1);
  EXPECT_EQ(seconds_of(Nanos(1'234'567'000)), 1.234567);
}

}  // namespace
}  // namespace dermis::bytes::files
