// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/session.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bytes/ros_messages/read_by_definition.hpp"
#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "out/serve/named_touches.hpp"
#include "out/serve/session_at_work.hpp"
#include "out/serve/small_suit.hpp"
#include "out/serve/stream_client.hpp"
#include "support/stalled_disk.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::json;
using support::TemporaryFolder;

constexpr std::uint64_t kSeed = 3;

json value_of(const std::string& parameters, const std::string& name) {
  for (const json& parameter : json::parse(parameters)) {
    if (parameter["name"] == name) return parameter["value"];
  }
  ADD_FAILURE() << "no " << name << " in " << parameters;
  return {};
}

/// An array under a hand that does what the guide says, as fast as it is read.
class GuidedArray final : public FrameSource {
 public:
  GuidedArray(const ArrayDescription& array, std::shared_ptr<live::sources::GuideVoice> voice)
      : handled_(array, {}, kSeed), voice_(std::move(voice)), force_n_(array.taxel_count()) {
    voice_->listen();
  }

  Result<bool> next(RawFrame& frame) override {
    const live::sources::GuideWords words = voice_->words();
    force_n_.assign(force_n_.size(), 0.0);
    if (words.press) force_n_[words.taxel] = words.weight_n;
    if (words.press && words.together_with) force_n_[*words.together_with] = words.weight_n;
    frame = handled_.frame(force_n_);
    return true;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return FrameShape{kRows, kCols}; }

 private:
  learn::calibration::HandledArray handled_;
  std::shared_ptr<live::sources::GuideVoice> voice_;
  std::vector<double> force_n_;
};

/// An array of noise that a hand presses when it is told, as fast as it is read.
class NoisyArray final : public FrameSource {
 public:
  NoisyArray(const ArrayDescription& array, const std::atomic<bool>& is_pressed)
      : shape_{array.rows, array.cols}, handled_(array, {}, kSeed), random_(kSeed), is_pressed_(is_pressed) {}

  Result<bool> next(RawFrame& frame) override {
    time_ += std::chrono::milliseconds(1);
    frame.time = time_;
    frame.counts.resize(shape_.taxel_count());
    for (float& counts : frame.counts) counts = static_cast<float>(random_.below(1000));
    if (is_pressed_) {
      frame = handled_.frame(std::vector<double>(shape_.taxel_count(), 20.0));
      frame.time = time_;
    }
    return true;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }

 private:
  FrameShape shape_;
  learn::calibration::HandledArray handled_;
  Random random_;
  const std::atomic<bool>& is_pressed_;
  Nanos time_{};
};

/// The next message of a topic that `is_awaited`.
template <typename IsAwaited>
json await(StreamClient& client, const std::string& topic, const bytes::ros_messages::MessageType& type,
           const IsAwaited& is_awaited) {
  for (;;) {
    json message = bytes::ros_messages::read_by_definition(type, client.next_message(topic).bytes);
    if (is_awaited(message)) return message;
  }
}

TEST(Session, streams_every_topic_of_all_arrays) {
  const std::atomic<bool> never = false;
  Work work(session_of(small_suit({"left", "right"}, never), options_with()));
  StreamClient client(work.port());
  const std::vector<std::string> topics = {"/left/raw",    "/left/conductance", "/left/force",
                                           "/right/force", "/suit/points",      "/contacts",
                                           "/health",      "/statistics",       "/tf"};
  client.subscribe(topics);
  for (const std::string& topic : topics) EXPECT_FALSE(client.next_message(topic).bytes.empty()) << topic;
}

TEST(Session, works_in_pieces_where_it_has_one_thread) {
  const std::atomic<bool> never = false;
  ServedSuit suit = small_suit({"sheet"}, never);
  auto source = live::sources::open_source(fmt::format("sim:touches?rate=200&rows={}&cols={}", kRows, kCols));
  ASSERT_TRUE(source) << source.error().message;
  suit.arrays[0].source = *std::move(source);
  const std::unique_ptr<Session> session = session_of(std::move(suit), options_with());
  std::atomic<bool> stop = false;
  std::thread works([&] {
    for (; !stop; std::this_thread::sleep_for(std::chrono::milliseconds(1))) session->work();
  });
  StreamClient client(session->port());
  const std::vector<std::string> topics = {"/sheet/force", "/contacts", "/suit/points", "/health", "/statistics"};
  client.subscribe(topics);
  for (const std::string& topic : topics) EXPECT_FALSE(client.next_message(topic).bytes.empty()) << topic;
  stop = true;
  works.join();
}

