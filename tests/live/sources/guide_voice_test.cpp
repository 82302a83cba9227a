// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/guide_voice.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace dermis::live::sources {
namespace {

TEST(GuideVoice, asks_for_nothing_and_has_no_listener_at_first) {
  const GuideVoice voice;
  EXPECT_FALSE(voice.has_listener());
  EXPECT_FALSE(voice.words().press);
}

TEST(GuideVoice, repeats_what_was_said_last) {
  GuideVoice voice;
  voice.listen();
  EXPECT_TRUE(voice.has_listener());
  voice.speak({.press = true, .taxel = 3, .weight_n = 2.0});
  voice.speak({.press = true, .is_wrong = true, .taxel = 7, .weight_n = 5.0, .hold_time = Nanos(9)});
  const GuideWords words = voice.words();
  EXPECT_TRUE(words.press);
  EXPECT_TRUE(words.is_wrong);
  EXPECT_EQ(words.taxel, 7U);
  EXPECT_EQ(words.weight_n, 5.0);
  EXPECT_EQ(words.hold_time, Nanos(9));
}

TEST(GuideVoice, never_mixes_two_sayings) {
  GuideVoice voice;
  std::jthread speaker([&](const std::stop_token& end) {
    for (std::size_t i = 0; !end.stop_requested(); ++i) voice.speak({.taxel = i, .weight_n = static_cast<double>(i)});
  });
  for (int i = 0; i < 10'000; ++i) {
    const GuideWords words = voice.words();
    ASSERT_EQ(static_cast<double>(words.taxel), words.weight_n);
  }
}

}  // namespace
}  // namespace dermis::live::sources
