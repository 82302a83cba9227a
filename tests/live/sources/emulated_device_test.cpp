// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/emulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <thread>

#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/live/sources/pacer.hpp"
#include "support/random_frames.hpp"

namespace dermis::live::sources {
namespace {

using bytes::devices::ByteStream;
using bytes::devices::Transport;
using std::chrono::milliseconds;

constexpr FrameShape kShape{2, 3};

/// A source of frames 10 ms apart, whose taxels read the number of the frame.
class NumberedFrames final : public FrameSource {
 public:
  explicit NumberedFrames(std::size_t count, Nanos period = milliseconds(10)) : count_(count), period_(period) {}

  Result<bool> next(RawFrame& frame) override {
    if (number_ == count_) return false;
    frame.time = static_cast<std::int64_t>(number_) * period_;
    frame.counts.assign(kShape.taxel_count(), static_cast<float>(number_++));
    return true;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return kShape; }

 private:
  std::size_t count_;
  Nanos period_;
  std::size_t number_ = 0;
};

/// What happens at the other side of a device.
struct Reader {
  std::vector<std::uint8_t> received;
  std::string asks;                     ///< What it sends to the device at once.
  std::size_t opened = 0;               ///< How often somebody has come to read.
  std::size_t leaves_after = SIZE_MAX;  ///< Bytes, once.
  bool never_comes = false;
};

class ReaderStream final : public ByteStream {
 public:
  explicit ReaderStream(Reader& reader) : reader_(reader) {}

  Result<bool> open(Nanos /*timeout*/) override {
    if (reader_.never_comes) std::this_thread::sleep_for(milliseconds(1));
    reader_.opened += reader_.never_comes ? 0 : 1;
    return !reader_.never_comes;
  }
  Transferred read(std::span<std::uint8_t> into, Nanos /*timeout*/) override {
    const std::size_t bytes = std::min(into.size(), reader_.asks.size());
    std::copy_n(reader_.asks.begin(), bytes, into.begin());
    reader_.asks.erase(0, bytes);
    return {bytes, End::none};
  }
  Transferred write(std::span<const std::uint8_t> bytes, Nanos /*timeout*/) override {
    if (reader_.received.size() + bytes.size() > reader_.leaves_after) {
      reader_.leaves_after = SIZE_MAX;
      return {0, End::closed};
    }
    reader_.received.insert(reader_.received.end(), bytes.begin(), bytes.end());
    return {bytes.size(), End::none};
  }
  [[nodiscard]] std::string name() const override { return "reader"; }

 private:
  Reader& reader_;
};

std::unique_ptr<bytes::devices::Encoder> encoder_of(const std::string& protocol) {
  return *bytes::devices::make_encoder({.name = protocol, .shape = kShape});
}

EmulatedDevice device_for(Reader& reader, Transport transport, const std::atomic<bool>& stop) {
  return {std::make_unique<ReaderStream>(reader), transport, encoder_of("dermis"), stop};
}

/// The bytes of the frames from number `first` on.
std::vector<std::uint8_t> encoded(std::size_t first, std::size_t count) {
  NumberedFrames source(first + count);
  const auto encoder = encoder_of("dermis");
  std::vector<std::uint8_t> bytes;
  const Result<std::vector<RawFrame>> frames = support::read_all(source);
  for (const RawFrame& frame : *frames) encoder->encode(frame, bytes);
  const std::size_t frame_bytes = bytes.size() / (first + count);
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(first * frame_bytes));
  return bytes;
}

TEST(EmulatedDevice, sends_the_frames_of_a_source_as_its_protocol_encodes_them) {
  Reader reader;
  const std::atomic<bool> stop = false;
  EmulatedDevice device = device_for(reader, Transport::tcp_listen, stop);
  NumberedFrames source(5);
  ASSERT_TRUE(device.wait_for_reader());
  ASSERT_TRUE(device.play(source, 1e6));
  ASSERT_TRUE(device.finish());
  EXPECT_EQ(reader.received, encoded(0, 5));
  EXPECT_FALSE(device.stopped());
}

TEST(EmulatedDevice, takes_the_time_of_the_frames_or_that_of_the_rate) {
  Reader reader;
  const std::atomic<bool> stop = false;
  EmulatedDevice device = device_for(reader, Transport::tcp_listen, stop);
  const auto time_of = [&](Nanos period, std::optional<double> rate_hz) {
    NumberedFrames source(4, period);
    const Pacer pacer(nullptr);
    EXPECT_TRUE(device.play(source, rate_hz));
    return pacer.elapsed();
  };
  EXPECT_GE(time_of(milliseconds(10), {}), milliseconds(30));
  EXPECT_GE(time_of(milliseconds(0), 100.0), milliseconds(30));
}

TEST(EmulatedDevice, goes_on_with_the_next_reader_where_it_listens) {
  Reader reader;
  reader.leaves_after = encoded(0, 2).size();
  const std::atomic<bool> stop = false;
  EmulatedDevice device = device_for(reader, Transport::tcp_listen, stop);
  NumberedFrames source(5);
  ASSERT_TRUE(device.wait_for_reader());
  ASSERT_TRUE(device.play(source, 1e6));
  EXPECT_FALSE(device.stopped());
  EXPECT_EQ(reader.opened, 2U);
  std::vector<std::uint8_t> bytes = encoded(0, 2);
  const std::vector<std::uint8_t> rest = encoded(3, 2);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  EXPECT_EQ(reader.received, bytes);
}

TEST(EmulatedDevice, ends_with_the_reader_that_it_has_connected_to) {
  Reader reader;
  reader.leaves_after = encoded(0, 2).size();
  const std::atomic<bool> stop = false;
  EmulatedDevice device = device_for(reader, Transport::tcp, stop);
  NumberedFrames source(5);
  ASSERT_TRUE(device.play(source, 1e6));
  EXPECT_TRUE(device.stopped());
  EXPECT_EQ(reader.received, encoded(0, 2));
}

TEST(EmulatedDevice, sends_a_frame_for_each_request_where_its_protocol_wants_them) {
  Reader reader;
  const std::string request(encoder_of("stag")->request());
  ASSERT_NE(request, "");
  reader.asks = "noise" + request + request + request;
  const std::atomic<bool> stop = false;
  EmulatedDevice device(std::make_unique<ReaderStream>(reader), Transport::serial, encoder_of("stag"), stop);
  NumberedFrames source(3, milliseconds(0));
  ASSERT_TRUE(device.play(source));
  EXPECT_EQ(reader.asks, "");
  EXPECT_EQ(std::count(reader.received.begin(), reader.received.end(), '\n'), 3);
}

TEST(EmulatedDevice, stops_where_nobody_comes_to_read) {
  Reader reader;
  reader.never_comes = true;
  std::atomic<bool> stop = false;
  EmulatedDevice device = device_for(reader, Transport::tcp_listen, stop);
  std::thread stopper([&] { stop = true; });
  EXPECT_TRUE(device.wait_for_reader());
  stopper.join();
  EXPECT_TRUE(device.stopped());
}

}  // namespace
}  // namespace dermis::live::sources
