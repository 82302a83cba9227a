// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/access.hpp"

#include <gtest/gtest.h>

namespace dermis::out::websocket {
namespace {

TEST(Access, tells_loopback_from_the_rest) {
  for (const char* host : {"127.0.0.1", "127.9.8.7", "::1", "localhost", "LocalHost"}) EXPECT_TRUE(is_loopback(host));
  for (const char* host : {"0.0.0.0", "::", "192.168.0.1", "127.0.0.1.evil.org", "", "localhost.evil.org"}) {
    EXPECT_FALSE(is_loopback(host)) << host;
    EXPECT_FALSE(is_loopback_authority(host)) << host;
  }
  for (const char* authority : {"127.0.0.1:8080", "localhost:1", "[::1]:8080", "localhost"}) {
    EXPECT_TRUE(is_loopback_authority(authority)) << authority;
  }
  EXPECT_FALSE(is_loopback_authority("evil.org:8080"));
  EXPECT_FALSE(is_loopback_authority("[::1"));
}

TEST(Access, knows_localhost_in_any_case) {
  EXPECT_EQ(numeric_address("localhost"), "127.0.0.1");
  EXPECT_EQ(numeric_address("LOCALHOST"), "127.0.0.1");
  EXPECT_EQ(numeric_address("::1"), "::1");
}

TEST(Access, pages_of_this_server_and_programs_have_the_same_origin) {
  EXPECT_TRUE(is_same_origin("", "127.0.0.1:8080"));
  EXPECT_TRUE(is_same_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(is_same_origin("https://robot.local", "Robot.local"));
  EXPECT_FALSE(is_same_origin("http://127.0.0.1:8081", "127.0.0.1:8080"));
  EXPECT_FALSE(is_same_origin("https://evil.org", "127.0.0.1:8080"));
  EXPECT_FALSE(is_same_origin("null", "127.0.0.1:8080"));
  EXPECT_FALSE(is_same_origin("file://127.0.0.1:8080", "127.0.0.1:8080"));
}

TEST(Access, foxglove_and_lichtblick_are_known_by_their_whole_origin) {
  for (const char* origin :
       {"https://app.foxglove.dev", "https://studio.foxglove.dev", "https://lichtblick-suite.github.io"}) {
    EXPECT_TRUE(is_known_tool(origin)) << origin;
  }
  for (const char* origin : {"", "null", "http://app.foxglove.dev", "https://app.foxglove.dev.evil.org",
                             "https://evil.github.io", "https://app.foxglove.dev:8443"}) {
    EXPECT_FALSE(is_known_tool(origin)) << origin;
  }
}

TEST(Access, finds_the_token) {
  EXPECT_EQ(query_value("/?token=abc", "token"), "abc");
  EXPECT_EQ(query_value("/x?a=1&token=abc&b=2", "token"), "abc");
  EXPECT_EQ(query_value("/x?mytoken=abc", "token"), "");
  EXPECT_EQ(query_value("/token=abc", "token"), "");
  EXPECT_EQ(bearer_token("Bearer abc"), "abc");
  EXPECT_EQ(bearer_token("Basic abc"), "");
  EXPECT_EQ(path_of("/suit.json?token=abc"), "/suit.json");
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  for (const char* wrong : {"", "ab", "abd", "abcabc", "abca"}) EXPECT_FALSE(equal_in_constant_time(wrong, "abc"));
  EXPECT_TRUE(is_url_safe("aZ09-._~"));
  EXPECT_FALSE(is_url_safe("a b"));
}

}  // namespace
}  // namespace dermis::out::websocket