TEST(Session, moves_the_body_as_its_clients_say) {
  const std::atomic<bool> never = false;
  ServedSuit suit = small_suit({"sleeve"}, never);
  Body body{"arm", {{"trunk"}, {"forearm"}}, {}};
  body.joints.push_back({"slide", BodyJoint::Kind::sliding, 0, 1, {}, {1.0, 0.0, 0.0}});
  suit.body = std::make_shared<WornBody>(std::make_shared<BodyParts>(BodyParts{*make_body(std::move(body)), {}}),
                                         std::vector<WornBody::Carried>{{1, {}}});
  Work work(session_of(std::move(suit), options_with()));
  StreamClient client(work.port());
  client.subscribe({"/tf"});
  EXPECT_EQ(client.call("/body/joints", R"({"name": ["slide"], "position": [0.25]})"), "{}");
  const json moved = await(client, "/tf", bytes::ros_messages::transforms_type(), [](const json& message) {
    return message["transforms"][0]["transform"]["translation"]["x"] == 0.25;
  });
  EXPECT_EQ(moved["transforms"][0]["child_frame_id"], "sleeve");
}

TEST(Session, takes_parameters_from_its_clients) {
  const std::atomic<bool> never = false;
  Work work(session_of(small_suit({"left", "right"}, never), options_with()));
  StreamClient client(work.port());
  EXPECT_EQ(value_of(client.set_parameter("/stream/rate_hz", "10.0"), "/stream/rate_hz"), 10.0);
  EXPECT_EQ(value_of(client.set_parameter("/left/tare", "true"), "/left/tare"), true);
  const std::string all = client.parameters();
  EXPECT_EQ(value_of(all, "/stream/rate_hz"), 10.0);
  EXPECT_EQ(value_of(all, "/right/tare"), false);
}

/// Waits until a frame of each array is recorded: it is sent first, but recorded before the next is sent.
void hear_a_recorded_frame(std::uint16_t port) {
  StreamClient client(port);
  for (const char* const topic : {"/left/force", "/right/force"}) {
    client.subscribe({topic});
    for (int k = 0; k < 2; ++k) static_cast<void>(client.next_message(topic));
  }
}

TEST(Session, records_from_its_beginning_and_again_when_a_client_asks) {
  const TemporaryFolder folder;
  const std::atomic<bool> never = false;
  Work work(session_of(small_suit({"left", "right"}, never), options_with(folder.file("rec.mcap"))));
  StreamClient client(work.port());
  hear_a_recorded_frame(work.port());
  client.set_parameter("/recording", "false");
  client.set_parameter("/recording", "true");
  const std::string second = value_of(client.parameters(), "/recording/file");
  EXPECT_NE(second, folder.file("rec.mcap"));
  hear_a_recorded_frame(work.port());
  ASSERT_TRUE(work.end());
  for (const std::string& path : {folder.file("rec.mcap"), second}) {
    const std::vector<std::size_t> frames = recorded_frames(path);
    ASSERT_EQ(frames.size(), 2U) << path;
    EXPECT_GT(frames[0], 0U) << path;
    EXPECT_GT(frames[1], 0U) << path;
  }
}

TEST(Session, calibrates_an_array_at_work_and_takes_the_model_into_use) {
  const TemporaryFolder folder;
  const auto model = std::make_shared<const touch::pipeline::Model>(support::hand_made_model(kRows, kCols));
  ServedSuit suit;
  auto source = std::make_unique<GuidedArray>(model->array, suit.guide);
  suit.arrays.push_back({"chest",
                         std::move(source),
                         model,
                         ArraySurface::create(model->array).value(),
                         {},
                         model->array,
                         folder.file("chest.toml")});
  Work work(session_of(std::move(suit), options_with()));
  StreamClient client(work.port());
  client.subscribe({"/calibration"});
  const std::string plan = R"({"weights_n": [2, 5, 10], "taxels": "all", "unloaded_s": 0.5, "hold_s": 0.2})";
  ASSERT_EQ(client.call("/calibration/start", plan), "{}");
  EXPECT_FALSE(client.next_message("/calibration").bytes.empty());
  client.set_parameter("/tare", "true");
  std::string saved;
  do {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    saved = client.call("/calibration/save", "{}");
  } while (saved == "the model is not ready; finish first");
  const std::string file = json::parse(saved)["file"];
  EXPECT_TRUE(std::filesystem::exists(folder.file(file)));
  EXPECT_EQ(value_of(client.parameters(), "/tare"), false) << "the new model begins at its own zero";
}

