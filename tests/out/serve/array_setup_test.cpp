// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/array_setup.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "dermis/bytes/files/array_toml.hpp"
#include "out/serve/stream_client.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

SessionOptions any_port() {
  SessionOptions options;
  options.server.port = 0;
  return options;
}

/// In a folder of its own, which is the current one meanwhile.
class ArraySetupTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(folder_.file("")); }
  void TearDown() override { std::filesystem::current_path(before_); }

 private:
  support::TemporaryFolder folder_;
  std::filesystem::path before_ = std::filesystem::current_path();
};

TEST_F(ArraySetupTest, writes_the_array_that_a_client_describes) {
  const auto setup = ArraySetup::create("sim:idle?rate=100&rows=3&cols=4", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  std::atomic<bool> stop = false;
  DescribedArray described;
  std::thread work([&] { described = (*setup)->run(stop); });

  StreamClient client((*setup)->port());
  const auto answer = [&](const std::string& request) { return client.call("/array/describe", request); };
  EXPECT_NE(answer("[]").find("JSON"), std::string::npos);
  EXPECT_NE(answer(R"({"name":"../mat","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10})").find("name"),
            std::string::npos);
  EXPECT_NE(answer(R"({"name":"mat","rows":0,"cols":4,"pitch_um":8000,"adc_bits":10})").find("rows"),
            std::string::npos);
  EXPECT_NE(answer(R"({"name":"mat","rows":3,"cols":4,"pitch_um":8000})").find("adc_bits"), std::string::npos);
  std::filesystem::create_directory("there");
  std::ofstream("there/array.toml") << "mine";
  EXPECT_NE(answer(R"({"name":"there","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10})").find("there already"),
            std::string::npos);
  EXPECT_NE(answer(R"({"name":"mat","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10})").find("mat/array.toml"),
            std::string::npos);
  stop = HasFailure();  // nobody is served then
  work.join();

  EXPECT_EQ(described.from, "sim:idle?rate=100&rows=3&cols=4");
  EXPECT_EQ(described.model, "mat/array.toml");
  EXPECT_TRUE(described.is_new);
  const Result<ArrayDescription> array = bytes::files::read_array(described.model);
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->name, "mat");
  EXPECT_EQ((FrameShape{array->rows, array->cols}), (FrameShape{3, 4}));
  EXPECT_DOUBLE_EQ(array->row_pitch_m, 0.008);
  EXPECT_EQ(array->readout.adc_bits, 10);
  EXPECT_EQ(array->readout.circuit, Circuit::automatic);
}

