// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "out/websocket/foxglove_protocol.hpp"

namespace dermis::out::websocket {

/// Bytes that many clients share.
using SharedBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

/// A WebSocket message on its way to one client.
struct OutgoingMessage {
  bool is_text = false;
  std::optional<MessageDataHeader> header{};  ///< Set: the message is data, and this stands before its bytes.
  SharedBytes bytes;

  [[nodiscard]] std::size_t size() const noexcept { return (header ? header->size() : 0) + bytes->size(); }
};

/// The messages that wait for one client. The oldest data are dropped where there is too much; the rest is never
/// dropped and goes first. Not thread-safe.
class OutgoingQueue {
 public:
  explicit OutgoingQueue(std::size_t most_data_bytes) : most_data_bytes_(most_data_bytes) {}

  /// The number of messages that were dropped for it: all, where it alone is too large, so that one always comes
  /// through.
  std::size_t push_data(std::uint32_t subscription, Nanos log_time, SharedBytes bytes);
  void push_text(std::string_view text);
  void push_binary(std::vector<std::uint8_t> bytes);

  [[nodiscard]] bool empty() const noexcept { return control_.empty() && data_.empty(); }
  /// Size of the messages that are not data: grows without end where a client asks and never reads.
  [[nodiscard]] std::size_t control_bytes() const noexcept { return control_bytes_; }
  [[nodiscard]] std::size_t data_bytes() const noexcept { return data_bytes_; }
  /// Bytes of all binary messages so far that were not dropped, data and others.
  [[nodiscard]] std::uint64_t binary_bytes() const noexcept { return binary_bytes_; }

  /// The next to be sent; the queue must not be empty.
  [[nodiscard]] OutgoingMessage pop();

 private:
  void push_control(OutgoingMessage message);

  std::size_t most_data_bytes_;
  std::size_t data_bytes_ = 0;
  std::size_t control_bytes_ = 0;
  std::uint64_t binary_bytes_ = 0;
  std::deque<OutgoingMessage> control_;
  std::deque<OutgoingMessage> data_;
};

}  // namespace dermis::out::websocket
