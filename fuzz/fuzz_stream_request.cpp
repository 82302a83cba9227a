// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "out/websocket/access.hpp"
#include "out/websocket/client.hpp"

using namespace dermis::out::websocket;

/// The first byte tells text from binary; a client with everything on offer gets the message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(is_same_origin(query_value(text, "token"), bearer_token(text)));
  static_cast<void>(is_loopback_authority(text));
  const Offer offer{
      {[] {
         return std::vector<Parameter>{{"/a", 1.0}};
       },
       [](const Parameter&, const std::string&) -> dermis::Status { return dermis::Done{}; }},
      {{"/echo", [](std::string_view request) -> dermis::Result<std::string> { return std::string(request); }}},
      PlaybackService{{}, dermis::Nanos(1), [](const dermis::PlaybackCommand&) { return dermis::PlaybackStatus{}; }}};
  std::vector<Question> questions;
  Client client(
      offer, "a client", true, 1U << 20U, [](ChannelId, int) {},
      [&](Question question) { questions.push_back(std::move(question)); });
  client.greet("dermis", "session", {});
  static_cast<void>(client.receive(std::span(data, size).subspan(1), data[0] % 2 == 0));
  for (const Question& question : questions) question()(client);
  ServerStatistics statistics;
  const auto bytes = std::make_shared<const std::vector<std::uint8_t>>(10);
  for (const MessageKind kind : {MessageKind::event, MessageKind::picture, MessageKind::piece}) {
    for (ChannelId channel = 0; channel < 4; ++channel) client.publish(channel, {}, bytes, kind, statistics);
  }
  while (!client.queue().empty()) static_cast<void>(client.queue().pop());
  return 0;
}
