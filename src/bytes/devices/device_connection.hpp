// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::devices {

/// The stream of a device that may not be there yet, or may go away and come back. It is back when it sends, or stays
/// for a second. A peer that accepts and closes at once is asked less and less often, once a second in the end. Not
/// thread-safe.
class DeviceConnection {
 public:
  enum class State {
    waiting,  ///< Nobody has connected yet.
    open,
    away,  ///< Unplugged or closed: it may come back.
    over,
  };
  using Notice = std::function<void(const std::string&)>;

  DeviceConnection(const SourceUri& uri, std::unique_ptr<ByteStream> stream, Notice notice);

  [[nodiscard]] State state() const { return state_; }

  /// One try to open a stream that is waiting or away, which takes twice `wait` at most. Fails where it can never open,
  /// and where it was away too long.
  [[nodiscard]] Status try_open(Nanos wait);

  /// Reads the bytes that arrive within the time. Ends the connection where the stream ends. `device_was_here`: who
  /// closes a connection without a frame before was not the device, so another is waited for.
  [[nodiscard]] Result<std::size_t> read(std::span<std::uint8_t> into, Nanos timeout, bool device_was_here);
  /// As that of a stream.
  [[nodiscard]] int descriptor() const { return state_ == State::open ? stream_->descriptor() : -1; }

  /// A request that is lost is no error: it is repeated.
  void write(std::span<const std::uint8_t> bytes);

  [[nodiscard]] std::string name() const { return stream_->name(); }
  [[nodiscard]] std::uint64_t reconnections() const { return reconnections_; }

 private:
  Status end(ByteStream::End how, bool device_was_here);
  Status wait_for_first(Nanos wait);
  Status wait_for_return(Nanos wait);
  void leave();
  void come_back();
  Status give_up();
  [[nodiscard]] std::string what_happened() const;
  void enter(State state);

  Transport transport_;
  Nanos reconnect_;
  std::unique_ptr<ByteStream> stream_;
  Notice notice_;
  State state_ = State::waiting;
  Nanos since_;  // of the state; of one that is away, until it is back
  Nanos opened_{};
  Nanos pause_{};              // between the tries
  Nanos next_try_{};           // of one that is away
  bool is_returning_ = false;  // It is open again, and not yet back.
  ByteStream::End how_it_ended_ = ByteStream::End::none;
  bool waiting_noticed_ = false;
  std::uint64_t reconnections_ = 0;
};

}  // namespace dermis::bytes::devices
