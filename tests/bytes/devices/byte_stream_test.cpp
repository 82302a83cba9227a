// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/byte_stream.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netdb.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "bytes/devices/streams.hpp"

namespace {
std::atomic<int> names_looked_up = 0;
}

/// Counts, before the one of the system does its work.
extern "C" int getaddrinfo(const char* name, const char* service, const addrinfo* hints, addrinfo** found) {
  ++names_looked_up;
  static const auto kOfSystem = reinterpret_cast<decltype(&getaddrinfo)>(::dlsym(RTLD_NEXT, "getaddrinfo"));
  return kOfSystem(name, service, hints, found);
}

namespace dermis::bytes::devices {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

std::unique_ptr<ByteStream> source(const std::string& uri) {
  const Result<SourceUri> parsed = parse_source_uri(uri);
  EXPECT_TRUE(parsed) << uri;
  return *make_source_stream(*parsed);
}

std::string failure(ByteStream& stream) {
  const Result<bool> opened = stream.open(100ms);
  return opened ? "opened" : opened.error().message;
}

std::vector<std::uint8_t> receive(ByteStream& stream, std::size_t count) {
  std::vector<std::uint8_t> received;
  std::vector<std::uint8_t> buffer(4096);
  while (received.size() < count) {
    const ByteStream::Transferred read = stream.read(buffer, kLong);
    received.insert(received.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(read.bytes));
    if (read.bytes == 0) break;
  }
  return received;
}

/// All byte values, the control characters that a terminal would act on among them.
std::vector<std::uint8_t> all_bytes(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
  return bytes;
}

TEST(SerialStream, passes_every_byte_both_ways_at_any_baud) {
  for (const char* baud : {"9600", "250000", "1000000", "2000000", "3141592"}) {
    SCOPED_TRACE(baud);
    const auto device = target("pty:");
    EXPECT_FALSE(*device->open(0ms)) << "nobody reads yet";
    const auto host = source("serial://" + device->name() + "?baud=" + baud);
    ASSERT_TRUE(*host->open(kLong));
    ASSERT_TRUE(*device->open(kLong));
    const std::vector<std::uint8_t> bytes = all_bytes(50'000);
    std::thread sender([&] { send(*device, bytes); });
    EXPECT_EQ(receive(*host, bytes.size()), bytes);
    sender.join();
    send(*host, all_bytes(300));
    EXPECT_EQ(receive(*device, 300), all_bytes(300));
  }
}

TEST(SerialStream, an_unplugged_device_is_lost_and_can_be_opened_again) {
  std::vector<std::uint8_t> buffer(16);
  const std::string link = testing::TempDir() + "dermis_tty_" + std::to_string(::getpid());
  auto device = target("pty:");
  ASSERT_EQ(::symlink(device->name().c_str(), link.c_str()), 0);
  const auto host = source("serial://" + link);
  ASSERT_TRUE(*host->open(kLong));
  device.reset();
  EXPECT_EQ(host->read(buffer, kLong).end, ByteStream::End::lost);
  expect_words(failure(*host), {link});

  device = target("pty:");
  ::unlink(link.c_str());
  ASSERT_EQ(::symlink(device->name().c_str(), link.c_str()), 0);
  ASSERT_TRUE(*host->open(kLong));
  send(*device, {1, 2, 3});
  EXPECT_EQ(receive(*host, 3), (std::vector<std::uint8_t>{1, 2, 3}));
  ::unlink(link.c_str());
}

TEST(SerialStream, a_device_is_for_one_program) {
  const auto device = target("pty:");
  const auto first = source("serial://" + device->name());
  ASSERT_TRUE(*first->open(kLong));
  expect_words(failure(*source("serial://" + device->name())), {device->name(), "in use by another program", "fuser"});
}

TEST(SerialStream, says_what_is_wrong) {
  expect_words(failure(*source("serial:///dev/no_such_tty")), {"/dev/no_such_tty", "not there"});
  expect_words(failure(*source("serial:///dev/null")), {"/dev/null", "no serial device", "file:/dev/null"});
}

TEST(SerialStream, nothing_to_read_takes_its_time_and_no_more) {
  const auto device = target("pty:");
  const auto host = source("serial://" + device->name());
  ASSERT_TRUE(*host->open(kLong));
  std::vector<std::uint8_t> buffer(16);
  const ByteStream::Transferred read = host->read(buffer, 1ms);
  EXPECT_EQ(read.bytes, 0U);
  EXPECT_EQ(read.end, ByteStream::End::none);
}

TEST(PseudoTerminal, tells_when_its_reader_leaves) {
  const auto device = target("pty:");
  auto host = source("serial://" + device->name());
  ASSERT_TRUE(*host->open(kLong));
  ASSERT_TRUE(*device->open(kLong));
  host.reset();
  EXPECT_EQ(device->write(all_bytes(3), kLong).end, ByteStream::End::closed);
  EXPECT_FALSE(*device->open(0ms));
}

TEST(TcpStream, a_listener_and_a_client_meet_both_ways_round) {
  for (const char* host : {"127.0.0.1", "[::1]"}) {
    const auto listener = source(std::string("tcp-listen://") + host + ":0");
    const Result<bool> listening = listener->open(0ms);
    if (!listening && std::string(host) == "[::1]") GTEST_SKIP() << "no IPv6 here";
    ASSERT_TRUE(listening);
    EXPECT_FALSE(*listening) << "nobody has connected";
    auto client = target("tcp://" + listener->name());
    ASSERT_TRUE(*client->open(kLong));
    ASSERT_TRUE(*listener->open(kLong));
    const std::vector<std::uint8_t> bytes = all_bytes(300'000);
    std::thread sender([&] { send(*client, bytes); });
    EXPECT_EQ(receive(*listener, bytes.size()), bytes);
    sender.join();
    send(*listener, all_bytes(300));
    EXPECT_EQ(receive(*client, 300), all_bytes(300));

    std::vector<std::uint8_t> buffer(16);
    client.reset();
    EXPECT_EQ(listener->read(buffer, kLong).end, ByteStream::End::closed);
    client = target("tcp://" + listener->name());
    ASSERT_TRUE(*client->open(kLong));
    ASSERT_TRUE(*listener->open(kLong)) << "the next device";
  }
}

TEST(TcpStream, says_what_is_wrong) {
  const auto listener = source("tcp-listen://127.0.0.1:0");
  ASSERT_TRUE(listener->open(0ms));
  const std::string place = listener->name();
  expect_words(failure(*source("tcp-listen://" + place)), {place, "in use by another program", "another port"});
  const auto gone = [] {
    const auto other = source("tcp-listen://127.0.0.1:0");
    EXPECT_TRUE(other->open(0ms));
    return other->name();
  }();
  expect_words(failure(*source("tcp://" + gone)), {gone, "nothing listens"});
  expect_words(failure(*source("tcp-listen://203.0.113.7:7000")), {"203.0.113.7", "0.0.0.0"});
}

TEST(TcpStream, looks_its_peer_up_once) {
  const auto listener = source("tcp-listen://127.0.0.1:0");
  ASSERT_TRUE(listener->open(0ms));
  const std::string name = listener->name();
  const auto client = source("tcp://localhost" + name.substr(name.rfind(':')));
  names_looked_up = 0;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto opened = client->open(kLong);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(*opened);
  }
  EXPECT_EQ(names_looked_up, 1);
}

TEST(UdpStream, passes_datagrams_and_answers) {
  const auto host = source("udp://127.0.0.1:0");
  ASSERT_TRUE(*host->open(0ms));
  const auto device = target("udp://" + host->name());
  ASSERT_TRUE(*device->open(0ms));
  const std::vector<std::uint8_t> bytes = all_bytes(10'000);
  send(*device, bytes);
  EXPECT_EQ(receive(*host, bytes.size()), bytes);
  send(*host, {4, 5});
  EXPECT_EQ(receive(*device, 2), (std::vector<std::uint8_t>{4, 5}));
  expect_words(failure(*source("udp://" + host->name())), {"in use by another program"});
}

TEST(FileStream, waits_for_the_writer_of_a_pipe_as_long_as_it_is_given) {
  const std::string path = testing::TempDir() + "dermis_pipe_" + std::to_string(::getpid());
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const auto pipe = source("file:" + path);
  ASSERT_TRUE(*pipe->open(0ms));
  std::vector<std::uint8_t> buffer(10);
  const ByteStream::Transferred silence = pipe->read(buffer, 1ms);
  EXPECT_EQ(silence.bytes, 0U);
  EXPECT_EQ(silence.end, ByteStream::End::none);
  std::ofstream(path) << "abc";
  EXPECT_EQ(receive(*pipe, 3), (std::vector<std::uint8_t>{'a', 'b', 'c'}));
  EXPECT_EQ(pipe->read(buffer, kLong).end, ByteStream::End::closed);
  ::unlink(path.c_str());
}

TEST(FileStream, reads_to_the_end) {
  const std::string path = testing::TempDir() + "dermis_bytes_" + std::to_string(::getpid());
  std::ofstream(path, std::ios::binary) << "device";
  const auto file = source("file:" + path);
  ASSERT_TRUE(*file->open(0ms));
  EXPECT_EQ(receive(*file, 100), (std::vector<std::uint8_t>{'d', 'e', 'v', 'i', 'c', 'e'}));
  std::vector<std::uint8_t> buffer(16);
  EXPECT_EQ(file->read(buffer, 0ms).end, ByteStream::End::closed);
  ::unlink(path.c_str());
  expect_words(failure(*source("file:" + path)), {path, "No such file"});
  expect_words(failure(*source("file:/tmp")), {"/tmp", "folder"});
}

}  // namespace
}  // namespace dermis::bytes::devices
