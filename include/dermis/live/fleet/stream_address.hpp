// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "dermis/bytes/system/secret.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Frames of fleets of robots, in the streams of NATS JetStream (docs/fleet.md).
namespace dermis::live::fleet {

/// A server, and who asks it.
struct BrokerAddress {
  std::string url{};  ///< "nats://hub:4222", "tls://hub:4222".
  std::string ca{};  ///< Path of the certificates that sign that of the server; empty: those of the machine, with tls:.
  std::string
      key{};  ///< Path of the certificate and the key of the user, in PEM; the server must encrypt. Empty: none.
  std::string user{};           ///< Who has the password; empty: it is a token of NATS.
  std::string password_file{};  ///< Path; empty: it is in another of password_places(), or there is none.
};

/// Where the password, or the token, of a hub may be: in this file, in DERMIS_HUB_PASSWORD, in "hub-password" of
/// systemd.
[[nodiscard]] inline SecretPlaces password_places(const std::string& file = "") {
  return {file, "DERMIS_HUB_PASSWORD", "hub-password"};
}

/// A place in a stream: after all that is there, at a number of the stream, or at a time by UTC.
struct Newest {};
using StreamPlace = std::variant<Newest, std::uint64_t, Nanos>;

/// The frames of one array, as nats://HUB?robot=R&array=A&from=TIME|SEQUENCE|new&to=TIME|SEQUENCE|last.
struct StreamAddress {
  std::string text;  ///< As it was given, without the user.
  BrokerAddress broker{};
  std::string robot{};
  std::string array{};
  StreamPlace from = Newest{};
  StreamPlace to = Newest{};  ///< The last frame that is read, where it ends.
  bool ends = false;          ///< `to` is there; otherwise the source waits for frames that come.
};

/// True if the text begins as nats: or tls:.
[[nodiscard]] bool is_stream_address(std::string_view text);

/// Fails, with the mend, on an unknown or a missing part.
[[nodiscard]] Result<StreamAddress> parse_stream_address(const std::string& text);

/// nats://[USER@]HOST[:PORT][?ca=FILE&key=FILE&password-file=FILE]. Refuses a password: an address is shown.
[[nodiscard]] Result<BrokerAddress> parse_broker_address(const std::string& text);

/// "anna:secret" of "nats://anna:secret@hub?robot=anna": who asks; empty where nobody is named. It may begin within
/// `text`, as that of "--publish=nats://anna@hub" does.
[[nodiscard]] std::string_view user_info(std::string_view text);
/// An address as it may be shown: without its user_info().
[[nodiscard]] std::string without_user_info(const std::string& text);

/// Names of robots and arrays are parts of subjects: letters, digits, '_' and '-', at most 64, and no '_' or '-' first.
/// Fails on others.
[[nodiscard]] Status check_name(const std::string& what, const std::string& name);

/// "dermis_ROBOT", the stream of a robot.
[[nodiscard]] std::string stream_of(const std::string& robot);
/// "dermis.ROBOT.ARRAY.frames"
[[nodiscard]] std::string subject_of(const std::string& robot, const std::string& array, const char* what);
/// "dermis.ROBOT.health"
[[nodiscard]] std::string health_subject_of(const std::string& robot);
/// "dermis.ROBOT.changes": messages of health that differ from the one before.
[[nodiscard]] std::string changes_subject_of(const std::string& robot);

}  // namespace dermis::live::fleet
