// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/serial_ports.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::devices {
namespace {

namespace fs = std::filesystem;

TEST(SerialPorts, lists_usb_devices_by_their_lasting_names_and_products) {
  const support::TemporaryFolder folder;
  const fs::path dev = folder.file("dev");
  const fs::path sys = folder.file("sys");
  fs::create_directories(dev / "serial/by-id");
  for (const char* name : {"ttyUSB1", "ttyACM0", "ttyS0", "null"}) std::ofstream(dev / name);
  fs::create_symlink("../../ttyACM0", dev / "serial/by-id/usb-Arduino-if00");
  fs::create_symlink("../../ttyACM7", dev / "serial/by-id/usb-gone");
  fs::create_directories(sys / "devices/usb1/1-1/1-1:1.0");
  fs::create_directories(sys / "class/tty/ttyACM0");
  std::ofstream(sys / "devices/usb1/1-1/product") << "Arduino Uno\n";
  fs::create_symlink("../../../devices/usb1/1-1/1-1:1.0", sys / "class/tty/ttyACM0/device");

  const std::vector<SerialPort> ports = serial_ports(dev, sys);
  const std::string lasting = (dev / "serial/by-id/usb-Arduino-if00").string();
  const std::string usb = (dev / "ttyUSB1").string();
  EXPECT_EQ(ports, (std::vector<SerialPort>{{(dev / "ttyACM0").string(), lasting, "Arduino Uno"}, {usb, usb, ""}}));
}

TEST(SerialPorts, are_none_where_there_is_no_such_folder) {
  EXPECT_TRUE(serial_ports("/no/such/folder", "/no/such/folder").empty());
}

}  // namespace
}  // namespace dermis::bytes::devices
