// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Frames of devices that are asked by Modbus, of topics of DDS and of CAN: one connection, several arrays
/// (docs/hands.md).
namespace dermis::live::buses {

/// modbus-tcp://HOST[:PORT]?map=M and modbus-rtu:///dev/ttyUSB0?map=M
struct ModbusPlace {
  std::string host{};                          ///< Empty: it is a serial line.
  std::uint16_t port = 0;                      ///< 0: that of the map.
  std::string path{};                          ///< The serial line.
  unsigned baud = 115'200;                     ///< The serial line has 8 data bits, no parity and 1 stop bit.
  int unit = 0;                                ///< 1 ... 247; 0: that of the map.
  std::string map{};                           ///< Name or path of a register map (register_map.hpp).
  std::optional<double> rate_hz{};             ///< Frames of each array a second; empty: as many as the device answers.
  Nanos reconnect = std::chrono::seconds(10);  ///< A device that does not answer is asked for so long.
};

/// dds://DOMAIN/TOPIC?type=T
struct TopicPlace {
  std::uint32_t domain = 0;
  std::string topic{};         ///< As DDS names it: "rt/dex3/left/state".
  std::string type{};          ///< Name of a bytes::ros_messages::TouchType.
  bool loopback_only = false;  ///< No other machine is heard.
};

/// can://INTERFACE?map=M
struct CanInterface {
  std::string interface {};                    ///< "can0"
  std::string map{};                           ///< Name or path of a map (can_map.hpp).
  std::optional<double> rate_hz{};             ///< Questions to each array a second; empty: as many as are answered.
  Nanos reconnect = std::chrono::seconds(10);  ///< So long an interface that is down is waited for.
};

/// candump:PATH?map=M, a log of such a bus.
struct CanLog {
  std::string path{};
  std::string map{};
  std::string interface {};         ///< Empty: the only one with frames of the array.
  std::optional<double> rate_hz{};  ///< Frames a second of a log without times.
};

struct BusAddress {
  std::string text;        ///< As it was given.
  std::string connection;  ///< The same of all arrays that share one.
  std::string array{};     ///< Empty: the only one.
  std::variant<ModbusPlace, TopicPlace, CanInterface, CanLog> place{};
};

/// True if the text begins as modbus-tcp:, modbus-rtu:, dds:, can: or candump:.
[[nodiscard]] bool is_bus_address(std::string_view text);

/// Fails, with the mend, on an unknown or a missing part.
[[nodiscard]] Result<BusAddress> parse_bus_address(const std::string& text);

/// Name or path of the map; empty for a topic, which has none.
[[nodiscard]] std::string map_of(const BusAddress& address);

}  // namespace dermis::live::buses
