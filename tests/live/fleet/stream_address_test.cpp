// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/stream_address.hpp"

#include <gtest/gtest.h>

#include "support/mutations.hpp"

namespace dermis::live::fleet {
namespace {

std::string error_of(const std::string& text) {
  const Result<StreamAddress> parsed = parse_stream_address(text);
  return parsed ? "" : parsed.error().message;
}

TEST(StreamAddress, names_the_frames_of_an_array) {
  const Result<StreamAddress> parsed =
      parse_stream_address("tls://hub:4222?robot=r-1&array=left_hand&ca=hub.pem&key=a.pem");
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(parsed->broker.url, "tls://hub:4222");
  EXPECT_EQ(parsed->broker.ca, "hub.pem");
  EXPECT_EQ(parsed->broker.key, "a.pem");
  EXPECT_EQ(parsed->robot, "r-1");
  EXPECT_EQ(parsed->array, "left_hand");
  EXPECT_TRUE(std::holds_alternative<Newest>(parsed->from));
  EXPECT_FALSE(parsed->ends);
}

TEST(StreamAddress, begins_and_ends_at_numbers_or_times) {
  const auto parsed = parse_stream_address("nats://hub?robot=r&array=a&from=17&to=last");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(std::get<std::uint64_t>(parsed->from), 17U);
  EXPECT_TRUE(parsed->ends);
  const auto timed =
      parse_stream_address("nats://hub?robot=r&array=a&from=2026-11-28T05:00:00.5Z&to=2026-11-28T06:00:00Z");
  ASSERT_TRUE(timed);
  EXPECT_EQ(std::get<Nanos>(timed->from), Nanos(1'795'842'000'500'000'000));
  EXPECT_EQ(std::get<Nanos>(timed->to), Nanos(1'795'845'600'000'000'000));
}

TEST(StreamAddress, errors_name_the_part_and_the_mend) {
  EXPECT_EQ(error_of("nats://hub?array=a"), "'nats://hub?array=a': lacks robot=NAME");
  EXPECT_EQ(error_of("nats://?robot=r"), "'nats://?robot=r': names no server; write nats://HOST or tls://HOST");
  EXPECT_EQ(error_of("nats://hub?robt=r"), "'nats://hub?robt=r': 'robt' is no parameter; did you mean 'robot'?");
  EXPECT_EQ(error_of("nats://hub?robot=r&robot=s"), "'nats://hub?robot=r&robot=s': robot: is there twice");
  EXPECT_EQ(error_of("nats://hub?robot=a.b&array=c"),
            "'nats://hub?robot=a.b&array=c': robot: 'a.b' must be 1 to 64 letters, digits, '_' or '-', a letter or "
            "digit first");
  EXPECT_EQ(error_of("nats://hub?robot=r&array=a&from=noon"),
            "'nats://hub?robot=r&array=a&from=noon': from: must be a number of the stream from 1 on, a time as "
            "2026-11-28T05:00:00Z, or new");
  EXPECT_EQ(error_of("nats://hub?robot=r&array=a&to=last"),
            "'nats://hub?robot=r&array=a&to=last': to: needs from, as from=1&to=last");
}

TEST(StreamAddress, any_text_is_an_address_or_an_error_of_one_line) {
  const std::string valid = "nats://hub?robot=r&array=a&from=2026-11-28T05:00:00Z&to=last";
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    EXPECT_EQ(error_of(support::mutated(valid, seed)).find('\n'), std::string::npos) << "seed " << seed;
  }
  EXPECT_FALSE(error_of(std::string(5000, 'x')).empty());
}

TEST(StreamAddress, names_the_user_and_where_the_password_is) {
  const auto parsed = parse_stream_address("nats://anna@hub:4222?robot=r&array=a&password-file=/etc/dermis/hub");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->text, "nats://hub:4222?robot=r&array=a&password-file=/etc/dermis/hub");
  EXPECT_EQ(parsed->broker.url, "nats://hub:4222");
  EXPECT_EQ(parsed->broker.user, "anna");
  EXPECT_EQ(parsed->broker.password_file, "/etc/dermis/hub");
}

TEST(StreamAddress, a_password_is_refused_and_not_shown) {
  for (const char* text : {"nats://user:secret@hub?robot=r&array=a", "nats://:secret@hub?robot=r&array=a",
                           "nats://a:secret@hub,nats://b:secret@other?robot=r&array=a",
                           "nats://a:secret/secret@hub?robot=r&array=a", "nats://user:secret@hub?array=a&secrt=1"}) {
    const std::string error = error_of(text);
    EXPECT_NE(error.find("DERMIS_HUB_PASSWORD or password-file=FILE"), std::string::npos) << error;
    EXPECT_EQ(error.find("secret"), std::string::npos) << error;
  }
}

TEST(StreamAddress, times_are_of_the_calendar) {
  EXPECT_FALSE(parse_stream_address("nats://hub?robot=r&array=a&from=2026-99-28T05:00:00Z"));
  EXPECT_FALSE(parse_stream_address("nats://hub?robot=r&array=a&from=2026-11-28T25:00:00Z"));
}

TEST(StreamAddress, names_are_no_subjects) {
  for (const char* name : {"", "a b", "a.b", "*", ">", "a/b"}) EXPECT_FALSE(check_name("robot", name)) << name;
  EXPECT_FALSE(check_name("robot", std::string(65, 'a')));
  EXPECT_TRUE(check_name("robot", std::string(64, 'a')));
}

}  // namespace
}  // namespace dermis::live::fleet
