// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/stream_recogniser.hpp"

#include <gtest/gtest.h>

#include "dermis/learn/recognition/learning.hpp"
#include "simulated_touches.hpp"
#include "small_classes.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::learn::recognition {
namespace {

/// The gestures with untouched skin between them.
LabelledFrames stream_of_gestures(std::uint64_t seed) {
  constexpr std::size_t kIdle = 15;
  const LabelledFrames gestures = support::gestures(8, seed);
  Random random(seed + 1);
  LabelledFrames stream{gestures.layout, {}, {}, {}};
  const auto rest = [&] {
    for (std::size_t i = 0; i < kIdle * stream.layout.readings; ++i) {
      stream.frames.push_back(static_cast<float>(std::max(random.normal(), 0.0)));
    }
  };
  rest();
  for (Label label : gestures.labels) {
    const std::span<const float> frames = gestures.segment(label).frames;
    const std::size_t first = stream.frame_count();
    stream.frames.insert(stream.frames.end(), frames.begin(), frames.end());
    label.last = first + label.last - label.first;
    label.first = first;
    stream.labels.push_back(label);
    rest();
  }
  return stream;
}

Classes learned_from(const LabelledFrames& data) {
  const Result<LearningSet> set = LearningSet::create(data);
  EXPECT_TRUE(set);
  Result<Learned> learned = set->learn(support::all_labels(data));
  EXPECT_TRUE(learned);
  learned->classes.touches = learn_touches(data);
  return std::move(learned->classes);
}

std::span<const float> frame_of(const LabelledFrames& data, std::size_t frame) {
  return std::span(data.frames).subspan(frame * data.layout.readings, data.layout.readings);
}

TEST(StreamRecogniser, finds_gestures_and_names_them) {
  const LabelledFrames stream = stream_of_gestures(1);
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(learned_from(stream), stream.layout);
  ASSERT_TRUE(recogniser) << recogniser.error().message;
  std::size_t right = 0;
  std::size_t found = 0;
  for (std::size_t frame = 0; frame < stream.frame_count(); ++frame) {
    const std::optional<Recognition> recognition = recogniser->next(frame_of(stream, frame));
    if (!recognition) continue;
    ++found;
    for (const Label& label : stream.labels) {
      const bool is_here = recognition->frames.first <= label.last && recognition->frames.last >= label.first;
      right += is_here && recogniser->classes().names[recognition->answer.likeliest] == label.name ? 1 : 0;
    }
  }
  EXPECT_GE(found, stream.labels.size() - 1);
  EXPECT_LE(found, stream.labels.size() + 2);
  EXPECT_GE(right, stream.labels.size() - 2);
}

TEST(StreamRecogniser, gives_the_gesture_that_is_not_over_at_the_end) {
  const LabelledFrames stream = stream_of_gestures(2);
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(learned_from(stream), stream.layout);
  ASSERT_TRUE(recogniser);
  EXPECT_FALSE(recogniser->finish());
  for (std::size_t frame = 0; frame < stream.labels[1].first + 8; ++frame) {
    static_cast<void>(recogniser->next(frame_of(stream, frame)));
  }
  const std::optional<Recognition> last = recogniser->finish();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->frames.last, stream.labels[1].first + 7);
}

TEST(StreamRecogniser, names_a_pose_with_every_frame) {
  const LabelledFrames data = support::poses(5, 3);
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(support::small_classes(), data.layout);
  ASSERT_TRUE(recogniser);
  for (std::size_t frame = 0; frame < 5; ++frame) {
    const std::optional<Recognition> recognition = recogniser->next(frame_of(data, frame));
    ASSERT_TRUE(recognition);
    EXPECT_EQ(recognition->frames, (Touch{frame, frame}));
  }
}

/// The frames that are looked at with each frame of a pose whose force is so much at ten frames a second.
std::vector<Touch> looked_at(const std::vector<double>& forces) {
  Layout layout = support::one_array(12, 10);
  layout.rate_hz = 10.0;
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(support::small_classes(), layout);
  EXPECT_TRUE(recogniser);
  std::vector<Touch> frames;
  for (const double force : forces) {
    const std::vector<float> frame(layout.readings, static_cast<float>(force));
    frames.push_back(recogniser->next(frame)->frames);
  }
  return frames;
}

TEST(StreamRecogniser, looks_at_the_last_half_second_of_a_pose) {
  const std::vector<Touch> frames = looked_at(std::vector<double>(20, 3.0));
  for (std::size_t frame = 0; frame < 20; ++frame) {
    EXPECT_EQ(frames[frame], (Touch{frame < 5 ? 0 : frame - 4, frame}));
  }
}

TEST(StreamRecogniser, looks_no_further_back_than_the_touch_that_is_there) {
  const std::vector<Touch> frames = looked_at({3.0, 3.0, 0.1, 0.0, 1.0, 2.0, 2.0, 1.8, 2.0, 2.0, 2.0});
  EXPECT_EQ(frames[4], (Touch{4, 4})) << "a touch begins";
  EXPECT_EQ(frames[5], (Touch{4, 5}));
  EXPECT_EQ(frames[7], (Touch{4, 7}));
  EXPECT_EQ(frames[10], (Touch{6, 10})) << "half a second";
}

TEST(StreamRecogniser, looks_at_a_pose_that_was_there_for_half_a_second_after_it) {
  const std::vector<Touch> frames = looked_at({0.01, 0.02, 3.0, 3.0, 0.02, 0.005, 0.02, 0.01, 0.02, 0.02});
  EXPECT_EQ(frames[3], (Touch{2, 3}));
  EXPECT_EQ(frames[5], (Touch{2, 5})) << "noise is no new touch";
  EXPECT_EQ(frames[7], (Touch{3, 7}));
}

TEST(StreamRecogniser, allocates_nothing_per_frame) {
  if (!dermis::support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  const LabelledFrames stream = stream_of_gestures(5);
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(learned_from(stream), stream.layout);
  ASSERT_TRUE(recogniser);
  const dermis::support::AllocationGuard guard;
  for (std::size_t frame = 0; frame < stream.frame_count(); ++frame) {
    static_cast<void>(recogniser->next(frame_of(stream, frame)));
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(StreamRecogniser, refuses_frames_that_are_too_large_to_keep) {
  const LabelledFrames stream = stream_of_gestures(7);
  Layout huge = stream.layout;
  huge.readings = std::size_t{1} << 20U;
  const Result<StreamRecogniser> recogniser = StreamRecogniser::create(learned_from(stream), huge);
  ASSERT_FALSE(recogniser);
  EXPECT_EQ(recogniser.error().message,
            "frames of 1048576 readings are too large to look at 1024 of them together; at most 32768 readings are "
            "possible");
}

TEST(StreamRecogniser, needs_to_know_where_gestures_begin) {
  LabelledFrames stream = stream_of_gestures(6);
  Classes classes = learned_from(stream);
  classes.touches.reset();
  const Result<StreamRecogniser> recogniser = StreamRecogniser::create(classes, stream.layout);
  ASSERT_FALSE(recogniser);
  EXPECT_EQ(recogniser.error().message,
            "where touches begin and end was not learned: the labels leave no frame without a touch");
}

}  // namespace
}  // namespace dermis::learn::recognition
