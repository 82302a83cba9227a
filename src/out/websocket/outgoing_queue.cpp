// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/outgoing_queue.hpp"

#include <utility>

namespace dermis::out::websocket {
namespace {

/// Bytes that a message takes, which may be many times its own where it is short.
std::size_t cost(const OutgoingMessage& message) {
  constexpr std::size_t kBookkeeping = 256;
  return message.size() + kBookkeeping;
}

}  // namespace

std::size_t OutgoingQueue::push_data(std::uint32_t subscription, Nanos log_time, SharedBytes bytes) {
  OutgoingMessage message{false, message_data_header(subscription, log_time), std::move(bytes)};
  const std::size_t size = message.size();
  std::size_t dropped = 0;
  while (!data_.empty() && data_bytes_ + size > most_data_bytes_) {
    data_bytes_ -= data_.front().size();
    binary_bytes_ -= data_.front().size();
    data_.pop_front();
    ++dropped;
  }
  data_bytes_ += size;
  binary_bytes_ += size;
  data_.push_back(std::move(message));
  return dropped;
}

void OutgoingQueue::push_text(std::string_view text) {
  push_control({true, {}, std::make_shared<const std::vector<std::uint8_t>>(text.begin(), text.end())});
}

void OutgoingQueue::push_binary(std::vector<std::uint8_t> bytes) {
  binary_bytes_ += bytes.size();
  push_control({false, {}, std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes))});
}

OutgoingMessage OutgoingQueue::pop() {
  std::deque<OutgoingMessage>& from = control_.empty() ? data_ : control_;
  OutgoingMessage message = std::move(from.front());
  from.pop_front();
  if (message.header) {
    data_bytes_ -= message.size();
  } else {
    control_bytes_ -= cost(message);
  }
  return message;
}

void OutgoingQueue::push_control(OutgoingMessage message) {
  control_bytes_ += cost(message);
  control_.push_back(std::move(message));
}

}  // namespace dermis::out::websocket
