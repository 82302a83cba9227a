// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

/// Decides who may have the stream. A page of any site that is open in a browser can reach a server on loopback. But it
/// cannot forge Host and Origin.
namespace dermis::out::websocket {

/// "127.0.0.1", "127.1.2.3", "::1", "localhost".
[[nodiscard]] bool is_loopback(std::string_view host);

/// An address that can be bound to: IPv4, IPv6 or "localhost".
[[nodiscard]] bool is_address(std::string_view host);

/// The address in numbers: "LocalHost" -> "127.0.0.1".
[[nodiscard]] std::string numeric_address(std::string_view host);

/// Letters, digits and "-._~".
[[nodiscard]] bool is_url_safe(std::string_view token);

/// The Host header of a request names this machine's loopback ("127.0.0.1:8080"), and no other name that was made to
/// lead here (DNS rebinding).
[[nodiscard]] bool is_loopback_authority(std::string_view authority);

/// The page that asks came from this server, or it is no page at all: its Origin is empty or has the Host's authority.
[[nodiscard]] bool is_same_origin(std::string_view origin, std::string_view host);

/// The page is Foxglove's or Lichtblick's, on the web.
[[nodiscard]] bool is_known_tool(std::string_view origin);

/// The value of a key in "/path?key=value&...", empty where there is none.
[[nodiscard]] std::string_view query_value(std::string_view target, std::string_view key);

/// "/path" of "/path?query".
[[nodiscard]] std::string_view path_of(std::string_view target);

/// "Bearer abc" -> "abc"; empty where it is anything else.
[[nodiscard]] std::string_view bearer_token(std::string_view authorization);

/// Takes the same time wherever the texts differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view given, std::string_view expected);

}  // namespace dermis::out::websocket
