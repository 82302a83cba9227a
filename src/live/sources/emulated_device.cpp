// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/emulated_device.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "dermis/live/sources/pacer.hpp"

namespace dermis::live::sources {
namespace {

using bytes::devices::ByteStream;
using bytes::devices::Transport;

constexpr std::chrono::milliseconds kTick{50};
constexpr std::chrono::seconds kTimeToTake{2};

}  // namespace

EmulatedDevice::EmulatedDevice(std::unique_ptr<ByteStream> stream, Transport transport,
                               std::unique_ptr<bytes::devices::Encoder> encoder, const std::atomic<bool>& stop)
    : stream_(std::move(stream)), transport_(transport), encoder_(std::move(encoder)), stop_(stop) {}

Status EmulatedDevice::wait_for_reader() {
  while (!stopped()) {
    const Result<bool> opened = stream_->open(kTick);
    if (!opened) return opened.error();
    if (*opened) break;
  }
  received_.clear();
  has_new_reader_ = true;
  return Done{};
}

Status EmulatedDevice::play(FrameSource& source, std::optional<double> rate_hz) {
  std::optional<Pacer> pacer;
  Nanos first_time{};
  std::uint64_t number = 0;
  RawFrame frame;
  for (; !stopped(); ++number) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) break;
    const bool is_new_reader = std::exchange(has_new_reader_, false);
    if (!pacer || is_new_reader) {  // nobody gets what was measured while he was away
      pacer.emplace(&stop_);
      first_time = frame.time;
      number = 0;
    }
    const Nanos due =
        rate_hz ? Nanos(std::llround(1e9 * static_cast<double>(number) / *rate_hz)) : due_after(first_time, frame.time);
    if (!pacer->wait_until(due)) return Done{};
    if (Status asked = wait_for_request(); !asked) return asked;
    if (Status sent = send(frame); !sent) return sent;
  }
  return Done{};
}

/// Until the reader asks for a frame, where the protocol wants that.
Status EmulatedDevice::wait_for_request() {
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

Status EmulatedDevice::send(const RawFrame& frame) {
  bytes_.clear();
  encoder_->encode(frame, bytes_);
  return send_bytes();
}

Status EmulatedDevice::finish() {
  bytes_.clear();
  encoder_->finish(bytes_);
  if (Status sent = send_bytes(); !sent) return sent;
  const bool keeps_bytes = transport_ != Transport::pseudo_terminal;
  std::array<std::uint8_t, 256> ignored{};
  Pacer pacer(&stop_);
  while (!keeps_bytes && !stopped() && pacer.elapsed() < kTimeToTake) {
    if (stream_->read(ignored, kTick).end != ByteStream::End::none) break;
    pacer.wait_until(pacer.elapsed() + kTick);
  }
  return Done{};
}

Status EmulatedDevice::send_bytes() {
  std::span<const std::uint8_t> rest = bytes_;
  while (!rest.empty() && !stopped()) {
    const ByteStream::Transferred written = stream_->write(rest, kTick);
    rest = rest.subspan(written.bytes);
    if (written.end != ByteStream::End::none) return reader_left();  // the rest of this frame goes nowhere
  }
  return Done{};
}

Status EmulatedDevice::listen() {
  std::array<std::uint8_t, 256> bytes{};
  const ByteStream::Transferred read = stream_->read(bytes, kTick);
  received_.append(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(read.bytes));
  if (received_.size() > 2 * bytes.size()) received_.erase(0, bytes.size());
  return read.end == ByteStream::End::none ? Done{} : reader_left();
}

/// A device goes on without a reader; one that has connected to its reader ends with it.
Status EmulatedDevice::reader_left() {
  is_over_ = transport_ == Transport::tcp || transport_ == Transport::standard_output;
  return wait_for_reader();
}

}  // namespace dermis::live::sources
