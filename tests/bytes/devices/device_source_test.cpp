// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/device_source.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <mutex>
#include <thread>
#include <vector>

#include "bytes/devices/streams.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::bytes::devices {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr FrameShape kShape{16, 16};

std::vector<RawFrame> random_frames(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<RawFrame> frames(count);
  for (RawFrame& frame : frames) {
    for (std::size_t taxel = 0; taxel < kShape.taxel_count(); ++taxel) {
      frame.counts.push_back(static_cast<float>(random.below(4096)));
    }
  }
  return frames;
}

std::vector<std::uint8_t> encoded(const std::vector<RawFrame>& frames, const std::string& protocol = "dermis") {
  const auto encoder = *make_encoder({.name = protocol, .shape = kShape});
  std::vector<std::uint8_t> bytes;
  for (const RawFrame& frame : frames) encoder->encode(frame, bytes);
  return bytes;
}

std::unique_ptr<FrameSource> open(const std::string& uri, const DeviceOptions& options = {}) {
  Result<std::unique_ptr<FrameSource>> source = open_device(uri, options);
  EXPECT_TRUE(source) << (source ? "" : source.error().message);
  return source ? std::move(*source) : nullptr;
}

std::string refusal(const std::string& uri, const DeviceOptions& options = {}) {
  const Result<std::unique_ptr<FrameSource>> source = open_device(uri, options);
  return source ? "opened" : source.error().message;
}

/// The next frames, which must be `expected`.
void expect_frames(FrameSource& source, const std::vector<RawFrame>& expected) {
  RawFrame frame;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Result<bool> more = source.next(frame);
    ASSERT_TRUE(more) << more.error().message;
    ASSERT_TRUE(*more) << i;
    ASSERT_EQ(frame.counts, expected[i].counts) << i;
  }
}

void expect_end(FrameSource& source) {
  RawFrame frame;
  const Result<bool> more = source.next(frame);
  ASSERT_TRUE(more) << more.error().message;
  EXPECT_FALSE(*more);
}

/// The next frames, as one gets them who waits for several sources; next() where that cannot be.
void expect_polled_frames(FrameSource& source, const std::vector<RawFrame>& expected) {
  RawFrame frame;
  for (std::size_t i = 0; i < expected.size();) {
    const std::optional<Readiness> readiness = source.readiness();
    if (!readiness) {
      expect_frames(source, {expected[i++]});
      continue;
    }
    EXPECT_LE(readiness->due, Nanos(std::chrono::steady_clock::now().time_since_epoch()) + 50ms);
    pollfd request{readiness->descriptor, POLLIN, 0};
    ::poll(&request, 1, 50);
    for (;;) {
      const Result<Polled> polled = source.poll(frame);
      ASSERT_TRUE(polled) << polled.error().message;
      ASSERT_NE(*polled, Polled::end) << i;
      if (*polled == Polled::nothing) break;
      ASSERT_EQ(frame.counts, expected[i++].counts) << i;
    }
  }
}

std::string error_of(FrameSource& source) {
  RawFrame frame;
  for (;;) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error().message;
    if (!*more) return "the end";
  }
}

/// Notices of a source, for a test that looks from another thread.
struct Notices {
  DeviceOptions options(const std::atomic<bool>* stop = nullptr) {
    DeviceOptions options;
    options.stop = stop;
    options.notice = [this](const std::string& text) {
      const std::lock_guard lock(mutex);
      all += text + "\n";
    };
    return options;
  }
  std::string text() {
    const std::lock_guard lock(mutex);
    return all;
  }
  void wait_for(const std::string& word) {
    while (text().find(word) == std::string::npos) std::this_thread::sleep_for(1ms);
  }
  std::mutex mutex;
  std::string all;
};