TEST(Session, plays_a_recording_on_its_own_clock) {
  const TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  {
    const auto writer =
        bytes::recordings::SuitRecordingWriter::create(path, {{.name = "chest", .shape = {kRows, kCols}}});
    learn::calibration::HandledArray handled(support::hand_made_model(kRows, kCols).array, {}, kSeed);
    for (int k = 0; k < 300; ++k) {
      ASSERT_TRUE((*writer)->write(0, handled.frame(std::vector<double>(kRows * kCols))));
    }
    ASSERT_TRUE((*writer)->commit());
  }
  const std::atomic<bool> never = false;
  ServedSuit suit = small_suit({"chest"}, never);
  suit.playback = live::suits::Playback::open(path).value();
  suit.arrays[0].source = suit.playback->source(0);
  Work work(session_of(std::move(suit), options_with()));
  StreamClient client(work.port());
  client.subscribe({"/chest/force", "/statistics"});
  for (const char* const topic : {"/chest/force", "/statistics"}) {
    EXPECT_LE(client.next_message(topic).time, std::chrono::seconds(3)) << topic;
  }
  EXPECT_TRUE(work.end());
}

TEST(Session, shows_a_playback_that_has_ended_to_who_comes_then) {
  const TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  {
    const auto writer =
        bytes::recordings::SuitRecordingWriter::create(path, {{.name = "chest", .shape = {kRows, kCols}}});
    learn::calibration::HandledArray handled(support::hand_made_model(kRows, kCols).array, {}, kSeed);
    ASSERT_TRUE((*writer)->write(0, handled.frame(std::vector<double>(kRows * kCols))));
    ASSERT_TRUE((*writer)->commit());
  }
  const std::atomic<bool> never = false;
  ServedSuit suit = small_suit({"chest"}, never);
  suit.playback = live::suits::Playback::open(path).value();
  suit.arrays[0].source = suit.playback->source(0);
  Work work(session_of(std::move(suit), options_with()));
  for (int viewer = 0; viewer < 3; ++viewer) {
    StreamClient client(work.port());
    client.subscribe({"/chest/force"});
    EXPECT_EQ(client.next_message("/chest/force").bytes.empty(), false) << viewer;
  }
  EXPECT_TRUE(work.end());
}

TEST(Session, names_touches_and_watches_limits_for_its_clients_and_in_its_recording) {
  const TemporaryFolder folder;
  const std::atomic<bool> never = false;
  ServedSuit suit = small_suit({"left", "right"}, never);
  learn::recognition::Classes classes = left_and_right();
  suit.arrays[0].classes = std::move(classes);
  suit.threats = live::threats::ThreatLimits{
      {}, {{.name = "pushed", .quantity = live::threats::ThreatQuantity::total_force, .limit = 100.0}}};
  suit.classes = suit.arrays[0].classes;
  suit.classes->layout.arrays[0].name = "right";
  Work work(session_of(std::move(suit), options_with(folder.file("rec.mcap"))));
  StreamClient client(work.port());
  client.subscribe({"/left/recognition", "/suit/recognition", "/threat"});
  EXPECT_FALSE(client.next_message("/left/recognition").bytes.empty());
  EXPECT_FALSE(client.next_message("/suit/recognition").bytes.empty());
  EXPECT_FALSE(client.next_message("/threat").bytes.empty());
  EXPECT_EQ(client.call("/threats/reset", "{}"), "{}");
  ASSERT_TRUE(work.end());
  EXPECT_GT(recorded_frames(folder.file("rec.mcap"))[0], 0U);
  const auto info = bytes::recordings::McapReader::open(folder.file("rec.mcap"));
  ASSERT_TRUE(info);
  bool is_recorded = false;
  for (const auto& [id, channel] : (*info)->channels()) is_recorded |= channel.topic == "/left/recognition";
  EXPECT_TRUE(is_recorded);
}

TEST(Session, tells_a_threat_while_the_disk_of_its_recording_stands_still) {
  const TemporaryFolder folder;
  support::StalledDisk disk(folder.file("rec.mcap"));
  std::atomic<bool> is_pressed = false;
  const auto model = std::make_shared<const touch::pipeline::Model>(support::hand_made_model(32, 32));
  ServedSuit suit;
  suit.arrays.push_back({"chest",
                         std::make_unique<NoisyArray>(model->array, is_pressed),
                         model,
                         ArraySurface::create(model->array).value(),
                         {},
                         model->array});
  suit.threats = live::threats::ThreatLimits{
      {}, {{.name = "pushed", .quantity = live::threats::ThreatQuantity::total_force, .limit = 1000.0}}};
  Work work(session_of(std::move(suit), options_with(folder.file("rec.mcap"))));
  StreamClient client(work.port());
  client.subscribe({"/statistics", "/threat"});
  const auto has_no_room = [](const json& statistics) { return statistics["recording_left_out"] > 0; };
  static_cast<void>(await(client, "/statistics", bytes::ros_messages::statistics_type(), has_no_room));

  const auto pressed = std::chrono::steady_clock::now();
  is_pressed = true;
  const auto begins = [](const json& threat) { return threat["changed"] == true && threat["state"] == 2; };
  EXPECT_EQ(await(client, "/threat", bytes::ros_messages::threat_type(), begins)["name"], "pushed");
  const std::chrono::duration<double, std::milli> delay = std::chrono::steady_clock::now() - pressed;
  RecordProperty("ms_to_threat", std::to_string(delay.count()));

  disk.flow_into(folder.file("flown.mcap"));
  ASSERT_TRUE(work.end());
  disk.await_end();
  EXPECT_GT(recorded_frames(folder.file("flown.mcap"))[0], 0U);
  const auto info = bytes::recordings::McapReader::open(folder.file("flown.mcap"));
  ASSERT_TRUE(info);
  bool is_recorded = false;
  for (const auto& [id, channel] : (*info)->channels()) is_recorded |= channel.topic == "/threat";
  EXPECT_TRUE(is_recorded) << "events have room of their own";
}

