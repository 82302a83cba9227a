// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/marks.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/live/dds/publisher.hpp"
#include "out/serve/session_at_work.hpp"
#include "out/serve/small_suit.hpp"
#include "out/serve/stream_client.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::json;
using support::TemporaryFolder;

constexpr int kEnough = 60;

/// As topics have the name of its model: a recording that is played has no other.
std::string array_name() {
  return "hand_made";
}

std::vector<std::string> topics() {
  return {"/" + array_name() + "/force", "/contacts"};
}

/// By topic and time.
using Heard = std::map<std::pair<std::string, Nanos>, std::vector<std::uint8_t>>;

Heard hear(StreamClient& client, std::size_t messages) {
  Heard heard;
  for (std::size_t k = 0; k < messages; ++k) {
    StreamClient::Message message = client.next_message();
    heard[{message.topic, message.time}] = std::move(message.bytes);
  }
  return heard;
}

/// What a client of a live array hears, all frames of it, while the array is recorded, tared and marked.
Heard record(const std::string& path) {
  const std::atomic<bool> never = false;
  Work work(session_of(small_suit({array_name()}, never), options_with(path)));
  StreamClient client(work.port());
  client.set_parameter("/stream/rate_hz", "1000");
  client.set_parameter("/tare/force", "true");
  EXPECT_EQ(client.call("/marks/add", R"({"label":"grasp","by":"anna"})"), "{}");
  client.subscribe(topics());
  Heard heard = hear(client, 1500);
  EXPECT_TRUE(work.end());
  return heard;
}

std::unique_ptr<Session> play(const std::string& path, const std::string& model = {}) {
  Result<ServedSuit> suit = open_suit({.from = path, .model = model});
  EXPECT_TRUE(suit) << suit.error().message;
  return session_of(*std::move(suit), options_with());
}

/// So many of the messages of a player were heard live, and so many with the same bits. Frames that were recorded
/// before somebody listened come first.
std::pair<int, int> compare(const Heard& live, StreamClient& player) {
  std::pair<int, int> counts;
  for (int k = 0; k < 1200 && counts.first <= kEnough; ++k) {
    const StreamClient::Message message = player.next_message();
    const auto found = live.find({message.topic, message.time});
    if (found == live.end()) continue;
    ++counts.first;
    if (found->second == message.bytes) ++counts.second;
  }
  return counts;
}

TEST(PlayedResults, are_forces_and_contacts_as_they_were_live_with_the_same_bits) {
  const TemporaryFolder folder;
  const std::string path = folder.file("walk.mcap");
  const Heard live = record(path);
  Work work(play(path));
  StreamClient client(work.port());
  client.subscribe(topics());
  const auto [both, same] = compare(live, client);
  EXPECT_GT(both, kEnough);
  EXPECT_EQ(same, both);
  EXPECT_TRUE(work.end());
}

TEST(PlayedResults, are_computed_by_another_model_where_one_is_named) {
  const TemporaryFolder folder;
  const std::string path = folder.file("walk.mcap");
  const Heard live = record(path);
  touch::pipeline::Model model = support::hand_made_model(kRows, kCols);
  for (float& newtons : model.networks.gain) newtons *= 2.0F;
  ASSERT_TRUE(bytes::models::write_model(folder.file("other.safetensors"), model));
  Work work(play(path, folder.file("other.safetensors")));
  StreamClient client(work.port());
  client.subscribe({topics().front()});
  const auto [both, same] = compare(live, client);
  EXPECT_GT(both, kEnough);
  EXPECT_EQ(same, 0);
  EXPECT_TRUE(work.end());
}

TEST(PlayedResults, come_with_the_model_and_its_hash_in_the_recording) {
  const TemporaryFolder folder;
  const std::string path = folder.file("walk.mcap");
  record(path);
  const auto reader = bytes::recordings::RecordingReader::open(path);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto model = bytes::models::model_from_bytes((*reader)->notes().model_file, "chest");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(bytes::models::model_to_bytes(*model).value(),
            bytes::models::model_to_bytes(support::hand_made_model(kRows, kCols)).value());
  EXPECT_FALSE((*reader)->notes().model_hash.empty());
}

TEST(PlayedResults, marks_are_there_after_the_page_and_edited_beside_the_recording) {
  const TemporaryFolder folder;
  const std::string path = folder.file("walk.mcap");
  record(path);
  Work work(play(path));
  StreamClient client(work.port());
  json marks = json::parse(client.call("/marks/list", "{}"))["marks"];
  std::string labels;
  for (const json& mark : marks)
    labels += mark["event"].get<std::string>() + ":" + mark["label"].get<std::string>() + "\n";
  EXPECT_NE(labels.find(":grasp\n"), std::string::npos) << labels;
  EXPECT_NE(labels.find("tare:"), std::string::npos) << labels;

  EXPECT_EQ(client.call("/marks/set", R"({"times_s":[1e12],"labels":["late"]})"),
            "times_s: must be within the recording");
  EXPECT_EQ(client.call("/marks/set", R"({"times_s":[],"labels":["late"]})"), "labels: must be as many as times_s");
  const Nanos start = bytes::recordings::recording_info(path)->start_utc;
  const std::string at = std::to_string(1e-9 * static_cast<double>(start.count()) + 0.25);
  marks = json::parse(client.call("/marks/set", R"({"times_s":[)" + at + R"(],"labels":["lift"]})"))["marks"];
  const auto read = bytes::recordings::read_marks(path, start);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->size(), marks.size());
  labels.clear();
  for (const bytes::ros_messages::Mark& mark : *read) {
    if (mark.event.empty()) labels += mark.label;
  }
  EXPECT_EQ(labels, "lift");
  EXPECT_TRUE(work.end());
}

TEST(Marks, are_labels_of_ros_too) {
  const std::atomic<bool> never = false;
  SessionOptions options = options_with();
  options.dds =
      live::dds::PublisherOptions{.domain = 100U + static_cast<std::uint32_t>(::getpid() % 100), .loopback_only = true};
  Result<std::unique_ptr<Session>> session = Session::create(small_suit({"chest"}, never), options);
  if (!session) GTEST_SKIP() << session.error().message;
  Work work(*std::move(session));
  const auto publisher = live::dds::Publisher::create(*options.dds);
  ASSERT_TRUE(publisher) << publisher.error().message;
  const bytes::ros_messages::MessageType text{"std_msgs/msg/String", "string data\n", ""};
  const Result<live::dds::TopicId> topic = (*publisher)->add_topic({.name = "/mark", .type = text});
  ASSERT_TRUE(topic) << topic.error().message;
  const std::vector<std::uint8_t> lift = {0, 1, 0, 0, 5, 0, 0, 0, 'l', 'i', 'f', 't', 0};
  StreamClient client(work.port());
  std::string marks;
  while (marks.find("\"label\":\"lift\",\"by\":\"/mark\"") == std::string::npos) {
    (*publisher)->publish(*topic, lift);
    marks = client.call("/marks/list", "{}");
  }
  EXPECT_TRUE(work.end());
}

}  // namespace
}  // namespace dermis::out::serve