class BytesInFile {
 public:
  explicit BytesInFile(const std::vector<std::uint8_t>& bytes)
      : path_(testing::TempDir() + "dermis_device_" + std::to_string(::getpid())) {
    std::ofstream file(path_, std::ios::binary);
    for (const std::uint8_t byte : bytes) file.put(static_cast<char>(byte));
  }
  BytesInFile(const BytesInFile&) = delete;
  BytesInFile& operator=(const BytesInFile&) = delete;
  ~BytesInFile() { ::unlink(path_.c_str()); }
  [[nodiscard]] std::string uri(const std::string& parameters) const { return "file:" + path_ + "?" + parameters; }

 private:
  std::string path_;
};

TEST(DeviceSource, gives_every_frame_of_a_serial_device) {
  const auto device = target("pty:");
  const auto source = open("serial://" + device->name() + "?protocol=dermis&baud=250000");
  const std::vector<RawFrame> frames = random_frames(300, 1);
  std::thread sender([&] { send(*device, encoded(frames)); });
  expect_frames(*source, frames);
  sender.join();
  EXPECT_EQ(source->statistics().frames, 300U);
  EXPECT_EQ(source->statistics().lost_frames, 0U);
  EXPECT_EQ(source->shape(), kShape);
}

TEST(DeviceSource, gives_the_last_frame_of_a_device_that_pauses) {
  const auto device = target("pty:");
  const auto source = open("serial://" + device->name() + "?protocol=flexitac&rows=16&cols=16");
  std::vector<RawFrame> frames = random_frames(12, 11);
  for (RawFrame& frame : frames) {
    for (float& count : frame.counts) count = static_cast<float>(static_cast<int>(count) % 170);
  }
  for (const std::size_t first : {0U, 4U, 5U, 6U}) {  // each but the first is sent when those before were received
    const std::size_t last = first == 0 ? 4 : first == 6 ? 12 : first + 1;
    const std::vector<RawFrame> burst(frames.begin() + static_cast<std::ptrdiff_t>(first),
                                      frames.begin() + static_cast<std::ptrdiff_t>(last));
    send(*device, encoded(burst, "flexitac"));
    expect_frames(*source, burst);
  }
}

/// What the device was sent so far, once there are so many bytes.
std::string sent_to(ByteStream& device, std::size_t size) {
  std::string sent;
  std::vector<std::uint8_t> piece(256);
  while (sent.size() < size) {
    const ByteStream::Transferred came = device.read(piece, 10ms);
    sent.append(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(came.bytes));
  }
  return sent;
}

TEST(DeviceSource, a_device_begins_when_it_is_sent_its_bytes) {
  const auto device = target("pty:");
  const auto source = open("serial://" + device->name() + "?rows=1&cols=4&packet=24,values u8,FF&start=%AA%01%80%FF");
  std::thread board([&] {
    ASSERT_TRUE(device->open(kLong));
    send(*device, {0x25, 0, 0, 0, 0, 0xFF});  // a greeting
    EXPECT_EQ(sent_to(*device, 4), "\xAA\x01\x80\xFF");
    for (std::uint8_t k = 0; k < 20; ++k) send(*device, {0x24, k, 1, 2, 3, 0xFF});
  });
  RawFrame frame;
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(*source->next(frame));
    EXPECT_EQ(frame.counts, (std::vector<float>{static_cast<float>(k), 1, 2, 3}));
  }
  board.join();
}

TEST(DeviceSource, a_rate_bounds_how_often_a_device_is_asked) {
  const std::string path = testing::TempDir() + "dermis_asked_" + std::to_string(::getpid()) + ".toml";
  std::ofstream(path) << "[layout]\nrows = 1\ncols = 2\nline = \"{values}\"\nrequest = [0xFE]\nrate = 100\n";
  const auto device = target("pty:");
  const auto source = open("serial://" + device->name() + "?layout=" + path);
  std::atomic<int> asked = 0;
  std::thread board([&] {
    ASSERT_TRUE(device->open(kLong));
    for (; asked < 21; ++asked) {
      EXPECT_EQ(sent_to(*device, 1), "\xFE") << "it is asked once";
      send(*device, {'1', ' ', '2', '\n'});
    }
  });
  RawFrame frame;
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < 21; ++k) ASSERT_TRUE(*source->next(frame));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 190ms) << "20 periods of 10 ms lie between 21 requests";
  board.join();
  ::unlink(path.c_str());
}

