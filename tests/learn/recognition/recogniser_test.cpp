// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/recogniser.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dermis/learn/recognition/learning.hpp"
#include "simulated_touches.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::learn::recognition {
namespace {

Classes learned_from(const LabelledFrames& data) {
  const Result<LearningSet> set = LearningSet::create(data);
  EXPECT_TRUE(set);
  Result<Learned> learned = set->learn(support::all_labels(data));
  EXPECT_TRUE(learned);
  return std::move(learned->classes);
}

Recogniser recogniser_of(const Classes& classes, const Layout& source, std::size_t most_frames = 1) {
  Result<Recogniser> recogniser = Recogniser::create(classes, source, most_frames);
  EXPECT_TRUE(recogniser) << recogniser.error().message;
  return *std::move(recogniser);
}

/// The share of further poses that are named right; `pitch` of the array that feels them.
double accuracy_on_poses(Recogniser& recogniser, double pitch, std::uint64_t seed) {
  constexpr std::size_t kTouches = 100;
  Random random(seed);
  std::size_t right = 0;
  for (std::size_t i = 0; i < kTouches; ++i) {
    const std::vector<float> frame = support::pose(random, i % support::kPoses, pitch);
    const Answer answer = recogniser.recognise({frame, {}});
    right += recogniser.classes().names[answer.likeliest] == support::pose_name(i % support::kPoses) ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(kTouches);
}

TEST(Recogniser, names_poses_that_it_has_not_seen) {
  Recogniser recogniser = recogniser_of(learned_from(support::poses(12, 1)), support::one_array(12, 10));
  EXPECT_GE(accuracy_on_poses(recogniser, 1.0, 2), 0.93);
}

TEST(Recogniser, taught_by_ten_examples_each_calls_few_new_touches_unknown) {
  constexpr std::size_t kTaught = 10 * support::kPoses;
  constexpr std::size_t kTeachers = 15;
  std::size_t unknown_in_all = 0;
  std::size_t above_one_in_twenty = 0;
  for (std::uint64_t seed = 1; seed <= kTeachers; ++seed) {
    LabelledFrames data = support::poses(20, seed);
    const std::vector<Label> others(data.labels.begin() + kTaught, data.labels.end());
    data.labels.resize(kTaught);
    Recogniser recogniser = recogniser_of(learned_from(data), data.layout);
    std::size_t unknown = 0;
    for (const Label& label : others) {
      unknown += recogniser.recognise(data.segment(label)).verdict != Verdict::known ? 1 : 0;
    }
    unknown_in_all += unknown;
    above_one_in_twenty += 20 * unknown > others.size() ? 1 : 0;
  }
  EXPECT_LE(above_one_in_twenty, kTeachers / 5);
  EXPECT_GE(unknown_in_all, kTeachers * kTaught / 200);
  EXPECT_LE(unknown_in_all, kTeachers * kTaught / 30);
}

TEST(Recogniser, gives_probabilities_that_sum_to_one) {
  const LabelledFrames data = support::poses(8, 3);
  Recogniser recogniser = recogniser_of(learned_from(data), data.layout);
  const Answer answer = recogniser.recognise(data.segment(data.labels[5]));
  ASSERT_EQ(answer.probabilities.size(), support::kPoses);
  EXPECT_NEAR(std::accumulate(answer.probabilities.begin(), answer.probabilities.end(), 0.0), 1.0, 1e-12);
  const auto largest = std::max_element(answer.probabilities.begin(), answer.probabilities.end());
  EXPECT_EQ(answer.likeliest, static_cast<std::size_t>(largest - answer.probabilities.begin()));
  EXPECT_NE(answer.second, answer.likeliest);
}

TEST(Recogniser, says_that_it_does_not_know_what_is_unlike_all_examples) {
  const LabelledFrames data = support::poses(12, 4);
  Recogniser recogniser = recogniser_of(learned_from(data), data.layout);
  Random random(5);
  std::vector<float> checkered(data.layout.readings);
  for (std::size_t taxel = 0; taxel < checkered.size(); taxel += 7) {
    checkered[taxel] = static_cast<float>(random.uniform(200.0, 400.0));
  }
  const Answer strange = recogniser.recognise({checkered, {}});
  EXPECT_EQ(strange.verdict, Verdict::unlike_examples);
  EXPECT_GT(strange.unknown_score, recogniser.classes().unknown_from);
  std::size_t unknown = 0;
  constexpr std::size_t kTouches = 100;
  for (std::size_t i = 0; i < kTouches; ++i) {
    const std::vector<float> frame = support::pose(random, i % support::kPoses);
    unknown += recogniser.recognise({frame, {}}).verdict != Verdict::known ? 1 : 0;
  }
  EXPECT_LE(unknown, 15U);
}

TEST(Recogniser, calls_few_new_touches_unknown_also_after_few_examples) {
  constexpr std::uint64_t kSets = 40;
  constexpr std::size_t kTouches = 60;
  std::size_t unknown = 0;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    const LabelledFrames data = support::poses(8, seed);
    Recogniser recogniser = recogniser_of(learned_from(data), data.layout);
    Random random(1000 + seed);
    for (std::size_t i = 0; i < kTouches; ++i) {
      const std::vector<float> frame = support::pose(random, i % support::kPoses);
      unknown += recogniser.recognise({frame, {}}).verdict != Verdict::known ? 1 : 0;
    }
  }
  EXPECT_LE(static_cast<double>(unknown), 0.08 * kSets * kTouches);
}

TEST(Recogniser, moves_to_an_array_of_another_pitch) {
  LabelledFrames data = support::poses(12, 6);
  data.layout = support::one_array(12, 10, 4.0);
  Recogniser finer = recogniser_of(learned_from(data), support::one_array(24, 20, 2.0));
  EXPECT_GE(accuracy_on_poses(finer, 0.5, 7), 0.85);
}

TEST(Recogniser, moves_to_another_rate) {
  LabelledFrames data = support::gestures(8, 8);
  data.layout.rate_hz = 30.0;
  const Classes classes = learned_from(data);
  Layout doubled = data.layout;
  doubled.rate_hz = 60.0;
  Recogniser recogniser = recogniser_of(classes, doubled, 100);
  std::size_t right = 0;
  for (const Label& label : data.labels) {
    std::vector<float> frames;
    const Segment segment = data.segment(label);
    for (std::size_t i = 0; i < segment.frames.size(); i += data.layout.readings) {
      const auto frame = segment.frames.subspan(i, data.layout.readings);
      for (int copy = 0; copy < 2; ++copy) frames.insert(frames.end(), frame.begin(), frame.end());
    }
    right += classes.names[recogniser.recognise({frames, {}}).likeliest] == label.name ? 1 : 0;
  }
  EXPECT_GE(right, data.labels.size() - 1);
}

TEST(Recogniser, takes_readings_that_are_no_number_as_no_load) {
  const LabelledFrames data = support::poses(8, 9);
  Recogniser recogniser = recogniser_of(learned_from(data), data.layout);
  std::vector<float> frame(data.layout.readings, std::numeric_limits<float>::quiet_NaN());
  frame[3] = std::numeric_limits<float>::infinity();
  frame[4] = -5.0F;
  const Answer hostile = recogniser.recognise({frame, {}});
  const double score = hostile.unknown_score;
  std::fill(frame.begin(), frame.end(), 0.0F);
  EXPECT_EQ(recogniser.recognise({frame, {}}).unknown_score, score);
  EXPECT_NE(hostile.verdict, Verdict::known);
}

TEST(Recogniser, answers_from_the_rest_where_a_further_reading_is_no_number) {
  LabelledFrames data = support::poses(8, 13);
  data.layout.extras = 2;
  for (std::size_t i = 0; i < data.labels.size(); ++i) {
    const std::size_t kind = i % support::kPoses;
    data.extras.push_back(static_cast<float>(kind) + 0.01F * static_cast<float>(i));
    data.extras.push_back(static_cast<float>(i % 3));
  }
  Recogniser recogniser = recogniser_of(learned_from(data), data.layout);
  const Segment segment = data.segment(data.labels[1]);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const std::vector<float> extras{bad, bad};
    const Answer answer = recogniser.recognise({segment.frames, extras});
    EXPECT_NEAR(std::accumulate(answer.probabilities.begin(), answer.probabilities.end(), 0.0), 1.0, 1e-12);
    EXPECT_TRUE(std::isfinite(answer.unknown_score));
  }
}

