// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/source_recogniser.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "dermis/learn/recognition/classes_file.hpp"
#include "learn/recognition/small_classes.hpp"
#include "support/force_mat.hpp"

namespace dermis::recognising {
namespace {

using support::error_of;
using support::kPeriod;
using support::MatFiles;
using support::pressed;

/// Classes of poses on 12 x 10 taxels, and frames of two of them.
class Poses {
 public:
  Poses() {
    const learn::recognition::LabelledFrames data = learn::recognition::support::poses(2, 7);
    const std::size_t taxels = data.layout.readings;
    for (std::size_t i = 0; i < 2; ++i) {
      RawFrame frame;
      frame.time = static_cast<std::int64_t>(i) * kPeriod;
      frame.counts.assign(data.frames.begin() + static_cast<std::ptrdiff_t>(i * taxels),
                          data.frames.begin() + static_cast<std::ptrdiff_t>((i + 1) * taxels));
      frames.push_back(std::move(frame));
    }
    EXPECT_TRUE(learn::recognition::write_classes(mat.file("classes.safetensors"),
                                                  learn::recognition::support::small_classes()));
  }

  [[nodiscard]] RecognitionInput input(const std::string& from) const {
    return {.classes = mat.file("classes.safetensors"), .loads = {.from = from}};
  }

  MatFiles mat;
  std::vector<RawFrame> frames;
};

constexpr FrameShape kPoseShape{12, 10};

TEST(SourceRecogniser, names_each_pose_of_a_source_with_its_frame_and_time) {
  const Poses poses;
  auto recogniser = SourceRecogniser::open(poses.input(poses.mat.write("poses.csv", poses.frames, kPoseShape)));
  ASSERT_TRUE(recogniser) << error_of(recogniser);
  EXPECT_FALSE(recogniser->knows_rate());
  for (std::size_t i = 0; i < 2; ++i) {
    const auto found = recogniser->next();
    ASSERT_TRUE(found && *found);
    EXPECT_EQ((*found)->recognition.frames.last, i);
    EXPECT_EQ((*found)->time, static_cast<std::int64_t>(i) * kPeriod);
    EXPECT_EQ(recogniser->classes().names[(*found)->recognition.answer.likeliest],
              learn::recognition::support::pose_name(i));
  }
  EXPECT_FALSE(*recogniser->next());
  EXPECT_FALSE(*recogniser->next());
}

TEST(SourceRecogniser, passes_over_the_frames_of_a_tare_and_counts_them) {
  const Poses poses;
  std::vector<RawFrame> frames(101);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].counts.assign(kPoseShape.taxel_count(), 30.0F);
    frames[i].time = static_cast<std::int64_t>(i) * kPeriod;
  }
  for (std::size_t k = 0; k < kPoseShape.taxel_count(); ++k) frames.back().counts[k] += poses.frames[0].counts[k];
  RecognitionInput input = poses.input(poses.mat.write("poses.csv", frames, kPoseShape));
  input.loads.tare = true;
  auto recogniser = SourceRecogniser::open(input);
  ASSERT_TRUE(recogniser) << error_of(recogniser);
  const auto found = recogniser->next();
  ASSERT_TRUE(found && *found);
  EXPECT_EQ((*found)->recognition.frames.first, 100U);
  EXPECT_EQ(recogniser->classes().names[(*found)->recognition.answer.likeliest],
            learn::recognition::support::pose_name(0));
  EXPECT_FALSE(*recogniser->next());
}

TEST(SourceRecogniser, ends_where_it_is_stopped) {
  const Poses poses;
  const std::atomic<bool> stop = true;
  RecognitionInput input = poses.input(poses.mat.write("poses.csv", poses.frames, kPoseShape));
  input.loads.source.stop = &stop;
  auto recogniser = SourceRecogniser::open(input);
  ASSERT_TRUE(recogniser) << error_of(recogniser);
  EXPECT_FALSE(*recogniser->next());
}

TEST(SourceRecogniser, needs_the_further_readings_that_the_classes_have) {
  const Poses poses;
  learn::recognition::LabelledFrames data = learn::recognition::support::poses(8, 3);
  data.layout.extras = 1;
  for (std::size_t i = 0; i < data.labels.size(); ++i) {
    data.extras.push_back(static_cast<float>(i % learn::recognition::support::kPoses) + 0.01F * static_cast<float>(i));
  }
  const auto set = learn::recognition::LearningSet::create(data);
  ASSERT_TRUE(set);
  const auto learned = set->learn(learn::recognition::support::all_labels(data));
  ASSERT_TRUE(learned);
  ASSERT_TRUE(learn::recognition::write_classes(poses.mat.file("classes.safetensors"), learned->classes));
  std::vector<std::string> notices;
  RecognitionInput input = poses.input(poses.mat.write("poses.csv", poses.frames, kPoseShape));
  EXPECT_NE(error_of(SourceRecogniser::open(input)).find("need 1 further readings"), std::string::npos);
  input.loads.extra = poses.mat.file("joints.csv");
  input.loads.source.notice = [&](const std::string& line) { notices.push_back(line); };
  support::write_bytes(input.loads.extra, "time_s,elbow\n0.01,1\n");
  auto recogniser = SourceRecogniser::open(input);
  ASSERT_TRUE(recogniser) << error_of(recogniser);
  ASSERT_TRUE(recogniser->next().value());
  const auto found = recogniser->next();
  ASSERT_TRUE(found && *found);
  EXPECT_EQ(recogniser->classes().names[(*found)->recognition.answer.likeliest],
            learn::recognition::support::pose_name(1));
  EXPECT_FALSE(*recogniser->next());
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices[0].find("1 of 2 frames of poses.csv"), std::string::npos) << notices[0];
  support::write_bytes(input.loads.extra, "time_s,elbow,wrist\n0,1,2\n");
  EXPECT_NE(error_of(SourceRecogniser::open(input)).find("there are 2 further readings beside a frame"),
            std::string::npos);
}

TEST(SourceRecogniser, refuses_frames_and_rates_that_the_classes_cannot_be_seen_in) {
  const Poses poses;
  const std::string small = poses.mat.write("small.csv", pressed({1.0F}));
  EXPECT_NE(error_of(SourceRecogniser::open(poses.input(small))).find("small.csv"), std::string::npos);
  RecognitionInput input = poses.input(poses.mat.write("poses.csv", poses.frames, kPoseShape));
  input.rate_hz = 10.0;
  EXPECT_NE(error_of(SourceRecogniser::open(input)).find("does not know the rate"), std::string::npos);
  input.rate_hz = -1.0;
  EXPECT_EQ(error_of(SourceRecogniser::open(input)), "rate: must be 0.001 to 1e6");
  input.rate_hz = 0.0;
  input.loads.model = poses.mat.model();
  EXPECT_NE(error_of(SourceRecogniser::open(input)).find("leave it out"), std::string::npos);
}

}  // namespace
}  // namespace dermis::recognising