TEST(DeviceSource, says_which_protocol_it_has_detected) {
  const BytesInFile file(encoded(random_frames(30, 12)));
  Notices notices;
  const auto source = open(file.uri("protocol=auto"), notices.options());
  RawFrame frame;
  while (*source->next(frame)) {
  }
  EXPECT_EQ(notices.text(), "these bytes are dermis, 16x16\n");
}

TEST(DeviceSource, gives_what_it_has_received_before_it_stops) {
  const std::vector<RawFrame> frames = random_frames(20, 13);
  const BytesInFile file(encoded(frames));
  std::atomic<bool> stop = false;
  DeviceOptions options;
  options.stop = &stop;
  const auto source = open(file.uri("protocol=dermis"), options);
  expect_frames(*source, {frames[0]});  // they all came with the first
  stop = true;
  expect_frames(*source, {frames.begin() + 1, frames.end()});
  expect_end(*source);
}

TEST(DeviceSource, stamps_frames_with_their_arrival_and_lets_time_rise) {
  const auto device = target("pty:");
  const auto source = open("serial://" + device->name() + "?protocol=dermis");
  const std::vector<RawFrame> frames = random_frames(40, 2);
  const Nanos steady_before = std::chrono::steady_clock::now().time_since_epoch();
  const Nanos utc_before = std::chrono::system_clock::now().time_since_epoch();
  std::thread sender([&] {
    for (const RawFrame& frame : frames) send(*device, encoded({frame}));
  });
  RawFrame frame;
  Nanos last_time{};
  Nanos last_steady = steady_before;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_TRUE(*source->next(frame));
    EXPECT_GT(frame.time, last_time);
    EXPECT_GE(frame.acquisition.arrival_steady, last_steady);
    EXPECT_GE(frame.acquisition.arrival_utc, utc_before - 1s);
    EXPECT_LT(std::chrono::abs(frame.time - frame.acquisition.arrival_utc), 1s);
    last_time = frame.time;
    last_steady = frame.acquisition.arrival_steady;
  }
  sender.join();
  EXPECT_LE(last_steady, Nanos(std::chrono::steady_clock::now().time_since_epoch()));
}

TEST(DeviceSource, a_device_that_comes_back_is_read_on) {
  const std::string link = testing::TempDir() + "dermis_source_tty_" + std::to_string(::getpid());
  auto device = target("pty:");
  ASSERT_EQ(::symlink(device->name().c_str(), link.c_str()), 0);
  Notices notices;
  const auto source = open("serial://" + link + "?protocol=dermis", notices.options());
  const std::vector<RawFrame> frames = random_frames(6, 3);
  send(*device, encoded({frames[0], frames[1]}));
  std::vector<std::uint8_t> cut = encoded({frames[2]});
  cut.resize(cut.size() / 2);
  send(*device, cut);
  expect_frames(*source, {frames[0], frames[1]});
  std::thread hand([&] {
    std::vector<std::uint8_t> ignored(1);
    device.reset();
    notices.wait_for("unplugged");
    ::unlink(link.c_str());
    device = target("pty:");
    ASSERT_EQ(::symlink(device->name().c_str(), link.c_str()), 0);
    ASSERT_TRUE(*device->open(kLong));
    send(*device, encoded({frames[3], frames[4], frames[5]}));
  });
  expect_frames(*source, {frames[3], frames[4], frames[5]});
  hand.join();
  ::unlink(link.c_str());
  EXPECT_EQ(source->statistics().reconnections, 1U);
  expect_words(notices.text(), {"unplugged", "10 s", "is back"});
}

TEST(DeviceSource, a_device_that_does_not_come_back_is_an_error) {
  auto device = target("pty:");
  const std::string name = device->name();
  const auto source = open("serial://" + name + "?protocol=dermis&reconnect_s=0.2");
  device.reset();
  expect_words(error_of(*source), {name, "did not come back within 0.2 s", "cable"});
}

