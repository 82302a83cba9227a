// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/episodes.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <limits>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/marks.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "support/hand_made_model.hpp"
#include "support/joint_messages.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::datasets {
namespace {

using std::chrono::milliseconds;

/// Keeps the steps of all episodes.
class Kept final : public EpisodeSink {
 public:
  Status begin(const std::vector<Column>& columns) override {
    columns_ = columns;
    values_.resize(columns.size());
    return Done{};
  }
  Status write(const StepBlock& block) override {
    for (std::size_t k = 0; k < values_.size(); ++k) {
      EXPECT_EQ(block.values[k].size(), block.steps * columns_[k].row_bytes());
      values_[k].insert(values_[k].end(), block.values[k].begin(), block.values[k].end());
    }
    steps_ += block.steps;
    return Done{};
  }
  Status end_episode() override {
    ends_.push_back(steps_);
    return Done{};
  }
  Status commit(const EpisodeTally& tally) override {
    is_committed_ = true;
    tally_ = tally;
    return Done{};
  }

  template <typename T>
  [[nodiscard]] std::vector<T> column(const std::string& name) const {
    std::vector<T> values;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (columns_[k].name() != name) continue;
      values.resize(values_[k].size() / sizeof(T));
      std::memcpy(values.data(), values_[k].data(), values_[k].size());
    }
    return values;
  }
  [[nodiscard]] std::vector<std::string> axes(const std::string& name) const {
    for (const Column& column : columns_) {
      if (column.name() == name) return column.axes;
    }
    return {};
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Column& column : columns_) names.push_back(column.name());
    return names;
  }
  [[nodiscard]] const std::vector<std::size_t>& ends() const { return ends_; }
  [[nodiscard]] const EpisodeTally& tally() const { return tally_; }
  [[nodiscard]] bool is_committed() const { return is_committed_; }

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::byte>> values_;
  std::vector<std::size_t> ends_;
  std::size_t steps_ = 0;
  bool is_committed_ = false;
  EpisodeTally tally_;
};

/// Two arrays of 1x2; the first has a frame at each of these times, with its number as counts, the second every tenth.
void write_recording(const std::string& path, const std::vector<Nanos>& times, std::size_t cols = 2) {
  const auto writer = bytes::recordings::SuitRecordingWriter::create(
      path, {{.name = "left hand", .shape = {1, cols}}, {.name = "chest", .shape = {1, cols}}}, {.live = false});
  ASSERT_TRUE(writer) << writer.error().message;
  RawFrame frame;
  for (std::size_t k = 0; k < times.size(); ++k) {
    frame.time = times[k];
    frame.counts.assign(cols, static_cast<float>(k));
    ASSERT_TRUE((*writer)->write(0, frame));
    const bool is_tenth = k % 10 == 0;
    ASSERT_TRUE(!is_tenth || (*writer)->write(1, frame).has_value());
  }
  ASSERT_TRUE((*writer)->commit());
}

struct JointSample {
  std::string topic;
  Nanos time;
  std::vector<std::pair<std::string, double>> positions;
};

/// An array of 1x1 whose frames are 10 ms apart, each as `change` leaves it. `beside` writes what comes with it.
/// `model`: bytes of the model that gave its forces.
void write_tip(const std::string& path, const std::function<void(int, RawFrame&)>& change,
               const std::function<void(bytes::recordings::SuitRecordingWriter&, Nanos)>& beside,
               const std::string& model = "") {
  const std::vector<bytes::recordings::RecordedArray> arrays = {
      {.name = "tip", .shape = {1, 1}, .model_hash = model.empty() ? "" : "abc", .model_file = model}};
  const auto writer = bytes::recordings::SuitRecordingWriter::create(path, arrays);
  ASSERT_TRUE(writer) << writer.error().message;
  RawFrame frame;
  frame.counts = {1.0F};
  for (int k = 0; k < 50; ++k) {
    frame.time = milliseconds(10 * k);
    change(k, frame);
    ASSERT_TRUE((*writer)->write(0, frame));
    beside(**writer, frame.time);
  }
  ASSERT_TRUE((*writer)->commit());
}

void write_robot(const std::string& path, const std::vector<JointSample>& samples) {
  bytes::ros_messages::MessageType joints = bytes::ros_messages::temperature_type();
  joints.name = bytes::ros_messages::kJointState;
  const auto write_joints = [&](bytes::recordings::SuitRecordingWriter& writer, Nanos time) {
    for (const JointSample& sample : samples) {
      if (sample.time != time) continue;
      const std::vector<std::uint8_t> message = support::joint_message(sample.positions);
      ASSERT_TRUE(writer.write({sample.topic, joints, sample.time, message}));
    }
  };
  write_tip(
      path, [](int, RawFrame&) {}, write_joints);
}

