// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/acquisition/byte_stream.hpp"
#include "dermis/acquisition/protocol.hpp"
#include "dermis/acquisition/source_uri.hpp"
#include "dermis/sources/pacer.hpp"
#include "open_source.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using acquisition::ByteStream;
using acquisition::Transport;

constexpr std::chrono::milliseconds kTick{50};
constexpr std::chrono::seconds kTimeToTake{2};

struct EmulateOptions {
  std::string protocol;
  std::string in;
  std::string to = "pty:";
  std::optional<double> rate_hz;
  bool loop = false;
};

/// A device that sends encoded frames and waits for requests, as a stream allows.
class Device {
 public:
  Device(std::unique_ptr<ByteStream> stream, Transport transport, std::unique_ptr<acquisition::Encoder> encoder)
      : stream_(std::move(stream)), transport_(transport), encoder_(std::move(encoder)) {}

  [[nodiscard]] bool stopped() const { return stop_flag().load() || over_; }

  /// Until somebody reads. Fails where that cannot be.
  Status wait_for_reader() {
    while (!stopped()) {
      const Result<bool> opened = stream_->open(kTick);
      if (!opened) return opened.error();
      if (*opened) break;
    }
    received_.clear();
    has_new_reader_ = true;
    return Done{};
  }

  /// Another reader has come since this was asked last.
  [[nodiscard]] bool has_new_reader() { return std::exchange(has_new_reader_, false); }

  /// Until the reader asks for a frame, where the protocol wants that.
  Status wait_for_request() {
    const std::string_view request = encoder_->request();
    while (!stopped()) {
      const std::size_t found = received_.find(request);
      if (found != std::string::npos) {
        received_.erase(0, found + request.size());
        break;
      }
      if (Status listened = listen(); !listened) return listened;
    }
    return Done{};
  }

  Status send(const RawFrame& frame) {
    bytes_.clear();
    encoder_->encode(frame, bytes_);
    return send_bytes();
  }

  /// Completes the last frame, and leaves the reader time to take it: what a pseudo-terminal still holds goes with its
  /// end.
  Status finish() {
    bytes_.clear();
    encoder_->finish(bytes_);
    if (Status sent = send_bytes(); !sent) return sent;
    const bool keeps_bytes = transport_ != Transport::pseudo_terminal;
    std::array<std::uint8_t, 256> ignored{};
    sources::Pacer pacer(&stop_flag());
    while (!keeps_bytes && !stopped() && pacer.elapsed() < kTimeToTake) {
      if (stream_->read(ignored, kTick).end != ByteStream::End::none) break;
      pacer.wait_until(pacer.elapsed() + kTick);
    }
    return Done{};
  }

 private:
  Status send_bytes() {
    std::span<const std::uint8_t> rest = bytes_;
    while (!rest.empty() && !stopped()) {
      const ByteStream::Transferred written = stream_->write(rest, kTick);
      rest = rest.subspan(written.bytes);
      if (written.end != ByteStream::End::none) return reader_left();  // the rest of this frame goes nowhere
    }
    return Done{};
  }

  Status listen() {
    std::array<std::uint8_t, 256> bytes{};
    const ByteStream::Transferred read = stream_->read(bytes, kTick);
    received_.append(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(read.bytes));
    if (received_.size() > 2 * bytes.size()) received_.erase(0, bytes.size());
    return read.end == ByteStream::End::none ? Done{} : reader_left();
  }

  /// A device goes on without a reader; one that has connected to its reader ends with it.
  Status reader_left() {
    over_ = transport_ == Transport::tcp || transport_ == Transport::standard_output;
    return wait_for_reader();
  }

  std::unique_ptr<ByteStream> stream_;
  Transport transport_;
  std::unique_ptr<acquisition::Encoder> encoder_;
  std::vector<std::uint8_t> bytes_;
  std::string received_;
  bool over_ = false;
  bool has_new_reader_ = false;
};

/// Plays the frames of a source once, in their own time or at a rate.
Status play(FrameSource& source, const EmulateOptions& options, Device& device) {
  std::optional<sources::Pacer> pacer;
  Nanos first_time{};
  std::uint64_t number = 0;
  RawFrame frame;
  for (; !device.stopped(); ++number) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) break;
    const bool is_new_reader = device.has_new_reader();
    if (!pacer || is_new_reader) {  // nobody gets what was measured while he was away
      pacer.emplace(&stop_flag());
      first_time = frame.time;
      number = 0;
    }
    const Nanos due = options.rate_hz ? Nanos(std::llround(1e9 * static_cast<double>(number) / *options.rate_hz))
                                      : sources::due_after(first_time, frame.time);
    if (!pacer->wait_until(due)) return Done{};
    if (Status asked = device.wait_for_request(); !asked) return asked;
    if (Status sent = device.send(frame); !sent) return sent;
  }
  return Done{};
}

Status emulate(const EmulateOptions& options) {
  if (options.rate_hz && !(*options.rate_hz > 0.0 && *options.rate_hz <= 1e6)) {
    return bad_input("--rate: must be above 0 and at most 1e6 frames a second");
  }
  const Result<acquisition::SourceUri> target = acquisition::parse_target_uri(options.to);
  if (!target) return bad_input("--to: " + target.error().message);
  Result<std::unique_ptr<FrameSource>> source = open_source(options.in, nullptr);
  if (!source) return source.error();
  const std::optional<FrameShape> shape = (*source)->shape();
  if (!shape) return bad_input("'" + options.in + "': tells no shape; give a recording");
  acquisition::ProtocolOptions protocol;
  protocol.name = options.protocol;
  protocol.shape = shape;
  protocol.delimited = target->protocol.delimited;
  Result<std::unique_ptr<acquisition::Encoder>> encoder = acquisition::make_encoder(protocol);
  if (!encoder) return bad_input("--protocol: " + encoder.error().message);
  Result<std::unique_ptr<ByteStream>> stream = acquisition::make_target_stream(*target);
  if (!stream) return stream.error();

  const Result<bool> opened = (*stream)->open(Nanos{});
  if (!opened) return opened.error();
  if (target->transport != Transport::standard_output) {
    fmt::print("{}\n", (*stream)->name());
    std::fflush(stdout);
  }
  Device device(std::move(*stream), target->transport, std::move(*encoder));
  if (!*opened) {
    if (Status there = device.wait_for_reader(); !there) return there;
  }
  do {
    if (!*source) {
      source = open_source(options.in, nullptr);
      if (!source) return source.error();
    }
    if (Status played = play(**source, options, device); !played) return played;
    source->reset();
  } while (options.loop && !device.stopped());
  return device.finish();
}

}  // namespace

void add_emulate(Command& command) {
  auto options = std::make_shared<EmulateOptions>();
  std::string names;
  for (const std::string& name : acquisition::protocol_names()) {
    if (name != "auto") names += (names.empty() ? "" : " | ") + name;
  }
  command.option("--protocol", options->protocol, names).required();
  command.option("--in", options->in, "Frames to send: a recording, another file of frames, or sim:SCENE").required();
  command.option("--to", options->to, "pty: | tcp-listen://HOST:PORT | tcp:// | udp:// | serial:// | stdout:")
      .shows_default();
  command.option("--rate", options->rate_hz, "Frames a second instead of the recorded pace");
  command.flag("--loop", options->loop, "Begin again at the end");
  command.action([options] { return emulate(*options); });
}

}  // namespace dermis::app
