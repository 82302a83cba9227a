// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/recording_services.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "out/serve/session_at_work.hpp"
#include "out/serve/small_suit.hpp"
#include "out/serve/stream_client.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::json;
using support::TemporaryFolder;

/// The answer of a service of recordings.
json ask(StreamClient& client, const std::string& service, const std::string& request = "{}") {
  const std::string answer = client.call("/recordings/" + service, request);
  json parsed = json::parse(answer, nullptr, false);
  if (!parsed.is_object()) ADD_FAILURE() << service << ": " << answer;
  return parsed;
}

TEST(RecordingServices, records_under_the_name_that_a_client_chooses_and_plays_it_beside_the_arrays) {
  const TemporaryFolder folder;
  const std::atomic<bool> never = false;
  Work work(session_of(small_suit({"left", "right"}, never), options_with(folder.file("first.mcap"))));
  StreamClient client(work.port());
  client.set_parameter("/recording", "false");
  EXPECT_EQ(client.call("/recordings/begin", R"({"name":"../walk"})"), "name: must be letters, digits, '_' and '-'");
  EXPECT_EQ(ask(client, "begin", R"({"name":"walk"})")["file"], "walk.mcap");
  EXPECT_NE(client.call("/recordings/begin", R"({"name":"other"})").find("a recording goes on"), std::string::npos);
  EXPECT_EQ(ask(client, "list")["recording"], "walk.mcap");
  client.subscribe({"/left/raw"});
  for (int frame = 0; frame < 20; ++frame) EXPECT_FALSE(client.next_message("/left/raw").bytes.empty());
  client.set_parameter("/recording", "false");
  EXPECT_NE(client.call("/recordings/begin", R"({"name":"walk"})").find("is there already"), std::string::npos);
  const json files = ask(client, "list")["files"];
  ASSERT_EQ(files.size(), 2U);

  EXPECT_NE(client.call("/recordings/play", R"({"name":"../walk.mcap"})").find("no recording"), std::string::npos);
  for (int time = 0; time < 2; ++time) {
    StreamClient player(ask(client, "play", R"({"name":"walk.mcap"})")["port"].get<std::uint16_t>());
    player.subscribe({"/right/force"});
    EXPECT_FALSE(player.next_message("/right/force").bytes.empty());
  }
  EXPECT_FALSE(client.next_message("/left/raw").bytes.empty()) << "the arrays are served as before";
  EXPECT_TRUE(work.end());
}

TEST(RecordingServices, saves_what_nobody_has_recorded_while_it_is_of_the_last_minute) {
  const TemporaryFolder folder;
  const std::atomic<bool> never = false;
  Work work(session_of(small_suit({"left", "right"}, never), options_with(folder.file("first.mcap"))));
  StreamClient client(work.port());
  client.subscribe({"/left/raw", "/right/raw"});
  for (int frame = 0; frame < 20; ++frame) EXPECT_FALSE(client.next_message("/left/raw").bytes.empty());
  EXPECT_FALSE(client.next_message("/right/raw").bytes.empty());
  const json cut = ask(client, "save");
  EXPECT_GT(cut["frames"], 20U);
  const std::vector<std::size_t> frames = recorded_frames(folder.file(cut["file"]));
  EXPECT_EQ(frames[0] + frames[1], cut["frames"]);
  const json csv = ask(client, "save", R"({"array":"right"})");
  EXPECT_TRUE(csv["file"].get<std::string>().starts_with("right-"));
  EXPECT_EQ(bytes::recordings::read_frames(folder.file(csv["file"]))->size(), csv["frames"]);
  EXPECT_TRUE(std::filesystem::is_regular_file(folder.file(csv["forces"])));
  EXPECT_EQ(ask(client, "list")["folder"], std::filesystem::path(folder.file("x")).parent_path().string());
  EXPECT_EQ(client.call("/recordings/save", R"({"array":"back"})"), "array: there is none of that name");
  EXPECT_EQ(client.call("/recordings/save", R"({"to_ms":1})"),
            "there is no frame of that time any more; the last minute is kept");
  EXPECT_NE(client.call("/recordings/save", R"({"from_ms":9999999999999999999})").find("from_ms"), std::string::npos);
  EXPECT_TRUE(work.end());
}

}  // namespace
}  // namespace dermis::out::serve