/// An array of 1x1 for 0.5 s, with marks.
void write_marked(const std::string& path, const std::vector<bytes::ros_messages::Mark>& marks) {
  const auto write_marks = [&](bytes::recordings::SuitRecordingWriter& writer, Nanos time) {
    for (const bytes::ros_messages::Mark& mark : marks) {
      if (mark.time != time) continue;
      std::vector<std::uint8_t> message;
      bytes::ros_messages::encode_mark(mark, "tip", message);
      ASSERT_TRUE(writer.write({bytes::recordings::kMarksTopic, bytes::ros_messages::mark_type(), time, message}));
    }
  };
  write_tip(
      path, [](int, RawFrame&) {}, write_marks);
}

std::vector<Nanos> even_times(std::size_t count, Nanos first = {}) {
  std::vector<Nanos> times;
  for (std::size_t k = 0; k < count; ++k) times.push_back(first + milliseconds(10 * k));
  return times;
}

std::string error_of(const std::vector<std::string>& recordings, const EpisodeOptions& options) {
  Kept kept;
  const Result<EpisodeTally> made = make_episodes(recordings, options, kept);
  EXPECT_FALSE(kept.is_committed());
  return made ? "" : made.error().message;
}

class Episodes : public testing::Test {
 protected:
  void SetUp() override { write_recording(path_, even_times(100)); }

  support::TemporaryFolder folder_;
  std::string path_ = folder_.file("rec.mcap");
};

TEST_F(Episodes, have_the_windows_and_ages_of_all_arrays) {
  Kept kept;
  const Result<EpisodeTally> tally = make_episodes({path_}, {.fps = 20.0, .window = 5}, kept);
  ASSERT_TRUE(tally) << tally.error().message;
  EXPECT_TRUE(kept.is_committed());
  EXPECT_EQ(kept.ends(), (std::vector<std::size_t>{20}));
  EXPECT_EQ(kept.names(),
            (std::vector<std::string>{"time_ns", "left_hand_valid", "left_hand_raw", "left_hand_age", "left_hand_fresh",
                                      "chest_valid", "chest_raw", "chest_age", "chest_fresh"}));
  EXPECT_EQ(kept.column<std::int64_t>("time_ns")[1], 95'000'000);
  const std::vector<float> raw = kept.column<float>("left_hand_raw");
  for (std::size_t k = 0; k < raw.size(); ++k) {
    const std::size_t frame = k / 2;  // each once
    EXPECT_EQ(raw[k], static_cast<float>(frame));
  }
  EXPECT_FLOAT_EQ(kept.column<float>("left_hand_age")[4], 0.005F);
  const std::vector<float> ages = kept.column<float>("chest_age");
  EXPECT_EQ(ages[3], -1.0F);
  EXPECT_FLOAT_EQ(ages[4], 0.045F);
  EXPECT_EQ(kept.column<std::uint8_t>("chest_valid")[7], 0);
  EXPECT_EQ(kept.column<std::uint8_t>("chest_valid")[8], 1);
  ASSERT_EQ(tally->arrays.size(), 2U);
  EXPECT_EQ(tally->arrays[0].frames, 100U);
  EXPECT_EQ(tally->arrays[0].missed + tally->arrays[1].missed, 0U);
}

TEST_F(Episodes, have_the_temperature_of_each_sensor) {
  const std::string path = folder_.file("sensors.mcap");
  const auto warm = [](int k, RawFrame& frame) {
    frame.sensor_celsius = {20.0F, k == 0 ? 30.0F : std::numeric_limits<float>::quiet_NaN()};
  };
  write_tip(path, warm, [](bytes::recordings::SuitRecordingWriter&, Nanos) {});
  Kept kept;
  ASSERT_TRUE(make_episodes({path}, {.fps = 20.0}, kept));
  EXPECT_EQ(kept.axes("tip_temperature"), (std::vector<std::string>{"sensors"}));
  const std::vector<float> celsius = kept.column<float>("tip_temperature");
  ASSERT_GT(celsius.size(), 2U);
  for (std::size_t k = 0; k < celsius.size(); ++k) EXPECT_EQ(celsius[k], k % 2 == 0 ? 20.0F : 30.0F) << "the last one";
}

