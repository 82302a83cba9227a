// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/live/sources/emulated_device.hpp"
#include "source_options.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using bytes::devices::ByteStream;
using bytes::devices::Transport;

struct EmulateOptions {
  std::string protocol;
  std::string in;
  std::string to = "pty:";
  std::optional<double> rate_hz;
  bool loop = false;
};

Status emulate(const EmulateOptions& options) {
  if (options.rate_hz && !(*options.rate_hz > 0.0 && *options.rate_hz <= 1e6)) {
    return bad_input("--rate: must be above 0 and at most 1e6 frames a second");
  }
  const Result<bytes::devices::SourceUri> target = bytes::devices::parse_target_uri(options.to);
  if (!target) return bad_input("--to: " + target.error().message);
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(options.in, source_options());
  if (!source) return source.error();
  const std::optional<FrameShape> shape = (*source)->shape();
  if (!shape) return bad_input("'" + options.in + "': tells no shape; give a recording");
  bytes::devices::ProtocolOptions protocol;
  protocol.name = options.protocol;
  protocol.shape = shape;
  protocol.delimited = target->protocol.delimited;
  Result<std::unique_ptr<bytes::devices::Encoder>> encoder = bytes::devices::make_encoder(protocol);
  if (!encoder) return bad_input("--protocol: " + encoder.error().message);
  Result<std::unique_ptr<ByteStream>> stream = bytes::devices::make_target_stream(*target);
  if (!stream) return stream.error();

  const Result<bool> opened = (*stream)->open(Nanos{});
  if (!opened) return opened.error();
  if (target->transport != Transport::standard_output) {
    fmt::print("{}\n", (*stream)->name());
    std::fflush(stdout);
  }
  live::sources::EmulatedDevice device(*std::move(stream), target->transport, *std::move(encoder), stop_flag());
  if (!*opened) {
    if (Status there = device.wait_for_reader(); !there) return there;
  }
  do {
    if (!*source) {
      source = live::sources::open_source(options.in, source_options());
      if (!source) return source.error();
    }
    if (Status played = device.play(**source, options.rate_hz); !played) return played;
    source->reset();
  } while (options.loop && !device.stopped());
  return device.finish();
}

}  // namespace

void add_emulate(Command& command) {
  auto options = std::make_shared<EmulateOptions>();
  std::vector<std::string> protocols = bytes::devices::protocol_names();
  std::erase(protocols, "auto");
  command.option("--protocol", options->protocol, "What the device speaks").one_of(protocols).required();
  command.input("--in", options->in, "Frames to send: a recording, another file of frames, or sim:SCENE").required();
  command.option("--to", options->to, "pty: | tcp-listen://HOST:PORT | tcp:// | udp:// | serial:// | stdout:")
      .shows_default();
  command.option("--rate", options->rate_hz, "Frames a second instead of the recorded pace");
  command.flag("--loop", options->loop, "Start again at the end");
  command.action([options] { return emulate(*options); });
}

}  // namespace dermis::app