TEST_F(ArraySetupTest, ends_with_nothing_where_it_is_stopped) {
  const auto setup = ArraySetup::create("sim:idle?rate=100&rows=3&cols=4", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  const std::atomic<bool> stop = true;
  EXPECT_EQ((*setup)->run(stop).model, "");
}

TEST_F(ArraySetupTest, is_not_for_a_source_that_cannot_be) {
  EXPECT_FALSE(ArraySetup::create("serial:///dev/no_such_tty", any_port(), {}));
  EXPECT_FALSE(ArraySetup::create("sim:idle?bogus=1", any_port(), {}));
}

TEST_F(ArraySetupTest, serves_bytes_of_which_no_frame_can_be_made) {
  std::ofstream file("bytes");
  for (int line = 0; line < 20; ++line) file << "1,2,3,4,5,6\n";
  file.close();
  EXPECT_TRUE(ArraySetup::create("file:bytes", any_port(), {}));
}

/// Asks until the answer has these words; the test is ended by its time limit.
std::string ask_until(StreamClient& client, const std::string& service, const std::string& words) {
  for (;;) {
    std::string answer = client.call(service, "{}");
    if (answer.find(words) != std::string::npos) return answer;
  }
}

TEST_F(ArraySetupTest, reads_the_source_by_the_layout_that_a_client_brings) {
  std::ofstream file("bytes");
  for (int line = 0; line < 20; ++line) file << "Frame " << line << ": 1 2 3 4 5 6\n";
  file.close();
  const auto setup = ArraySetup::create("file:bytes", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  const std::string layout = R"("layout":["[layout]","rows = 2","cols = 3","line = 'Frame {frame}: {values}'"])";
  EXPECT_NE(client.call("/layout/use", R"({"name":"mat","layout":["rows"]})").find("mat/layout.toml"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists("mat/layout.toml")) << "it is none";
  EXPECT_EQ(client.call("/layout/use", R"({"name":"mat",)" + layout + "}"),
            R"({"from":"file:bytes?layout=mat/layout.toml"})");
  EXPECT_EQ(client.call("/layout/use", R"({"name":"mat",)" + layout + "}"),
            R"({"from":"file:bytes?layout=mat/layout.toml"})")
      << "it is the same";
  const std::string another = R"({"name":"mat","layout":["[layout]","rows = 1","cols = 6","line = '{values}'"]})";
  EXPECT_NE(client.call("/layout/use", another).find("there already"), std::string::npos);
  EXPECT_NE(
      client.call("/layout/use", R"({"name":"mat","layout":["[layout]","rows = 1","cols = 6","line = '{values}'"]})")
          .find("there already"),
      std::string::npos);
}

TEST_F(ArraySetupTest, tells_where_the_array_is_touched) {
  const auto setup = ArraySetup::create("sim:idle?rate=100&rows=3&cols=4", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  EXPECT_EQ(client.call("/array/touch", "{}"), "nothing is watched");
  EXPECT_EQ(client.call("/array/watch", R"({"rows":3,"cols":4})"), "{}");
  const std::string answer = ask_until(client, "/array/touch", R"("ready":true)");
  EXPECT_EQ(answer.find(R"({"ready":true,"touched":null,"problem":"","counts":[)"), 0U) << answer;
  EXPECT_EQ(std::ranges::count(answer, ','), 3 + 11) << answer;
  EXPECT_EQ(client.call("/array/watch", R"({"rows":4,"cols":4})"), "{}");
  ask_until(client, "/array/touch", "rows and cols are not those of the frames");
}

TEST_F(ArraySetupTest, opens_only_what_it_offers) {
  const auto setup = ArraySetup::create("", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  EXPECT_NE(client.call("/source/list", "{}").find("\"ports\":["), std::string::npos);
  std::ofstream("bytes") << "1,2,3\n";
  for (const char* path : {"/etc/passwd", "bytes", "/dev/ttyACM99999", "/dev/null?baud=1"}) {
    EXPECT_EQ(client.call("/source/open", R"({"port":")" + std::string(path) + "\"}"),
              "port: is none of the serial ports of this machine");
    EXPECT_EQ(client.call("/source/open", R"({"recording":")" + std::string(path) + "\"}"),
              "recording: is none of this folder");
  }
  EXPECT_EQ(client.call("/source/open", R"({"simulation":"idle"})"), "simulation: is none of those offered");
  for (const char* address : {"file:bytes", "serial:///dev/null", "sim:idle?rate=1", "stdin:"}) {
    const std::string answer = client.call("/source/open", R"({"address":")" + std::string(address) + "\"}");
    EXPECT_EQ(answer.find("\"from\""), std::string::npos) << answer;
  }
  EXPECT_EQ(client.call("/source/open", R"({"address":"file://bytes"})"),
            "address: must be HOST:PORT, or begin with tcp://, tcp-listen:// or udp://");
  EXPECT_EQ(client.call("/array/describe", R"({"name":"mat","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10})"),
            "choose where the array is first");
}

TEST_F(ArraySetupTest, serves_an_array_from_last_time_at_the_source_that_a_client_chooses) {
  ArrayDescription array;
  array.name = "old";
  array.rows = array.cols = 16;
  array.row_pitch_m = array.col_pitch_m = 0.01;
  array.readout.circuit = Circuit::automatic;
  array.readout.adc_bits = 12;
  ASSERT_TRUE(bytes::files::write_array("old.toml", array));
  array.rows = 3;
  array.name = "other";
  ASSERT_TRUE(bytes::files::write_array("other.toml", array));
  std::ofstream("unrelated.toml") << "[threats]\n";
  const auto setup = ArraySetup::create("", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  EXPECT_EQ(client.call("/array/use", R"({"file":"old.toml"})"), "choose where the array is first");
  const std::string known = client.call("/array/known", "{}");
  EXPECT_NE(known.find(R"({"file":"old.toml","name":"old","rows":16,"cols":16,"calibrated":false,"from":""})"),
            std::string::npos)
      << known;
  EXPECT_EQ(known.find("unrelated"), std::string::npos);
  EXPECT_EQ(client.call("/source/open", R"({"simulation":"contacts"})"), R"({"from":"sim:contacts?rate=100"})");
  EXPECT_EQ(client.call("/array/use", R"({"file":"unrelated.toml"})"), "file: is none of the arrays of this folder");
  EXPECT_EQ(client.call("/array/use", R"({"file":"other.toml"})"), "rows and cols are not those of the frames");
  std::atomic<bool> stop = false;
  DescribedArray described;
  std::thread work([&] { described = (*setup)->run(stop); });
  EXPECT_EQ(client.call("/array/use", R"({"file":"old.toml"})"), R"({"file":"old.toml"})");
  stop = HasFailure();  // nobody is served then
  work.join();
  EXPECT_EQ(described.from, "sim:contacts?rate=100");
  EXPECT_EQ(described.model, "old.toml");
}

TEST_F(ArraySetupTest, finds_an_array_of_last_time_by_one_call) {
  ArrayDescription array;
  array.name = "mat";
  array.rows = array.cols = 16;
  array.row_pitch_m = array.col_pitch_m = 0.01;
  array.readout.circuit = Circuit::automatic;
  array.readout.adc_bits = 12;
  std::filesystem::create_directory("mat");
  ASSERT_TRUE(bytes::files::write_array("mat/array.toml", array));
  std::ofstream("mat/source.toml") << "from = \"sim:contacts?rate=100\"\n";
  const auto setup = ArraySetup::create("", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  const std::string known = client.call("/array/known", "{}");
  EXPECT_NE(known.find(R"("file":"mat/array.toml","name":"mat")"), std::string::npos) << known;
  EXPECT_NE(known.find(R"("from":"sim:contacts?rate=100")"), std::string::npos) << known;
  std::atomic<bool> stop = false;
  DescribedArray described;
  std::thread work([&] { described = (*setup)->run(stop); });
  EXPECT_EQ(client.call("/array/use", R"({"file":"mat/array.toml"})"), R"({"file":"mat/array.toml"})");
  stop = HasFailure();  // nobody is served then
  work.join();
  EXPECT_EQ(described.from, "sim:contacts?rate=100");
  EXPECT_EQ(described.model, "mat/array.toml");
  EXPECT_FALSE(described.is_new);
}

TEST_F(ArraySetupTest, goes_back_to_the_choice_of_a_source) {
  const auto setup = ArraySetup::create("", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  client.call("/source/open", R"({"simulation":"contacts"})");
  EXPECT_EQ(client.call("/source/leave", "{}"), "{}");
  EXPECT_EQ(client.call("/source/look", "{}"), "choose where the array is first");
}

TEST_F(ArraySetupTest, writes_nothing_of_an_array_whose_source_sends_no_frame) {
  std::ofstream file("bytes");
  for (int line = 0; line < 20; ++line) file << "1,2,3,4,5,6\n";
  file.close();
  const auto setup = ArraySetup::create("file:bytes", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  const std::string answer =
      client.call("/array/describe", R"({"name":"mat","rows":5,"cols":4,"pitch_um":8000,"adc_bits":10})");
  EXPECT_NE(answer.find("check rows and cols"), std::string::npos) << answer;
  EXPECT_FALSE(std::filesystem::exists("mat"));
}

TEST_F(ArraySetupTest, offers_no_ports_where_the_device_was_named_or_others_reach_the_server) {
  const auto setup = ArraySetup::create("sim:idle?rate=100", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  SessionOptions open = any_port();
  open.server.host = "0.0.0.0";
  open.server.token = "a-long-token";
  const auto refused = ArraySetup::create("", open, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.substr(0, 5), "host:");
}

/// A pseudo-terminal with the name of a serial port, and a board behind it that prints frames of 2x3.
class Board {
 public:
  Board() : terminal_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    ::fcntl(terminal_, F_SETFL, O_NONBLOCK);  // what nobody reads is lost
    ::grantpt(terminal_);
    ::unlockpt(terminal_);
    std::error_code error;
    std::filesystem::create_symlink(::ptsname(terminal_), name_, error);
    is_there_ = !error;
    printing_ = std::thread([this] {
      const std::string frame = "11,12,13\r\n21,22,23\r\n\r\n";
      while (!stop_) {
        static_cast<void>(!::write(terminal_, frame.data(), frame.size()));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
  }
  ~Board() {
    stop_ = true;
    printing_.join();
    std::error_code ignored;
    std::filesystem::remove(name_, ignored);
    ::close(terminal_);
  }
  [[nodiscard]] bool is_there() const { return is_there_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  const std::string name_ = "/dev/ttyACM_of_test_" + std::to_string(::getpid());
  const int terminal_;
  std::atomic<bool> stop_ = false;
  bool is_there_ = false;
  std::thread printing_;
};

TEST_F(ArraySetupTest, listens_to_the_port_that_a_client_chooses) {
  const Board board;
  if (!board.is_there()) GTEST_SKIP() << "only root can name a port in /dev";
  const auto setup = ArraySetup::create("", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  StreamClient client((*setup)->port());
  EXPECT_NE(client.call("/source/list", "{}").find(board.name()), std::string::npos);
  EXPECT_EQ(client.call("/source/open", R"({"port":")" + board.name() + R"(","baud":115200})"),
            R"({"from":"serial://)" + board.name() + R"(?baud=115200"})");
  std::atomic<bool> stop = false;
  DescribedArray described;
  std::thread work([&] { described = (*setup)->run(stop); });
  client.call("/array/describe", R"({"name":"board","rows":2,"cols":3,"pitch_um":8000,"adc_bits":10})");
  stop = HasFailure();  // nobody is served then
  work.join();
  EXPECT_EQ(described.from, "serial://" + board.name() + "?baud=115200");
}

}  // namespace
}  // namespace dermis::out::serve