TEST_F(Episodes, count_what_too_short_a_window_misses_and_say_how_long_it_must_be) {
  Kept kept;
  const Result<EpisodeTally> tally = make_episodes({path_}, {.fps = 20.0, .window = 2}, kept);
  ASSERT_TRUE(tally);
  EXPECT_GT(tally->arrays[0].missed, 50U);
  EXPECT_EQ(tally->arrays[0].most_fresh, 5U);
}

TEST_F(Episodes, begin_anew_after_a_gap_and_with_every_recording) {
  std::vector<Nanos> times = even_times(50);
  const std::vector<Nanos> later = even_times(50, std::chrono::hours(100'000));
  times.insert(times.end(), later.begin(), later.end());
  const std::string gap = folder_.file("gap.mcap");
  write_recording(gap, times);
  Kept kept;
  const Result<EpisodeTally> tally = make_episodes({gap, path_}, {.fps = 20.0, .window = 5}, kept);
  ASSERT_TRUE(tally);
  EXPECT_EQ(kept.ends(), (std::vector<std::size_t>{10, 20, 40}));
}

TEST_F(Episodes, have_steps_at_given_times_and_the_state_of_the_robot) {
  std::ofstream(folder_.file("joints.csv")) << "time_s,elbow\n0.1,1\n0.3,2\n";
  Kept kept;
  EpisodeOptions options{.quantities = {"fresh"}, .states = {folder_.file("joints.csv")}};
  options.times = {{milliseconds(100), milliseconds(299), milliseconds(300)}};
  ASSERT_TRUE(make_episodes({path_}, options, kept));
  EXPECT_EQ(kept.column<float>("state"), (std::vector<float>{1, 1, 2}));
  EXPECT_EQ(kept.names(), (std::vector<std::string>{"time_ns", "state", "left_hand_fresh", "chest_fresh"}));
}

TEST_F(Episodes, of_given_times_are_several_of_a_recording) {
  EpisodeOptions options{.window = 3, .quantities = {"raw", "fresh"}};
  options.times = {
      {milliseconds(105), milliseconds(115)}, {milliseconds(125)}, {milliseconds(505), milliseconds(2000)}};
  Kept kept;
  const Result<EpisodeTally> made = make_episodes({path_}, options, kept);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->episodes, 3U);
  EXPECT_EQ(kept.ends(), (std::vector<std::size_t>{2, 3, 5}));
  EXPECT_EQ(kept.column<std::int64_t>("left_hand_fresh"), (std::vector<std::int64_t>{3, 1, 1, 3, 3}));
  const std::vector<float> raw = kept.column<float>("left_hand_raw");  // 3 frames of 2 taxels a step
  EXPECT_EQ(raw[12], 10.0F);
  EXPECT_EQ(raw[18], 48.0F);
  EXPECT_EQ(raw.back(), 99.0F);
}

TEST_F(Episodes, of_given_times_read_no_further_than_the_last_step) {
  const std::string path = folder_.file("long.mcap");
  write_recording(path, even_times(30'000));
  EpisodeOptions options{.window = 2, .quantities = {"raw", "fresh"}};
  options.times = {{milliseconds(85'005), milliseconds(150'005)}};
  Kept kept;
  const Result<EpisodeTally> made = make_episodes({path}, options, kept);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(kept.column<float>("left_hand_raw"),
            (std::vector<float>{8499, 8499, 8500, 8500, 14'999, 14'999, 15'000, 15'000}));
  EXPECT_EQ(kept.column<std::int64_t>("left_hand_fresh"), (std::vector<std::int64_t>{2, 2}));
  EXPECT_LT(made->arrays[0].frames, 25'000U);
  EXPECT_EQ(made->arrays[0].missed, 15'001U - 4U);
  EXPECT_EQ(made->arrays[0].most_fresh, 8501U);
}

TEST_F(Episodes, need_times_that_rise_and_are_of_their_recordings) {
  const auto error = [&](const std::vector<std::vector<Nanos>>& times, std::size_t recordings) {
    EpisodeOptions options;
    options.times = times;
    return error_of(std::vector<std::string>(recordings, path_), options);
  };
  EXPECT_EQ(error({{Nanos(1)}, {Nanos(2)}, {Nanos(3)}}, 2), "times: are of 3 recordings in place of 2");
  EXPECT_EQ(error({{Nanos(1)}, {}}, 1), "times: leave an episode without steps");
  EXPECT_EQ(error({{Nanos(2)}, {Nanos(2)}}, 1), "times: must rise, also from one episode of a recording to the next");
  EXPECT_EQ(error({{Nanos(2), Nanos(1)}, {Nanos(2)}}, 2),
            "times: must rise, also from one episode of a recording to the next");
}

TEST_F(Episodes, have_the_joints_that_the_recordings_hold_as_state) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  write_robot(folder_.file("1.mcap"), {{"/joint_states", milliseconds(100), {{"elbow", 1}, {"wrist", none}}},
                                       {"/joint_states", milliseconds(200), {{"gripper", 5}}},
                                       {"/joint_states", milliseconds(300), {{"elbow", 2}, {"wrist", 7}}}});
  write_robot(folder_.file("2.mcap"),
              {{"/joint_states", milliseconds(100), {{"wrist", 3}, {"gripper", 2}, {"elbow", 1}}}});
  Kept kept;
  EpisodeOptions options{.quantities = {"fresh"}};
  options.times = {{milliseconds(50), milliseconds(299), milliseconds(300)}, {milliseconds(400)}};
  const Result<EpisodeTally> made = make_episodes({folder_.file("1.mcap"), folder_.file("2.mcap")}, options, kept);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(kept.names(), (std::vector<std::string>{"time_ns", "state", "tip_fresh"}));
  EXPECT_EQ(kept.axes("state"), (std::vector<std::string>{"elbow", "gripper", "wrist"}));
  EXPECT_EQ(kept.column<float>("state"), (std::vector<float>{1, 5, 7, 1, 5, 7, 2, 5, 7, 1, 2, 3}));
}

TEST_F(Episodes, take_topics_by_their_names_and_ask_which_of_several_is_the_state) {
  const std::string path = folder_.file("two.mcap");
  write_robot(path,
              {{"/commands", milliseconds(100), {{"elbow", 2}}}, {"/joint_states", milliseconds(100), {{"elbow", 1}}}});
  EpisodeOptions options{.fps = 1.0, .quantities = {"fresh"}};
  std::vector<std::string> notices;
  options.notice = [&](const std::string& line) { notices.push_back(line); };
  Kept unnamed;
  ASSERT_TRUE(make_episodes({path}, options, unnamed));
  EXPECT_EQ(unnamed.names(), (std::vector<std::string>{"time_ns", "tip_fresh"}));
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices.front().find("/commands, /joint_states"), std::string::npos);
  options.actions = {"/commands"};
  Kept named;
  ASSERT_TRUE(make_episodes({path, path}, options, named));
  EXPECT_EQ(named.names(), (std::vector<std::string>{"time_ns", "state", "action", "tip_fresh"}));
  EXPECT_EQ(named.column<float>("state").front(), 1.0F);
  EXPECT_EQ(named.column<float>("action").front(), 2.0F);
}

TEST_F(Episodes, name_topics_and_joints_that_are_not_there) {
  const std::string path = folder_.file("robot.mcap");
  write_robot(path, {{"/joint_states", milliseconds(100), {{"elbow", 1}}}});
  EXPECT_EQ(error_of({path}, {.states = {"/joints"}}),
            path + ": has no topic '/joints' of joints; it has /joint_states");
  EXPECT_EQ(error_of({path_}, {.states = {"/joints"}}), path_ + ": has no topic '/joints' of joints; it has none");
  const std::string other = folder_.file("other.mcap");
  write_robot(other, {{"/joint_states", milliseconds(100), {{"knee", 1}}}});
  EXPECT_EQ(error_of({path, other}, {.states = {"/joint_states"}}),
            "/joint_states of " + other + ": has other columns than that of the first recording, which has elbow");
}

TEST_F(Episodes, have_no_state_with_a_notice_where_the_joints_differ) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto at = milliseconds(100);
  const std::string path = folder_.file("robot.mcap");
  write_robot(path, {{"/joint_states", at, {{"elbow", 1}, {"wrist", 2}}}});
  const std::string other = folder_.file("other.mcap");
  for (const auto& positions : {std::vector<std::pair<std::string, double>>{{"elbow", 1}, {"wrist", none}}, {}}) {
    write_robot(other, {{"/joint_states", at, positions}});
    std::vector<std::string> notices;
    EpisodeOptions options{.quantities = {"fresh"}};
    options.notice = [&](const std::string& line) { notices.push_back(line); };
    Kept kept;
    const Result<EpisodeTally> made = make_episodes({path, other}, options, kept);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(kept.names(), (std::vector<std::string>{"time_ns", "tip_fresh"}));
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_NE(notices.front().find("so there is no column of the state"), std::string::npos);
    EXPECT_NE(notices.front().find(other), std::string::npos);
  }
}

TEST_F(Episodes, have_no_state_where_none_is_wanted) {
  const std::string path = folder_.file("robot.mcap");
  write_robot(path, {{"/joint_states", milliseconds(100), {{"elbow", 1}}}});
  EpisodeOptions options{.quantities = {"fresh"}};
  options.finds_state = false;
  Kept kept;
  ASSERT_TRUE(make_episodes({path}, options, kept));
  EXPECT_EQ(kept.names(), (std::vector<std::string>{"time_ns", "tip_fresh"}));
}

TEST_F(Episodes, take_a_file_of_any_name_as_csv) {
  std::ofstream(folder_.file("joints.txt")) << "time_s,elbow\n0,3\n";
  Kept kept;
  const Result<EpisodeTally> made =
      make_episodes({path_}, {.quantities = {"fresh"}, .states = {folder_.file("joints.txt")}}, kept);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(kept.column<float>("state").front(), 3.0F);
}

TEST_F(Episodes, refuse_more_joints_than_a_robot_has) {
  std::vector<std::pair<std::string, double>> joints;
  for (int k = 0; k < 1025; ++k) joints.emplace_back("joint" + std::to_string(k), k);
  const std::string path = folder_.file("many.mcap");
  write_robot(path, {{"/joint_states", milliseconds(100), joints}});
  EXPECT_EQ(error_of({path}, {.states = {"/joint_states"}}),
            path + ": has more than 1024 joints in '/joint_states'; name another topic");
}

TEST_F(Episodes, may_begin_half_a_frame_after_the_first) {
  const std::string later = folder_.file("later.mcap");
  write_recording(later, even_times(3, milliseconds(1234)));
  EXPECT_EQ(first_step(later, 30.0).value(), milliseconds(1239));
  EXPECT_EQ(first_step(later, 1000.0).value(), std::chrono::microseconds(1'234'500)) << "or half a step";
  write_recording(later, even_times(1, milliseconds(1234)));
  EXPECT_EQ(first_step(later, 30.0).value(), milliseconds(1234));
  EXPECT_FALSE(first_step(later, 0.0));
  EXPECT_FALSE(first_step(folder_.file("none.mcap"), 30.0));
}

TEST_F(Episodes, need_frames_at_their_times) {
  EpisodeOptions options;
  options.times = {{milliseconds(100)}, {milliseconds(991)}};
  EXPECT_EQ(error_of({path_}, options), path_ + ": ends before the first step of episode 1; mend its times");
  options.times = {{milliseconds(-2), milliseconds(-1)}};
  EXPECT_EQ(error_of({path_}, options), path_ + ": begins after the last step of episode 0; mend its times");
}

TEST_F(Episodes, refuse_a_state_of_another_clock) {
  std::ofstream(folder_.file("joints.csv")) << "time_s,elbow\n500,1\n510.5,2\n";
  EXPECT_EQ(error_of({path_}, {.states = {folder_.file("joints.csv")}}),
            folder_.file("joints.csv") + ": its times are 500.000 to 510.500 s, the frames of " + path_ +
                " 0.000 to 1.005 s; give one on the clock of the frames");
}

/// The notices of a dataset that is made.
std::vector<std::string> notices_of(const std::vector<std::string>& recordings, EpisodeOptions options) {
  std::vector<std::string> notices;
  options.notice = [&](const std::string& line) { notices.push_back(line); };
  Kept kept;
  const Result<EpisodeTally> made = make_episodes(recordings, options, kept);
  EXPECT_TRUE(made) << made.error().message;
  return notices;
}

TEST_F(Episodes, say_how_many_steps_the_state_does_not_reach) {
  const std::string joints = folder_.file("joints.csv");
  std::ofstream(joints) << "time_s,elbow\n0.32,1\n0.42,2\n0.5,2\n";
  EXPECT_EQ(notices_of({path_}, {.fps = 20.0, .states = {joints}}),
            (std::vector<std::string>{joints + ": 16 of 21 steps of " + path_ +
                                      " have no number of their own: it has 0.320 to 0.500 s, the steps are 0.005 to "
                                      "1.005 s"}));
  std::ofstream(joints) << "time_s,elbow\n0,1\n0.95,2\n";
  EXPECT_EQ(notices_of({path_}, {.fps = 20.0, .states = {joints}}), std::vector<std::string>());
}

TEST_F(Episodes, refuse_a_state_whose_times_go_back) {
  const std::string joints = folder_.file("joints.csv");
  std::ofstream(joints) << "time_s,elbow\n0.5,1\n0.4,2\n";
  EXPECT_EQ(error_of({path_}, {.states = {joints}}), joints + ":3: time_s goes back");
}

TEST_F(Episodes, refuse_a_window_that_nothing_fills) {
  EXPECT_EQ(error_of({path_}, {.window = 101}),
            "window: no episode has 101 frames; 100 is the longest that one can fill");
  Kept kept;
  EXPECT_TRUE(make_episodes({path_}, {.window = 100}, kept));
}

TEST_F(Episodes, say_that_steps_come_faster_than_frames) {
  EXPECT_EQ(notices_of({path_}, {.fps = 200.0}),
            (std::vector<std::string>{
                "99 of 199 steps have no new frame: 200 steps a second, and no array sends more than 100"}));
  EXPECT_EQ(notices_of({path_}, {.fps = 100.0}), std::vector<std::string>());
}

TEST_F(Episodes, hold_the_last_ones_out) {
  const std::vector<std::string> recordings(5, path_);
  Kept kept;
  ASSERT_TRUE(make_episodes(recordings, {.hold_out = {"0.4"}}, kept));
  EXPECT_EQ(kept.tally().held_out, 2U);
  EXPECT_EQ(error_of(recordings, {.hold_out = {"0.01"}}), "hold-out: 0.01 of 5 episodes is none; give 0.2 to 0.8");
  EXPECT_EQ(error_of(recordings, {.hold_out = {"0.99"}}),
            "hold-out: 0.99 of 5 episodes is all of them; give 0.2 to 0.8");
  EXPECT_EQ(error_of({path_}, {.hold_out = {"0.5"}}), "hold-out: there is 1 episode; give more recordings");
  EXPECT_EQ(error_of(recordings, {.hold_out = {"1"}}), "hold-out: must be more than 0 and less than 1, such as 0.2");
}

TEST_F(Episodes, hold_named_recordings_out) {
  const std::string other = folder_.file("other.mcap");
  write_recording(other, even_times(50));
  Kept kept;
  ASSERT_TRUE(make_episodes({other, path_}, {.fps = 20.0, .hold_out = {"other.mcap"}}, kept));
  EXPECT_EQ(kept.ends(), (std::vector<std::size_t>{21, 32}));
  EXPECT_EQ(kept.tally().held_out, 1U);
  EXPECT_EQ(kept.tally().sources.back().recording, other);
  EXPECT_EQ(error_of({path_}, {.hold_out = {path_}}), "hold-out: names all recordings, so none is left to train on");
  EXPECT_EQ(error_of({path_, other}, {.hold_out = {"rec1.mcap"}}),
            "hold-out: 'rec1.mcap' is none of the recordings, and no share such as 0.2");
}

TEST_F(Episodes, tell_ages_and_taxels_that_have_no_reading) {
  const std::string path = folder_.file("faulty.mcap");
  const auto writer =
      bytes::recordings::SuitRecordingWriter::create(path, {{.name = "chest", .shape = {1, 3}}}, {.live = false});
  ASSERT_TRUE(writer);
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (int k = 0; k < 100; ++k) {
    RawFrame frame;
    frame.time = milliseconds(10 * k);
    frame.counts = {static_cast<float>(k), none, k == 50 ? none : 7.0F};
    if (k == 60) frame.counts = {none, none, none};
    ASSERT_TRUE((*writer)->write(0, frame));
  }
  ASSERT_TRUE((*writer)->commit());
  Kept kept;
  ASSERT_TRUE(make_episodes({path}, {.fps = 20.0}, kept));
  const ArrayTally& array = kept.tally().arrays.front();
  EXPECT_EQ(array.invalid, (std::vector<std::uint64_t>{0, 99, 1}));
  EXPECT_EQ(array.empty_frames, 1U);
  EXPECT_EQ(array.lowest, 0.0F);
  EXPECT_EQ(array.highest, 99.0F);
  EXPECT_EQ(array.oldest, milliseconds(15));
  EXPECT_EQ(array.first_picture[0], 0.0F);
  EXPECT_EQ(array.last_picture[0], 99.0F);
}

TEST_F(Episodes, need_a_model_for_a_tare) {
  EXPECT_EQ(error_of({path_}, {.tare = true}), "tare: needs a model: without one there are no forces");
  EXPECT_EQ(error_of({path_}, {.follow_drift = true}), "follow-drift: needs a model: without one there are no forces");
}

TEST_F(Episodes, name_what_is_wrong) {
  EXPECT_NE(error_of({path_}, {.fps = 0.0}).find("fps: must be"), std::string::npos);
  EXPECT_NE(error_of({path_}, {.window = 0}).find("window: must be"), std::string::npos);
  EXPECT_NE(error_of({path_}, {.quantities = {"force"}}).find("'force' is none of forces"), std::string::npos);
  EXPECT_NE(error_of({path_}, {.actions = {"a.csv", "b.csv"}}).find("2 files for 1 recordings"), std::string::npos);
  EXPECT_NE(error_of({folder_.file("none.mcap")}, {}).find("none.mcap"), std::string::npos);
  write_recording(folder_.file("wide.mcap"), even_times(3), 3);
  EXPECT_NE(error_of({path_, folder_.file("wide.mcap")}, {}).find("'left_hand' (1x2)"), std::string::npos);
}

// Steps at 20 Hz are at 5 ms, 55 ms and so on.
TEST_F(Episodes, have_the_label_in_force_at_each_step) {
  const std::string marked = folder_.file("marked.mcap");
  write_marked(marked, {{milliseconds(100), "reach"}, {milliseconds(200), "hold"}, {milliseconds(300), ""}});
  const std::string again = folder_.file("again.mcap");
  write_marked(again, {{milliseconds(300), "hold"}, {milliseconds(350), "", "", "tare"}, {milliseconds(400), "lift"}});
  const std::string bare = folder_.file("bare.mcap");
  write_marked(bare, {});
  Kept kept;
  ASSERT_TRUE(make_episodes({marked, again, bare}, {.fps = 20.0}, kept));
  EXPECT_EQ(kept.tally().labels, (std::vector<std::string>{"reach", "hold", "lift"}));
  EXPECT_EQ(kept.names()[1], "label");
  EXPECT_EQ(kept.ends(), (std::vector<std::size_t>{11, 22, 33}));
  EXPECT_EQ(kept.column<std::int64_t>("label"),
            (std::vector<std::int64_t>{-1, -1, 0,  0,  1,  1,  -1, -1, -1, -1, -1,  //
                                       -1, -1, -1, -1, -1, -1, 1,  1,  2,  2,  2,   //
                                       -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}));
  Kept alone;
  ASSERT_TRUE(make_episodes({bare}, {.fps = 20.0}, alone));
  EXPECT_EQ(alone.column<std::int64_t>("label").size(), 0U) << "nobody has marked anything";
}

TEST_F(Episodes, have_the_labels_that_were_edited_and_replace_what_is_no_text) {
  const std::string marked = folder_.file("marked.mcap");
  write_marked(marked, {{milliseconds(100), "reach"}});
  std::ofstream(folder_.file("marked.marks.csv")) << "time_s,label\n0.4,lift\xff\n";
  Kept kept;
  ASSERT_TRUE(make_episodes({marked}, {.fps = 20.0}, kept));
  EXPECT_EQ(kept.tally().labels, (std::vector<std::string>{"lift\xef\xbf\xbd"}));
  EXPECT_EQ(kept.column<std::int64_t>("label"), (std::vector<std::int64_t>{-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0}));
}

TEST_F(Episodes, are_cut_by_the_labels) {
  const std::string marked = folder_.file("marked.mcap");
  write_marked(marked, {{milliseconds(100), "reach"},
                        {milliseconds(200), "hold"},
                        {milliseconds(300), "hold"},
                        {milliseconds(350), ""},
                        {milliseconds(450), "reach"}});
  Kept kept;
  const Result<EpisodeTally> made = make_episodes({marked}, {.fps = 20.0, .cut = true}, kept);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(kept.ends(), (std::vector<std::size_t>{2, 4, 5, 7}));
  EXPECT_EQ(made->episodes, 4U);
  EXPECT_EQ(made->steps, 7U);
  EXPECT_EQ(kept.column<std::int64_t>("label"), (std::vector<std::int64_t>{0, 0, 1, 1, 1, 0, 0}));
  std::vector<std::int64_t> times;
  for (const int step : {2, 3, 4, 5, 6, 9, 10}) times.push_back(5'000'000 + 50'000'000 * step);
  EXPECT_EQ(kept.column<std::int64_t>("time_ns"), times);
  const std::vector<float> ages = kept.column<float>("tip_age");
  for (std::size_t k = 0; k < 6; ++k) EXPECT_FLOAT_EQ(ages[k], 0.005F) << "windows go on where nothing is labelled";
  ASSERT_EQ(made->sources.size(), 4U);
  EXPECT_EQ(made->sources[2].label, "hold");
  EXPECT_EQ(made->sources[2].first, made->sources[2].last);
  Kept held;
  ASSERT_TRUE(make_episodes({marked}, {.fps = 20.0, .hold_out = {"0.5"}, .cut = true}, held));
  EXPECT_EQ(held.tally().held_out, 2U);
}

TEST_F(Episodes, are_not_cut_without_a_label_to_cut_by) {
  EXPECT_EQ(
      error_of({path_}, {.cut = true}),
      "cut: '" + path_ + "' has no mark with a label; set some on the time line of 'dermis serve', or leave it out");
  const std::string marked = folder_.file("marked.mcap");
  write_marked(marked, {{milliseconds(100), "", "", "tare"}, {milliseconds(200), ""}});
  EXPECT_NE(error_of({marked}, {.cut = true}).find("has no mark with a label"), std::string::npos);
  std::ofstream(folder_.file("marked.marks.csv")) << "time_s,label\n7,late\n";
  EXPECT_EQ(error_of({marked}, {.cut = true}), "cut: " + marked + ": its labels lie at no step; mend its marks");
  EXPECT_EQ(error_of({marked}, {.times = {{milliseconds(100)}}, .cut = true}),
            "cut: takes the steps of a clock: give no times of steps");
}

TEST_F(Episodes, say_that_a_recording_was_tared_while_it_was_made) {
  const std::string model = folder_.file("tip.safetensors");
  ASSERT_TRUE(bytes::models::write_model(model, support::hand_made_model(1, 1)));
  const std::string tared = folder_.file("tared.mcap");
  write_marked(tared, {{milliseconds(100), "", "", "tare"}, {milliseconds(400), "", "", "tare"}});
  EXPECT_EQ(notices_of({tared}, {.model = model}),
            (std::vector<std::string>{
                "'" + tared +
                "' was tared while it was recorded, at 0.1 s, 0.4 s: make the dataset with a tare, or its "
                "forces begin at the zero of the calibration"}));
  EXPECT_EQ(notices_of({tared}, {}), std::vector<std::string>()) << "counts have no zero";
}

/// Their forces are by models of different gains.
class RecordedModels : public Episodes {
 protected:
  void SetUp() override {
    for (std::size_t k = 0; k < 2; ++k) {
      touch::pipeline::Model model = support::hand_made_model(1, 1);
      model.networks.gain = {k == 0 ? 1.0F : 3.0F};
      models_.push_back(folder_.file("tip" + std::to_string(k) + ".safetensors"));
      ASSERT_TRUE(bytes::models::write_model(models_[k], model));
      recordings_.push_back(folder_.file("rec" + std::to_string(k) + ".mcap"));
      write(recordings_[k], support::read_bytes(models_[k]));
    }
  }
  static void write(const std::string& path, const std::string& model) {
    write_tip(
        path, [](int k, RawFrame& frame) { frame.counts = {1e6F + 1e5F * static_cast<float>(k)}; },
        [](bytes::recordings::SuitRecordingWriter&, Nanos) {}, model);
  }
  [[nodiscard]] static std::vector<float> forces(const std::vector<std::string>& recordings,
                                                 const EpisodeOptions& options) {
    Kept kept;
    const Result<EpisodeTally> made = make_episodes(recordings, options, kept);
    EXPECT_TRUE(made) << made.error().message;
    return kept.column<float>("tip");
  }

  std::vector<std::string> models_;
  std::vector<std::string> recordings_;
};

TEST_F(RecordedModels, give_the_forces_where_none_is_named) {
  std::vector<float> expected;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::vector<float> by_file = forces({recordings_[k]}, {.model = models_[k]});
    expected.insert(expected.end(), by_file.begin(), by_file.end());
  }
  ASSERT_EQ(expected.size(), 32U);
  EXPECT_GT(expected[31], 2.0F * expected[15]) << "each by its own";
  EXPECT_EQ(forces(recordings_, {}), expected);
  const std::vector<float> by_first = forces(recordings_, {.model = models_[0]});
  EXPECT_EQ(by_first[31], by_first[15]) << "one that is named goes before them";
  EXPECT_EQ(notices_of(recordings_, {}),
            (std::vector<std::string>{"the forces are those of the models that the recordings hold"}));
}

TEST_F(RecordedModels, must_be_in_all_recordings) {
  const std::string bare = folder_.file("bare.mcap");
  write(bare, "");
  EXPECT_EQ(forces({recordings_[0], bare}, {}), std::vector<float>());
  EXPECT_EQ(notices_of({recordings_[0], bare}, {}),
            (std::vector<std::string>{"there are no forces: '" + bare + "' holds no model; name one for all"}));
  EXPECT_EQ(error_of({recordings_[0], bare}, {.tare = true}), "tare: needs a model: without one there are no forces");
  write(bare, "no model");
  EXPECT_NE(error_of({bare}, {}).find(bare + ": its model"), std::string::npos);
}

}  // namespace
}  // namespace dermis::out::datasets
