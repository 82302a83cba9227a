// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"

/// The Foxglove WebSocket protocol as bytes: text messages are JSON, binary ones begin with an opcode and are
/// little-endian. Requests may be anything. A request outside the protocol gives an error without a place and without a
/// word of it, as the error goes into the log.
namespace dermis::out::websocket {

inline constexpr std::string_view kSdkSubprotocol = "foxglove.sdk.v1";
inline constexpr std::string_view kWebsocketSubprotocol = "foxglove.websocket.v1";

/// The better of those a client offers ("a, b"); empty where it offers neither.
[[nodiscard]] std::string_view choose_subprotocol(std::string_view offered);

struct Subscribe {
  struct Subscription {
    std::uint32_t id = 0;
    ChannelId channel = 0;
  };
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
struct GetParameters {
  std::vector<std::string> names;  ///< Empty: all.
  std::string id;
};
struct SetParameters {
  std::vector<Parameter> parameters;
  std::string id;  ///< Empty: no answer is asked for.
};
struct FollowParameters {
  std::vector<std::string> names;
  bool follow = true;
};
struct ServiceCall {
  std::uint32_t service = 0;
  std::uint32_t call = 0;
  std::string encoding;
  std::string request;
};
struct PlaybackRequest {
  PlaybackCommand command{};
  std::string id{};  ///< Given back with the status that answers it.
};
/// The bytes of binary messages that the client has taken so far; an extension of ours (docs/stream.md).
struct Taken {
  std::uint64_t bytes = 0;
};
/// A request of a capability that is not offered: ignored.
struct OtherRequest {};

using ClientRequest = std::variant<OtherRequest, Subscribe, Unsubscribe, GetParameters, SetParameters, FollowParameters,
                                   ServiceCall, PlaybackRequest, Taken>;

[[nodiscard]] Result<ClientRequest> parse_text_request(std::string_view text);
[[nodiscard]] Result<ClientRequest> parse_binary_request(std::span<const std::uint8_t> bytes);

struct Channel {
  ChannelId id = 0;
  std::string topic;
  std::string schema_name;
  std::string schema;  ///< ros2msg
};

struct ServerInfo {
  std::string name;
  std::string session;  ///< Another one each time a server is started.
  bool has_parameters = false;
  bool has_services = false;
  std::optional<std::pair<Nanos, Nanos>> playback{};  ///< First and last time of the recording.
};

[[nodiscard]] std::string server_info_text(const ServerInfo& info);
[[nodiscard]] std::string advertise_text(std::span<const Channel> channels);
[[nodiscard]] std::string advertise_services_text(std::span<const Service> services);
[[nodiscard]] std::string parameter_values_text(std::span<const Parameter> parameters, std::string_view id);
[[nodiscard]] std::string status_text(int level, std::string_view message);
[[nodiscard]] std::string service_failure_text(const ServiceCall& call, std::string_view message);

/// The header before the payload of a data message.
using MessageDataHeader = std::array<std::uint8_t, 13>;
[[nodiscard]] MessageDataHeader message_data_header(std::uint32_t subscription, Nanos log_time);
[[nodiscard]] std::vector<std::uint8_t> service_response(const ServiceCall& call, std::string_view response);
/// Says with the id of the request that it answers whether that has sought; of no request, both are empty.
[[nodiscard]] std::vector<std::uint8_t> playback_state(const PlaybackStatus& status, const PlaybackRequest& answered);

}  // namespace dermis::out::websocket