TEST(DeviceSource, a_peer_that_closes_ends_the_source) {
  const auto listener = target("tcp-listen://127.0.0.1:0");
  ASSERT_TRUE(listener->open(0ms));
  const std::vector<RawFrame> frames = random_frames(20, 4);
  const auto source = open("tcp://" + listener->name() + "?protocol=dermis&reconnect_s=0");
  ASSERT_TRUE(*listener->open(kLong));
  send(*listener, encoded(frames));
  ASSERT_FALSE(*listener->open(0ms)) << "closes the connection, waits for the next";
  expect_frames(*source, frames);
  expect_end(*source);
}

TEST(DeviceSource, a_peer_that_accepts_and_closes_at_once_is_one_line) {
  const auto listener = target("tcp-listen://127.0.0.1:0");
  ASSERT_TRUE(listener->open(0ms));
  const std::vector<RawFrame> frames = random_frames(4, 4);
  Notices notices;
  const auto source = open("tcp://" + listener->name() + "?protocol=dermis&reconnect_s=20", notices.options());
  std::thread peer([&] {
    ASSERT_TRUE(*listener->open(kLong));
    send(*listener, encoded({frames[0], frames[1]}));
    for (int connections = 0; connections < 5; ++connections) {  // each closes the last
      while (!*listener->open(kLong)) {
      }
    }
    send(*listener, encoded({frames[2], frames[3]}));
  });
  expect_frames(*source, {frames[0], frames[1], frames[2], frames[3]});
  peer.join();
  const std::string text = notices.text();
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 4) << text;  // two, but for a machine that stalls for a second
  expect_words(text, {"has closed", "is back"});
}

/// Host and port that were free a moment ago.
std::string free_place(const std::string& scheme) {
  const Result<std::unique_ptr<ByteStream>> probe = make_source_stream(*parse_source_uri(scheme + "://127.0.0.1:0"));
  EXPECT_TRUE((*probe)->open(0ms));
  return (*probe)->name();
}

TEST(DeviceSource, listens_for_its_device_and_for_the_next) {
  const std::string place = free_place("tcp-listen");
  Notices notices;
  const auto source = open("tcp-listen://" + place + "?protocol=dermis&reconnect_s=5", notices.options());
  const std::vector<RawFrame> frames = random_frames(6, 10);
  std::thread devices([&] {
    auto stray = target("tcp://" + place);  // a port scanner
    ASSERT_TRUE(*stray->open(kLong));
    stray.reset();
    for (const std::size_t first : {0U, 3U}) {
      const auto device = target("tcp://" + place);
      ASSERT_TRUE(*device->open(kLong));
      send(*device, encoded({frames[first], frames[first + 1], frames[first + 2]}));
    }
  });
  expect_frames(*source, frames);
  devices.join();
  EXPECT_EQ(source->statistics().reconnections, 1U);
}

TEST(DeviceSource, takes_datagrams) {
  const std::string place = free_place("udp");
  const auto source = open("udp://" + place + "?protocol=dermis");
  const auto device = target("udp://" + place);
  ASSERT_TRUE(*device->open(0ms));
  const std::vector<RawFrame> frames = random_frames(50, 5);
  send(*device, encoded(frames));
  expect_frames(*source, frames);
}

TEST(DeviceSource, can_be_waited_for_beside_others_and_polled) {
  const std::vector<RawFrame> frames = random_frames(300, 21);
  const auto terminal = target("pty:");
  const auto serial = open("serial://" + terminal->name() + "?protocol=dermis");
  const auto listener = target("tcp-listen://127.0.0.1:0");
  ASSERT_TRUE(listener->open(0ms));
  const auto tcp = open("tcp://" + listener->name() + "?protocol=dermis");
  ASSERT_TRUE(*listener->open(kLong));
  for (const auto& [device, source] : {std::pair(terminal.get(), serial.get()), std::pair(listener.get(), tcp.get())}) {
    ASSERT_TRUE(source->readiness());
    RawFrame frame;
    EXPECT_EQ(*source->poll(frame), Polled::nothing) << "does not wait";
    std::thread sender([&to = *device, &frames] { send(to, encoded(frames)); });
    expect_polled_frames(*source, frames);
    sender.join();
  }
}

