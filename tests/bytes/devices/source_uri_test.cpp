// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/source_uri.hpp"

#include <gtest/gtest.h>

#include "bytes/devices/streams.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::devices {
namespace {

SourceUri parsed(const std::string& text) {
  const Result<SourceUri> uri = parse_source_uri(text);
  EXPECT_TRUE(uri) << text << ": " << (uri ? "" : uri.error().message);
  return uri ? *uri : SourceUri{};
}

std::string message(const std::string& text) {
  const Result<SourceUri> uri = parse_source_uri(text);
  if (uri) return "accepted";
  EXPECT_EQ(uri.error().kind, ErrorKind::bad_input);
  return uri.error().message;
}

TEST(SourceUri, takes_a_serial_device_apart) {
  const SourceUri uri = parsed("serial:///dev/ttyACM0?baud=2000000&protocol=flexitac&rows=12&cols=32");
  EXPECT_EQ(uri.transport, Transport::serial);
  EXPECT_EQ(uri.path, "/dev/ttyACM0");
  EXPECT_EQ(uri.baud, 2'000'000U);
  EXPECT_EQ(uri.protocol.name, "flexitac");
  EXPECT_EQ(uri.protocol.shape, (FrameShape{12, 32}));
  EXPECT_TRUE(uri.protocol.delimited);
  EXPECT_EQ(uri.reconnect, std::chrono::seconds(10));
}

TEST(SourceUri, a_baud_that_is_not_given_is_the_usual_one) {
  EXPECT_EQ(parsed("serial:///dev/ttyUSB0?protocol=wiresens").baud, 250'000U);
  EXPECT_EQ(parsed("serial:///dev/ttyUSB0?protocol=flexitac").baud, 2'000'000U);
  EXPECT_EQ(parsed("serial:///dev/ttyUSB0").baud, 115'200U);
  EXPECT_EQ(parsed("serial:///dev/ttyUSB0").protocol.name, "auto");
}

TEST(SourceUri, takes_the_network_apart) {
  const SourceUri tcp =
      parsed("tcp://glove.local:7000?protocol=wiresens&rows=32&cols=16&nodes_per_packet=60&reconnect_s=2.5");
  EXPECT_EQ(tcp.transport, Transport::tcp);
  EXPECT_EQ(tcp.host, "glove.local");
  EXPECT_EQ(tcp.port, 7000);
  EXPECT_EQ(tcp.protocol.nodes_per_packet, 60U);
  EXPECT_FALSE(tcp.protocol.delimited) << "packets of a network are bare";
  EXPECT_EQ(tcp.reconnect, std::chrono::milliseconds(2500));
  EXPECT_EQ(parsed("tcp-listen://127.0.0.1:0").port, 0);
  EXPECT_EQ(parsed("udp://[::1]:9000").host, "::1");
  EXPECT_TRUE(parsed("udp://[::1]:9000").protocol.datagrams);
  EXPECT_FALSE(tcp.protocol.datagrams);
  EXPECT_TRUE(parsed("udp://[::1]:9000?delimited=true").protocol.delimited);
}

TEST(SourceUri, takes_files_and_streams_apart) {
  EXPECT_EQ(parsed("file:/tmp/a.bin?protocol=csv").path, "/tmp/a.bin");
  EXPECT_EQ(parsed("file:///tmp/a.bin").path, "/tmp/a.bin");
  EXPECT_EQ(parsed("file:raw.bin").path, "raw.bin");
  EXPECT_EQ(parsed("file:raw.bin?rate=31.5").rate_hz, 31.5);
  EXPECT_FALSE(parsed("file:raw.bin").rate_hz);
  EXPECT_EQ(parsed("file:a%3Fb%20c").path, "a?b c");
  EXPECT_EQ(parsed("stdin:?protocol=stag&bit_shift=6").protocol.bit_shift, 6);
}

TEST(SourceUri, takes_a_simulation_apart) {
  const SourceUri uri = parsed("sim:multitouch?rows=64&cols=160&rate=1000&seed=7&array=/a/b.toml&frames=20");
  EXPECT_EQ(uri.transport, Transport::simulation);
  EXPECT_EQ(uri.path, "multitouch");
  EXPECT_EQ(uri.array_shape, (FrameShape{64, 160}));
  EXPECT_EQ(uri.rate_hz, 1000.0);
  EXPECT_EQ(uri.seed, 7U);
  EXPECT_EQ(uri.array, "/a/b.toml");
  EXPECT_EQ(uri.frames, 20U);
  EXPECT_FALSE(parsed("sim:idle").rate_hz);
  EXPECT_EQ(parsed("sim:touches?memory=rubber").memory, "rubber");
  EXPECT_EQ(parsed("sim:touches").memory, "");
  EXPECT_EQ(parsed("sim:touches?gain=0.9&gain_spread=0.1").gain, 0.9);
  EXPECT_EQ(parsed("sim:touches?gain=0.9&gain_spread=0.1").gain_spread, 0.1);
  EXPECT_EQ(parsed("sim:touches").gain, 1.0);
}

TEST(SourceUri, names_what_is_wrong_and_the_mend) {
  expect_words(message("serial:///dev/ttyACM0?boud=9600"), {"boud", "did you mean 'baud'"});
  expect_words(message("tcp://host:1?baud=9600"), {"baud", "no parameter of tcp"});
  expect_words(message("sim:idle?protocol=csv"), {"protocol", "no parameter of sim"});
  expect_words(message("file:/a?quality=9"), {"quality", "protocol"});
  expect_words(message("tcp://host"), {"host and port", "tcp://127.0.0.1:7000"});
  expect_words(message("tcp://host:0"), {"1 to 65535"});
  expect_words(message("tcp://host:65536"), {"1 to 65535"});
  expect_words(message("tcp://::1:7000"), {"brackets"});
  expect_words(message("serial:"), {"serial:///dev/ttyACM0"});
  expect_words(message("sim:"), {"scene"});
  expect_words(message("serial:///dev/x?baud=fast"), {"baud", "50 to 20000000", "fast"});
  expect_words(message("serial:///dev/x?baud=9600&baud=1200"), {"baud", "twice"});
  expect_words(message("serial:///dev/x?rows=4"), {"rows and cols"});
  expect_words(message("serial:///dev/x?rows=0&cols=4"), {"rows", "1 to 1024"});
  expect_words(message("serial:///dev/x?rows"), {"name=value"});
  expect_words(message("serial:///dev/%zz"), {"%"});
  expect_words(message("serial:///dev/a%00b"), {"00"});
  expect_words(message(std::string("serial:///dev/a\0b", 17)), {"byte of 0"});
  expect_words(message("sim:idle?rate=0"), {"rate", "above 0"});
  expect_words(message("sim:idle?rate=nan"), {"rate"});
  expect_words(message("sim:idle?gain=0"), {"gain", "0.1 to 10"});
  expect_words(message("serial:///dev/x?reconnect_s=-1"), {"reconnect_s"});
  expect_words(message("usb://1"), {"usb://1", "serial:", "tcp-listen:"});
  expect_words(message("pty:"), {"begins with none of"});
  expect_words(message("stdin:here"), {"nothing but parameters"});
  expect_words(message(std::string(5000, 'a')), {"4096"});
}

TEST(SourceUri, takes_the_keys_of_a_layout) {
  const SourceUri uri =
      parsed("serial:///dev/ttyUSB0?rows=2&cols=3&line=%7Bframe%7D%22 {values}&line_end=%0D&scale=0.5");
  EXPECT_EQ(uri.protocol.layout_keys,
            "[layout]\nrows = 2\ncols = 3\nline = \"{frame}\\\" {values}\"\nline_end = \"\\r\"\nscale = 0.5\n");
  EXPECT_TRUE(make_decoder(uri.protocol));
  const SourceUri packet = parsed("udp://0.0.0.0:9000?rows=2&cols=3&packet=AA 55,frame u8,values u16le");
  EXPECT_TRUE(make_decoder(packet.protocol));
  EXPECT_EQ(message("file:x?scale=2&rows=1&cols=1"),
            "'file:x?scale=2&rows=1&cols=1': scale: is of a layout; give line or packet, too");
  EXPECT_EQ(message("file:x?line={values}"), "'file:x?line={values}': line, packet: give rows and cols, too");
  EXPECT_EQ(message("file:x?line={values}&rows=1&cols=1&layout=x.toml"),
            "'file:x?line={values}&rows=1&cols=1&layout=x.toml': layout: give it or its keys, not both");
}

TEST(SourceUri, takes_which_way_round_the_lines_are_sent) {
  const SourceUri uri = parsed("serial:///dev/x?transpose=1&flip_rows=1&flip_cols=0&skip_columns=2&row_order=0,2,1");
  EXPECT_TRUE(uri.order.transpose);
  EXPECT_TRUE(uri.order.flip_rows);
  EXPECT_FALSE(uri.order.flip_cols);
  EXPECT_EQ(uri.order.skip_columns, 2U);
  EXPECT_EQ(uri.order.row_order, (std::vector<std::size_t>{0, 2, 1}));
  EXPECT_TRUE(parsed("tcp://host:1").order.is_plain());
  EXPECT_EQ(parsed("file:a.bin?col_order=1,0").order.col_order, (std::vector<std::size_t>{1, 0}));
}

TEST(SourceUri, takes_an_order_of_single_taxels) {
  const LineOrder order = parsed("file:a.mcap?rows=4&cols=8&taxel_order=7,3;0,31").order;
  EXPECT_EQ(order.taxel_order, (std::vector<std::size_t>{7, 3, 0, 31}));
  EXPECT_EQ(order.taxel_rows, 2U);
  EXPECT_EQ(order.taxels_sent, (FrameShape{4, 8}));
  expect_words(message("file:a.mcap?taxel_order=1,0"), {"taxel_order", "needs rows and cols"});
  expect_words(message("file:a.mcap?rows=1&cols=2&taxel_order=1,1"), {"names reading 1 twice"});
  for (const char* list : {"", "1,", "1;", "a", "-1", "0,1,2;3", "0;1,2"}) {
    expect_words(message("file:a.mcap?rows=2&cols=2&taxel_order=" + std::string(list)), {"taxel_order", "0,2;1,3"});
  }
}

TEST(SourceUri, names_an_order_of_lines_that_cannot_be) {
  expect_words(message("serial:///dev/x?transpose=yes"), {"transpose", "0 or 1", "yes"});
  expect_words(message("serial:///dev/x?flip=1"), {"flip"});
  expect_words(message("serial:///dev/x?skip_columns=1024"), {"skip_columns", "0 to 1023"});
  expect_words(message("serial:///dev/x?row_order=1,2"), {"row_order", "each line from 0 to 1 once"});
  for (const char* list : {"", ",", "0,", "a", "0;1", "-1", "1024", "0,,1"}) {
    expect_words(message("serial:///dev/x?col_order=" + std::string(list)), {"col_order", "such as 0,2,1"});
  }
  expect_words(message("sim:idle?transpose=1"), {"transpose", "no parameter of sim"});
}

TEST(SourceUri, tells_uris_from_paths) {
  for (const char* uri : {"serial:///dev/ttyACM0", "stdin:", "sim:idle", "http://x"})
    EXPECT_TRUE(is_source_uri(uri)) << uri;
  for (const char* path : {"rec.mcap", "/a/b.csv", "a:b.csv", "C:/rec.mcap", ":", ""})
    EXPECT_FALSE(is_source_uri(path)) << path;
}

TEST(TargetUri, knows_where_devices_send_to) {
  EXPECT_EQ(parse_target_uri("pty:")->transport, Transport::pseudo_terminal);
  EXPECT_EQ(parse_target_uri("stdout:")->transport, Transport::standard_output);
  EXPECT_EQ(parse_target_uri("tcp-listen://127.0.0.1:0")->port, 0);
  EXPECT_FALSE(parse_target_uri("file:/tmp/x"));
  EXPECT_FALSE(parse_target_uri("pty:?rows=4"));
  expect_words(parse_target_uri("tcp://h:1?protocol=csv").error().message, {"protocol", "no parameter"});
}

TEST(SourceUri, survives_any_text) {
  const std::uint64_t seed = 20261121;
  SCOPED_TRACE(seed);
  Random random(seed);
  const std::string letters = "serial:tcp-listen://[]?&=%:/@0123456789abcdefrowscolsbaud \n\t\"";
  for (int round = 0; round < 20'000; ++round) {
    std::string text = round % 2 == 0 ? "serial:///dev/x?" : "";
    for (std::size_t length = random.below(40); length > 0; --length) text += letters[random.below(letters.size())];
    const Result<SourceUri> uri = parse_source_uri(text);
    if (!uri) {
      ASSERT_EQ(uri.error().message.find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace dermis::bytes::devices
