// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Clocks and dates of a line.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "bytes/layouts/line_match.hpp"
#include "dermis/bytes/files/numbers.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::layouts {

using files::digit;

/// "18:45:00", with a fraction behind a point or comma.
bool LineMatch::read_clock(std::uint64_t& nanos) noexcept {
  const auto part = [&](std::uint64_t most, std::uint64_t& value) {
    std::optional<std::uint64_t> whole;
    if (!read_whole(whole, {}) || *whole > most) return false;
    value = *whole;
    return true;
  };
  std::uint64_t hours = 0;
  std::uint64_t minutes = 0;
  std::uint64_t seconds = 0;
  const auto colon = [&] { return at_ != end_ && *at_++ == ':'; };
  if (!part(23, hours) || !colon() || !part(59, minutes) || !colon() || !part(60, seconds)) {
    return fail("a time of day is expected, as 18:45:00");
  }
  nanos = ((hours * 60 + minutes) * 60 + seconds) * 1'000'000'000;
  if (at_ == end_ || (*at_ != '.' && *at_ != ',') || at_ + 1 == end_ || digit(at_[1]) > 9) return true;
  std::uint64_t unit = 100'000'000;
  for (++at_; at_ != end_ && digit(*at_) <= 9; ++at_, unit /= 10) nanos += unit * digit(*at_);
  return true;
}

bool LineMatch::read_datetime(std::uint64_t& nanos) noexcept {
  std::optional<std::uint64_t> year;
  std::optional<std::uint64_t> month;
  std::optional<std::uint64_t> day;
  const auto dash = [&] { return at_ != end_ && *at_++ == '-'; };
  if (!read_whole(year, {}) || !dash() || !read_whole(month, {}) || !dash() || !read_whole(day, {}) || at_ == end_) {
    return fail("a date and time is expected, as 2026-11-27 18:45:00");
  }
  ++at_;
  if (!read_clock(nanos)) return false;
  std::int64_t east_ns = 0;
  if (!read_zone(east_ns)) return false;
  if (*year < 1970 || *year > 2200 || *month > 12 || *day > 31) return fail("a date after 1970 is expected");
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return fail("there is no such date");
  nanos += static_cast<std::uint64_t>(Nanos(std::chrono::sys_days(date).time_since_epoch()).count() - east_ns);
  return true;
}

/// "Z", "+01:00", "-0330", or nothing.
bool LineMatch::read_zone(std::int64_t& east_ns) noexcept {
  if (at_ == end_) return true;
  if (*at_ == 'Z') return ++at_, true;
  const bool is_west = *at_ == '-';
  if (!is_west && *at_ != '+') return true;
  std::array<std::uint32_t, 4> digits{};
  ++at_;
  for (std::size_t k = 0; k < digits.size(); ++k, ++at_) {
    if (k == 2 && at_ != end_ && *at_ == ':') ++at_;
    if (at_ == end_ || digit(*at_) > 9) return fail("a time zone is expected, as +01:00");
    digits[k] = digit(*at_);
  }
  const std::int64_t minutes = 60 * (10 * digits[0] + digits[1]) + 10 * digits[2] + digits[3];
  east_ns = (is_west ? -minutes : minutes) * 60'000'000'000;
  return true;
}

}  // namespace dermis::bytes::layouts