TEST(DeviceSource, a_polled_device_that_comes_back_is_read_on) {
  const auto listener = target("tcp-listen://127.0.0.1:0");
  ASSERT_TRUE(listener->open(0ms));
  const std::vector<RawFrame> frames = random_frames(4, 22);
  const auto source = open("tcp://" + listener->name() + "?protocol=dermis&reconnect_s=20");
  std::thread peer([&] {
    ASSERT_TRUE(*listener->open(kLong));
    send(*listener, encoded({frames[0], frames[1]}));
    while (!*listener->open(kLong)) {
    }
    send(*listener, encoded({frames[2], frames[3]}));
  });
  expect_polled_frames(*source, frames);
  peer.join();
  EXPECT_EQ(source->statistics().reconnections, 1U);
}

TEST(DeviceSource, a_device_that_is_away_comes_back_by_polls_alone) {
  const std::string link = testing::TempDir() + "dermis_polled_tty_" + std::to_string(::getpid());
  auto device = target("pty:");
  ASSERT_EQ(::symlink(device->name().c_str(), link.c_str()), 0);
  const auto source = open("serial://" + link + "?protocol=dermis&reconnect_s=20");
  const std::vector<RawFrame> frames = random_frames(2, 23);
  const auto polls_until = [&](auto done) {
    RawFrame frame;
    for (const auto end = std::chrono::steady_clock::now() + 60s; std::chrono::steady_clock::now() < end;) {
      const Result<Polled> polled = source->poll(frame);
      ASSERT_TRUE(polled) << polled.error().message;
      if (done(*polled, frame)) return;
    }
    ADD_FAILURE() << "60 s are over";
  };
  const auto is_frame = [&](std::size_t k) {
    return [&, k](Polled polled, const RawFrame& frame) {
      return polled == Polled::frame && frame.counts == frames[k].counts;
    };
  };
  send(*device, encoded({frames[0]}));
  polls_until(is_frame(0));
  device.reset();
  polls_until([&](Polled, const RawFrame&) { return !source->readiness(); });
  ::unlink(link.c_str());
  device = target("pty:");
  ASSERT_EQ(::symlink(device->name().c_str(), link.c_str()), 0);
  std::thread hand([&] {
    ASSERT_TRUE(*device->open(kLong));
    send(*device, encoded({frames[1]}));
  });
  polls_until(is_frame(1));
  hand.join();
  ::unlink(link.c_str());
  EXPECT_EQ(source->statistics().reconnections, 1U);
}

TEST(DeviceSource, a_device_that_is_away_for_too_long_is_an_error_of_a_poll) {
  auto device = target("pty:");
  const auto source = open("serial://" + device->name() + "?protocol=dermis&reconnect_s=0.2");
  device.reset();
  RawFrame frame;
  Result<Polled> polled = Polled::nothing;
  while (polled && *polled == Polled::nothing) polled = source->poll(frame);
  ASSERT_FALSE(polled);
  expect_words(polled.error().message, {"did not come back within 0.2 s"});
}

TEST(DeviceSource, a_polled_source_ends_by_the_flag) {
  const auto device = target("pty:");
  std::atomic<bool> stop = false;
  DeviceOptions options;
  options.stop = &stop;
  const auto source = open("serial://" + device->name() + "?protocol=dermis", options);
  RawFrame frame;
  EXPECT_EQ(*source->poll(frame), Polled::nothing);
  stop = true;
  EXPECT_EQ(*source->poll(frame), Polled::end);
}

TEST(DeviceSource, reads_files_to_their_end) {
  const std::vector<RawFrame> frames = random_frames(30, 6);
  const BytesInFile file(encoded(frames));
  const auto source = open(file.uri("protocol=dermis"));
  expect_frames(*source, frames);
  expect_end(*source);
}

