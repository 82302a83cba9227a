// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/line_order.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::devices {

/// Transport of a device's bytes (docs/devices.md).
enum class Transport {
  serial,           ///< serial:///dev/ttyACM0
  tcp,              ///< tcp://host:port, the device listens
  tcp_listen,       ///< tcp-listen://127.0.0.1:7000, the device connects
  udp,              ///< udp://0.0.0.0:9000
  standard_input,   ///< stdin:
  file,             ///< file:/path, bytes of a device
  simulation,       ///< sim:SCENE, frames of the simulator
  pseudo_terminal,  ///< pty:, only to send: a serial device that does not exist
  standard_output,  ///< stdout:, only to send
};

/// A parsed URI. A missing parameter has its default. A parameter that does not suit the transport is an error of the
/// parser. Many members: each is a parameter of a URI.
struct SourceUri {
  std::string text;  ///< As it was given.
  Transport transport = Transport::file;
  std::string path;            ///< serial, file: the path; simulation: the scene.
  std::string host;            ///< tcp, tcp-listen, udp: name or address, IPv6 without brackets.
  std::uint16_t port = 0;      ///< 0 (any that is free) only for tcp-listen and udp.
  ProtocolOptions protocol{};  ///< protocol, layout, array, rows, cols, nodes_per_packet, delimited, bit_shift; not of
                               ///< a simulation.
  LineOrder order{};           ///< Order of the lines, by the names of its members; not of a simulation.
  unsigned baud = 0;           ///< serial: 50 ... 20,000,000; not given: the usual one of the protocol.
  Nanos reconnect{};           ///< serial, tcp: how long an unplugged device may stay away; reconnect_s, 0 ... 1e6.
  std::optional<FrameShape> array_shape{};  ///< simulation: rows and cols.
  /// simulation: rate, > 0 ... 1e6; empty: as fast as possible. file: frames a second, for times that begin at 0;
  /// empty: times of the reading.
  std::optional<double> rate_hz{};
  std::uint64_t seed = 1;               ///< simulation.
  std::string array{};                  ///< simulation: path of an array.toml.
  std::optional<std::size_t> frames{};  ///< simulation: length of the scenes multitouch, contacts, idle and touches.
  std::string memory{};                 ///< simulation: what the material remembers, by its name; empty: as usual.
  double gain = 1.0;                    ///< simulation: of an aged sheet, 0.1 ... 10.
  double gain_spread = 0.0;             ///< simulation: sd of its logarithm over the taxels, 0 ... 1.
};

/// True if `text` begins like a URI of a transport, valid or not; false: the path of a file.
[[nodiscard]] bool is_source_uri(std::string_view text);

/// scheme:[//]place[?name=value&...]; %XX stands for a byte. Fails on unknown schemes and on hosts without port. Also
/// fails on parameters that are unknown (with the nearest known one), do not suit the transport, come twice or are out
/// of range.
[[nodiscard]] Result<SourceUri> parse_source_uri(std::string_view text);

/// Target of an emulated device: pty:, stdout:, serial, tcp, tcp-listen and udp (to that host), without parameters of
/// protocols.
[[nodiscard]] Result<SourceUri> parse_target_uri(std::string_view text);

}  // namespace dermis::bytes::devices
