// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

namespace dermis::bytes::devices {

/// A serial device that is plugged in.
struct SerialPort {
  std::string device;   ///< "/dev/ttyACM0"
  std::string path;     ///< A name that stays the same, below /dev/serial/by-id, where there is one; else `device`.
  std::string product;  ///< "Arduino Uno", as the device says; empty: it does not.

  bool operator==(const SerialPort&) const = default;
};

/// The USB serial devices (ttyACM*, ttyUSB*), by their names. Opens none of them. `dev` and `sys` are the folders of
/// devices and of what the kernel knows of them. Thread-safe.
[[nodiscard]] std::vector<SerialPort> serial_ports(const std::string& dev = "/dev", const std::string& sys = "/sys");

}  // namespace dermis::bytes::devices