TEST(Recogniser, stays_finite_with_the_largest_tables_that_are_allowed) {
  const LabelledFrames data = support::poses(8, 14);
  Classes classes = learned_from(data);
  for (Expert& expert : classes.experts) {
    std::fill(expert.axes.begin(), expert.axes.end(), 1e12F * 0.999F);
    std::fill(expert.class_means.begin(), expert.class_means.end(), -1e12F * 0.999F);
    std::fill(expert.centres.begin(), expert.centres.end(), 1e12F * 0.999F);
    std::fill(expert.influences.begin(), expert.influences.end(), -1e12F * 0.999F);
    expert.width = 1e12;
    expert.weight = 1e12;
    expert.unknown_weight = 1e12;
  }
  Recogniser recogniser = recogniser_of(classes, data.layout);
  const std::vector<float> frame(data.layout.readings, 1e29F);
  const Answer answer = recogniser.recognise({frame, {}});
  EXPECT_NEAR(std::accumulate(answer.probabilities.begin(), answer.probabilities.end(), 0.0), 1.0, 1e-12);
  EXPECT_TRUE(std::isfinite(answer.unknown_score));
}

TEST(Recogniser, of_a_longer_segment_takes_the_end) {
  const LabelledFrames data = support::poses(8, 10);
  Recogniser recogniser = recogniser_of(learned_from(data), data.layout, 1);
  const std::span<const float> two = std::span(data.frames).first(2 * data.layout.readings);
  const double of_two = recogniser.recognise({two, {}}).unknown_score;
  EXPECT_EQ(of_two, recogniser.recognise({two.last(data.layout.readings), {}}).unknown_score);
}

