// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/parse_utc.hpp"

#include <cstdio>
#include <ctime>

namespace dermis::live::fleet {

std::optional<Nanos> parse_utc(const std::string& text) {
  std::tm tm{};
  double seconds = 0.0;
  char zone = 0;
  int used = 0;
  const int read = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%lf%c%n", &tm.tm_year, &tm.tm_mon, &tm.tm_mday,
                               &tm.tm_hour, &tm.tm_min, &seconds, &zone, &used);
  const bool is_of_calendar = tm.tm_mon >= 1 && tm.tm_mon <= 12 && tm.tm_mday >= 1 && tm.tm_mday <= 31 &&
                              tm.tm_hour >= 0 && tm.tm_hour < 24 && tm.tm_min >= 0 && tm.tm_min < 60;
  const bool is_whole = read == 7 && zone == 'Z' && used == static_cast<int>(text.size());
  if (!is_whole || !is_of_calendar || !(seconds >= 0.0 && seconds < 61.0) || tm.tm_year < 1970 || tm.tm_year > 2200)
    return std::nullopt;
  tm.tm_year -= 1900;
  tm.tm_mon -= 1;
  return Nanos(std::chrono::seconds(timegm(&tm))) + Nanos(static_cast<std::int64_t>(seconds * 1e9));
}

}  // namespace dermis::live::fleet