TEST(DeviceSource, a_damaged_part_of_a_file_is_passed_over_at_any_pace) {
  const std::vector<RawFrame> frames = random_frames(2, 9);
  std::vector<std::uint8_t> bytes = encoded({frames[0]});
  bytes.resize(140'000);
  const std::vector<std::uint8_t> behind = encoded({frames[1]});
  bytes.insert(bytes.end(), behind.begin(), behind.end());
  const BytesInFile file(bytes);
  DeviceOptions options;
  options.received = [](std::span<const std::uint8_t> chunk) {
    if (chunk.front() == 0 && chunk.back() == 0) std::this_thread::sleep_for(5100ms);  // the one in the middle
  };
  const auto source = open(file.uri("protocol=dermis"), options);
  expect_frames(*source, frames);
  expect_end(*source);
}

TEST(DeviceSource, stops_by_the_flag) {
  const auto device = target("pty:");
  std::atomic<bool> stop = false;
  DeviceOptions options;
  options.stop = &stop;
  const auto source = open("serial://" + device->name() + "?protocol=dermis", options);
  std::thread user([&] {
    std::this_thread::sleep_for(20ms);
    stop = true;
  });
  expect_end(*source);
  user.join();
}

TEST(DeviceSource, tells_when_nothing_comes) {
  const auto device = target("pty:");
  std::atomic<bool> stop = false;
  Notices notices;
  const auto source = open("serial://" + device->name() + "?protocol=dermis&baud=9600", notices.options(&stop));
  std::thread user([&] {
    notices.wait_for("no bytes");
    stop = true;
  });
  expect_end(*source);
  user.join();
  expect_words(notices.text(), {device->name(), "powered", "baud=9600"});
}

TEST(DeviceSource, names_the_protocol_that_bytes_look_like) {
  const BytesInFile file(encoded(random_frames(30, 7)));
  expect_words(error_of(*open(file.uri("protocol=pressure-mat"))), {"not pressure-mat", "protocol=dermis"});
}

TEST(DeviceSource, says_that_bytes_are_nothing_it_knows) {
  std::vector<std::uint8_t> noise(5000);
  Random random(8);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random.below(256));
  expect_words(error_of(*open(BytesInFile(noise).uri("protocol=dermis"))), {"not dermis", "check protocol="});
  expect_words(error_of(*open(BytesInFile({}).uri("protocol=dermis"))), {"not a single byte"});
}

TEST(DeviceSource, refuses_shapes_that_disagree) {
  DeviceOptions options;
  options.shape = FrameShape{4, 5};
  expect_words(refusal("serial:///dev/null?protocol=csv&rows=4&cols=6", options), {"4x6", "4x5"});
  expect_words(refusal("serial:///dev/null?protocol=morse"), {"morse"});
}

/// A layout in a file: two arrays in turn, each of two readings behind its letter.
class LayoutFile {
 public:
  LayoutFile() : path_(testing::TempDir() + "dermis_layout_" + std::to_string(::getpid()) + ".toml") {
    std::ofstream(path_) << "[layout]\nline = [\"L {left}\", \"R {right}\"]\n"
                            "[[layout.array]]\nname = \"left\"\nrows = 1\ncols = 2\n"
                            "[[layout.array]]\nname = \"right\"\nrows = 1\ncols = 2\n";
  }
  LayoutFile(const LayoutFile&) = delete;
  LayoutFile& operator=(const LayoutFile&) = delete;
  ~LayoutFile() { ::unlink(path_.c_str()); }
  [[nodiscard]] std::string array(const std::string& name) const { return "layout=" + path_ + "&array=" + name; }

 private:
  std::string path_;
};