TEST(Recogniser, allocates_nothing_per_answer) {
  if (!dermis::support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  LabelledFrames data = support::gestures(4, 11);
  data.layout.rate_hz = 30.0;
  Layout source = data.layout;
  source.rate_hz = 40.0;
  Recogniser recogniser = recogniser_of(learned_from(data), source, 30);
  const dermis::support::AllocationGuard guard;
  for (const Label& label : data.labels) static_cast<void>(recogniser.recognise(data.segment(label)));
  EXPECT_EQ(guard.count(), 0U);
}

TEST(Recogniser, refuses_a_rate_that_is_far_from_that_of_the_examples) {
  LabelledFrames data = support::gestures(4, 15);
  data.layout.rate_hz = 1.0;
  const Classes classes = learned_from(data);
  Layout source = data.layout;
  for (const double rate : {1e-3, 1000.0}) {
    source.rate_hz = rate;
    EXPECT_TRUE(Recogniser::create(classes, source, 10)) << rate;
  }
  source.rate_hz = 1e6;
  const Result<Recogniser> recogniser = Recogniser::create(classes, source, 10);
  ASSERT_FALSE(recogniser);
  EXPECT_EQ(
      recogniser.error().message,
      "the rate is 1e+06 Hz, that of the examples 1 Hz; classes move to a rate at most 1000 times higher or lower");
}

TEST(Recogniser, refuses_frames_of_another_kind) {
  const LabelledFrames data = support::poses(4, 12);
  const Classes classes = learned_from(data);
  const auto error_of = [&](const Layout& source) {
    const Result<Recogniser> recogniser = Recogniser::create(classes, source, 1);
    return recogniser ? "no error" : recogniser.error().message;
  };
  EXPECT_EQ(
      error_of(support::one_array(16, 16)),
      "array 'skin' has 16x16 taxels, the examples were of 'skin' with 12x10; classes move to an array of another "
      "size where the pitch of both is known");
  Layout two = data.layout;
  two.arrays.push_back(two.arrays.front());
  two.readings *= 2;
  EXPECT_EQ(error_of(two), "there are 2 arrays, the examples had 1");
  Layout with_angles = data.layout;
  with_angles.extras = 7;
  EXPECT_EQ(error_of(with_angles), "there are 7 further readings beside a frame, the examples had 0");
}

TEST(Recogniser, refuses_arrays_of_other_names) {
  LabelledFrames data = support::poses(4, 16);
  data.layout.arrays = {{.name = "thumb", .rows = 6, .cols = 10},
                        {.name = "palm", .rows = 6, .cols = 10, .first_column = 60}};
  const Classes classes = learned_from(data);
  EXPECT_TRUE(Recogniser::create(classes, data.layout, 1));
  Layout turned = data.layout;
  std::swap(turned.arrays[0].name, turned.arrays[1].name);
  const Result<Recogniser> recogniser = Recogniser::create(classes, turned, 1);
  ASSERT_FALSE(recogniser);
  EXPECT_EQ(recogniser.error().message,
            "its arrays are 'palm', 'thumb', the examples were of 'thumb', 'palm'; arrays of the same names must come, "
            "in the same order");
}

}  // namespace
}  // namespace dermis::learn::recognition
