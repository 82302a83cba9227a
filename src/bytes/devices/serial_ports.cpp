// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/serial_ports.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

namespace dermis::bytes::devices {
namespace {

namespace fs = std::filesystem;

constexpr int kMostParents = 3;  // from a port of a device to the device
constexpr std::streamsize kMostName = 100;

/// Where the links of /dev/serial/by-id lead.
std::map<fs::path, std::string> lasting_names(const fs::path& dev) {
  std::map<fs::path, std::string> names;
  std::error_code error;
  for (const auto& link : fs::directory_iterator(dev / "serial" / "by-id", error)) {
    std::error_code broken;
    const fs::path device = fs::canonical(link.path(), broken);
    if (!broken) names.emplace(device, link.path().string());
  }
  return names;
}

/// One line of a file of the kernel; empty where there is none.
std::string line_of(const fs::path& path) {
  std::ifstream file(path);
  std::string line(static_cast<std::size_t>(kMostName), '\0');
  file.read(line.data(), kMostName);
  line.resize(static_cast<std::size_t>(file.gcount()));
  return line.substr(0, line.find('\n'));
}

std::string product_of(const fs::path& sys, const std::string& name) {
  std::error_code error;
  fs::path folder = fs::canonical(sys / "class" / "tty" / name / "device", error);
  for (int parent = 0; !error && parent < kMostParents; ++parent) {
    if (std::string product = line_of(folder / "product"); !product.empty()) return product;
    folder = folder.parent_path();
  }
  return {};
}

}  // namespace

std::vector<SerialPort> serial_ports(const std::string& dev, const std::string& sys) {
  const std::map<fs::path, std::string> names = lasting_names(dev);
  std::vector<SerialPort> ports;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(dev, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("ttyUSB") && !name.starts_with("ttyACM")) continue;
    const std::string device = entry.path().string();
    std::error_code broken;
    const auto lasting = names.find(fs::canonical(entry.path(), broken));
    ports.push_back({device, lasting == names.end() ? device : lasting->second, product_of(sys, name)});
  }
  std::ranges::sort(ports, {}, &SerialPort::device);
  return ports;
}

}  // namespace dermis::bytes::devices