TEST(DeviceSource, several_arrays_of_one_device_share_its_connection) {
  const LayoutFile layout;
  const auto device = target("pty:");
  const auto left = open("serial://" + device->name() + "?" + layout.array("left"));
  const auto right = open("serial://" + device->name() + "?" + layout.array("right"));
  std::string text;
  for (int k = 0; k < 200; ++k) {
    text += "L " + std::to_string(k) + " 1\nR " + std::to_string(k) + " 2\n";
  }
  std::thread sender([&] { send(*device, {text.begin(), text.end()}); });
  const auto expect_all = [](FrameSource& source, float last) {
    for (int k = 0; k < 200; ++k) {
      RawFrame frame;
      const Result<bool> more = source.next(frame);
      ASSERT_TRUE(more) << more.error().message;
      ASSERT_EQ(frame.counts, (std::vector<float>{static_cast<float>(k), last}));
    }
  };
  std::thread reader([&] { expect_all(*left, 1); });
  expect_all(*right, 2);
  reader.join();
  sender.join();
}

TEST(DeviceSource, allocates_nothing_once_it_runs) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  const std::vector<RawFrame> frames = random_frames(600, 9);
  const BytesInFile file(encoded(frames));
  const auto source = open(file.uri("protocol=dermis"));
  RawFrame frame;
  for (int warm = 0; warm < 300; ++warm) ASSERT_TRUE(*source->next(frame));
  const support::AllocationGuard guard;
  for (int round = 0; round < 200; ++round) ASSERT_TRUE(*source->next(frame));
  EXPECT_EQ(guard.count(), 0U);
}

std::string why(const std::string& bytes) {
  const SourceUri uri = parse_source_uri("tcp://127.0.0.1:1").value();
  return why_undecoded(uri, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}).why;
}

TEST(WhyUndecoded, names_what_a_person_would_see_in_the_bytes) {
  EXPECT_EQ(why(std::string(40, '\0')),
            "'tcp://127.0.0.1:1': these bytes are of no known protocol: check protocol=. Each of them is 0x00");
  expect_words(why("\x01\x92\xfe\x80\x03\x11"), {"They are not text"});
  expect_words(why("no end of a line"), {"no line of it ends"});
}

TEST(WhyUndecoded, shows_a_whole_line_that_is_not_numbers_alone) {
  expect_words(why("cut\r\ntemp=21.5 C\r\ntemp=21.6 C\r\n"), {"not numbers alone, such as 'temp=21.5 C'"});
}

TEST(WhyUndecoded, counts_the_numbers_of_lines) {
  expect_words(why("7\n512\n513\n511\n"), {"Each line has one number: print a row or a frame in a line"});
  expect_words(why("7\n1,2,3\n1,2\n1 2 3 4\n"), {"Their lines have 2 to 4 numbers: print as many in each"});
}

TEST(WhyUndecoded, suggests_the_size_that_is_nearest_to_a_square) {
  std::string lines;
  for (int line = 0; line < 12; ++line) {
    for (int reading = 0; reading < 120; ++reading) lines += std::to_string(100 + (5 * line + 7 * reading) % 23) + ",";
    lines.back() = '\n';
  }
  const SourceUri uri = parse_source_uri("tcp://127.0.0.1:1").value();
  const UndecodedReason reason =
      why_undecoded(uri, {reinterpret_cast<const std::uint8_t*>(lines.data()), lines.size()});
  expect_words(reason.why, {"120 readings", "rows=12&cols=10"});
  EXPECT_EQ(reason.likely_shape, (FrameShape{12, 10}));
}

TEST(DeviceSource, gives_all_bytes_as_they_come) {
  const std::vector<std::uint8_t> sent(700, 'x');
  std::size_t received = 0;
  DeviceOptions options;
  options.received = [&](std::span<const std::uint8_t> bytes) { received += bytes.size(); };
  auto source = open_device(BytesInFile(sent).uri("protocol=dermis"), options);
  ASSERT_TRUE(source) << source.error().message;
  RawFrame frame;
  EXPECT_FALSE((*source)->next(frame));
  EXPECT_EQ(received, sent.size());
}

}  // namespace
}  // namespace dermis::bytes::devices
