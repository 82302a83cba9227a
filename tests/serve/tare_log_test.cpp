// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/tare_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace dermis::serve {
namespace {

constexpr std::chrono::system_clock::time_point kWhen{std::chrono::seconds(1'795'342'500)};

TEST(TareLog, tells_who_tared_what_when) {
  TareLog log;
  EXPECT_EQ(log.text(), "");
  EXPECT_EQ(log.add("chest", true, "127.0.0.1:5000", kWhen),
            "2026-11-22 10:15:00 UTC: chest was tared by 127.0.0.1:5000");
  log.add("the suit", false, "[::1]:6000", kWhen + std::chrono::seconds(5));
  EXPECT_EQ(log.text(),
            "2026-11-22 10:15:05 UTC: the suit got back the zero of its calibration by [::1]:6000\n"
            "2026-11-22 10:15:00 UTC: chest was tared by 127.0.0.1:5000");
}

TEST(TareLog, keeps_the_last_lines_only) {
  TareLog log;
  for (int i = 0; i < 100; ++i) log.add("array " + std::to_string(i), true, "somebody", kWhen);
  const std::string text = log.text();
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), TareLog::kMostLines - 1);
  EXPECT_NE(text.find("array 99 "), std::string::npos);
  EXPECT_EQ(text.find("array 79 "), std::string::npos);
}

}  // namespace
}  // namespace dermis::serve