TEST(Session, refuses_classes_and_limits_that_do_not_fit_an_array) {
  const std::atomic<bool> never = false;
  ServedSuit named = small_suit({"chest"}, never);
  named.arrays[0].classes = left_and_right();
  named.arrays[0].classes->layout.arrays[0].row_pitch_mm = 0.0;
  const auto unlike = Session::create(std::move(named), options_with());
  ASSERT_FALSE(unlike);
  EXPECT_TRUE(unlike.error().message.starts_with("array 'chest': ")) << unlike.error().message;
  ServedSuit limited = small_suit({"chest"}, never);
  limited.threats =
      live::threats::ThreatLimits{{{"neck", "chest", 0, 9, 0, 1}}, {{.name = "n", .limit = 1.0, .zone = "neck"}}};
  const auto outside = Session::create(std::move(limited), options_with());
  ASSERT_FALSE(outside);
  EXPECT_TRUE(outside.error().message.starts_with("array 'chest': zone 'neck'")) << outside.error().message;
}

TEST(Session, refuses_a_port_that_is_taken_and_an_address_that_needs_a_token) {
  const std::atomic<bool> never = false;
  const std::unique_ptr<Session> first = session_of(small_suit({"chest"}, never), options_with());
  SessionOptions options;
  options.server.port = first->port();
  EXPECT_FALSE(Session::create(small_suit({"chest"}, never), options));
  options.server.host = "0.0.0.0";
  EXPECT_FALSE(Session::create(small_suit({"chest"}, never), options));
}

TEST(Session, refuses_an_array_that_would_hear_what_its_server_publishes) {
  const std::atomic<bool> never = false;
  const auto domain = static_cast<std::uint32_t>(100 + ::getpid() % 100);
  SessionOptions options = options_with();
  options.dds = {.domain = domain, .loopback_only = true};
  if (const auto alone = Session::create(small_suit({"chest"}, never), options); !alone) {
    GTEST_SKIP() << alone.error().message;
  }
  const auto serve_from = [&](const std::string& topic) {
    ServedSuit suit = small_suit({"chest", "arm"}, never);
    suit.arrays[0].from = fmt::format("dds://{}/{}?type=dermis_msgs/RawFrame", domain, topic);
    return Session::create(std::move(suit), options);
  };
  for (const std::string topic :
       {"rt/chest/frame", "rt/chest/raw", "rt/chest/force", "rt/arm/frame", "rt/suit/points"}) {
    const auto echo = serve_from(topic);
    ASSERT_FALSE(echo) << topic;
    EXPECT_EQ(echo.error().message,
              fmt::format("array 'chest': comes from '{}' of domain {}, which this server publishes itself; give its "
                          "arrays other names, or serve them in another domain",
                          topic, domain));
  }
  const auto of_another = serve_from("rt/hand/frame");
  EXPECT_TRUE(of_another) << of_another.error().message;
}

TEST(Session, refuses_arrays_that_cannot_work_and_recordings_that_cannot_be_written) {
  const std::atomic<bool> never = false;
  ServedSuit suit = small_suit({"chest"}, never);
  suit.arrays[0].model = std::make_shared<const touch::pipeline::Model>(support::hand_made_model(kRows, kCols + 1));
  const auto misfit = Session::create(std::move(suit), options_with());
  ASSERT_FALSE(misfit);
  EXPECT_TRUE(misfit.error().message.starts_with("array 'chest': ")) << misfit.error().message;
  const auto nowhere = Session::create(small_suit({"chest"}, never), options_with("/nowhere/rec.mcap"));
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("/nowhere/rec.mcap"), std::string::npos);
}

}  // namespace
}  // namespace dermis::out::serve
