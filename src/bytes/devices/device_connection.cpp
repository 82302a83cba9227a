// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/device_connection.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "bytes/devices/chunk_stamps.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr Nanos kTick = std::chrono::milliseconds(50);
constexpr Nanos kLongestPause = std::chrono::seconds(1);
constexpr Nanos kNoticeAfter = std::chrono::seconds(2);

std::string seconds_text(Nanos time) {
  std::string text = std::to_string(std::chrono::duration<double>(time).count());
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

}  // namespace

DeviceConnection::DeviceConnection(const SourceUri& uri, std::unique_ptr<ByteStream> stream, Notice notice)
    : transport_(uri.transport),
      reconnect_(uri.reconnect),
      stream_(std::move(stream)),
      notice_(std::move(notice)),
      since_(now().steady) {}

Status DeviceConnection::try_open(Nanos wait) {
  return state_ == State::away ? wait_for_return(wait) : wait_for_first(wait);
}

Result<std::size_t> DeviceConnection::read(std::span<std::uint8_t> into, Nanos timeout, bool device_was_here) {
  const ByteStream::Transferred read = stream_->read(into, timeout);
  if (is_returning_ && (read.bytes > 0 || now().steady - opened_ >= kLongestPause)) come_back();
  if (read.end != ByteStream::End::none) {
    if (const Status ended = end(read.end, device_was_here); !ended) return ended.error();
  }
  return read.bytes;
}

void DeviceConnection::write(std::span<const std::uint8_t> bytes) {
  (void)stream_->write(bytes, kTick);
}

Status DeviceConnection::end(ByteStream::End how, bool device_was_here) {
  const bool may_return =
      transport_ == Transport::serial || transport_ == Transport::tcp || transport_ == Transport::tcp_listen;
  if (!may_return) {
    enter(State::over);
    if (how == ByteStream::End::lost) return failed("cannot read " + name());
    return Done{};
  }
  if (transport_ == Transport::tcp_listen && !device_was_here) {
    enter(State::waiting);
    return Done{};
  }
  how_it_ended_ = how;
  leave();
  return Done{};
}

void DeviceConnection::leave() {
  const Nanos time = now().steady;
  const bool was_short = time - opened_ < kLongestPause;
  pause_ = was_short ? std::clamp(2 * pause_, kTick, kLongestPause) : kTick;
  next_try_ = time + pause_;
  if (std::exchange(is_returning_, false)) {
    state_ = State::away;
    return;
  }
  enter(State::away);
  if (reconnect_ > Nanos{}) {
    notice_(name() + what_happened() + ": waiting up to " + seconds_text(reconnect_) + " for it to come back");
  }
}

void DeviceConnection::come_back() {
  is_returning_ = false;
  ++reconnections_;
  notice_(name() + " is back");
}

Status DeviceConnection::wait_for_first(Nanos wait) {
  const Result<bool> opened = stream_->open(wait);
  if (!opened) return opened.error();
  if (*opened) {
    enter(State::open);
    opened_ = since_;
  } else if (transport_ == Transport::tcp_listen && !waiting_noticed_ && now().steady - since_ >= kNoticeAfter) {
    waiting_noticed_ = true;
    notice_("listening on " + name() + ": no device has connected yet");
  }
  return Done{};
}

Status DeviceConnection::wait_for_return(Nanos wait) {
  if (now().steady - since_ >= reconnect_) return give_up();
  if (wait > Nanos{}) std::this_thread::sleep_for(wait);
  if (now().steady < next_try_) return Done{};
  const Result<bool> opened = stream_->open(wait);
  if (!opened || !*opened) return Done{};
  state_ = State::open;
  opened_ = now().steady;
  is_returning_ = true;
  return Done{};
}

Status DeviceConnection::give_up() {
  enter(State::over);
  if (how_it_ended_ == ByteStream::End::closed) return Done{};
  const std::string place = name() + what_happened();
  if (reconnect_ == Nanos{}) return failed(place + ": reconnect_s=10 would wait for it");
  return failed(place + " and did not come back within " + seconds_text(reconnect_) +
                ": check cable and power, and begin again");
}

std::string DeviceConnection::what_happened() const {
  if (transport_ == Transport::serial) return " is unplugged";
  return how_it_ended_ == ByteStream::End::closed ? " has closed the connection" : " is cut off";
}

void DeviceConnection::enter(State state) {
  state_ = state;
  since_ = now().steady;
  waiting_noticed_ = false;
}

}  // namespace dermis::bytes::devices
