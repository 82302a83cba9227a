// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/source_choice.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "dermis/bytes/devices/serial_ports.hpp"
#include "out/serve/recording/recordings_folder.hpp"
#include "out/serve/requests/json_request.hpp"

namespace dermis::out::serve {
namespace {

using bytes::devices::Transport;
using live::sources::SourceName;
using nlohmann::ordered_json;

constexpr std::size_t kMostText = 255;
constexpr std::array<const char*, 2> kScenes{"contacts", "rehearsal"};

Result<SourceName> port_of(const JsonRequest& request, const std::string& path) {
  const auto baud = request.number("baud", "50 to 20000000");
  if (!baud) return baud.error();
  const std::vector<bytes::devices::SerialPort> ports = bytes::devices::serial_ports();
  if (std::ranges::find(ports, path, &bytes::devices::SerialPort::path) == ports.end()) {
    return bad_field("port", "is none of the serial ports of this machine");
  }
  std::string uri = "serial://" + path;
  if (*baud) uri += "?baud=" + std::to_string(**baud);
  return SourceName::parse(uri);
}

Result<SourceName> recording_of(const std::string& name) {
  const Result<std::string> path = RecordingsFolder("").recording(name);
  if (!path) return bad_field("recording", "is none of this folder");
  return SourceName::parse(name);
}

Result<SourceName> simulation_of(const std::string& scene) {
  if (std::ranges::find(kScenes, scene) == kScenes.end()) return bad_field("simulation", "is none of those offered");
  return SourceName::parse("sim:" + scene + "?rate=100");
}

Result<SourceName> address_of(const std::string& text) {
  Result<SourceName> name = SourceName::parse(text.find("://") == std::string::npos ? "tcp://" + text : text);
  if (!name) return name;
  const auto is_network = [](Transport transport) {
    return transport == Transport::tcp || transport == Transport::tcp_listen || transport == Transport::udp;
  };
  if (!name->uri || !is_network(name->uri->transport)) {
    return bad_field("address", "must be HOST:PORT, or begin with tcp://, tcp-listen:// or udp://");
  }
  return name;
}

}  // namespace

std::string source_choices() {
  ordered_json answer;
  answer["ports"] = ordered_json::array();
  for (const bytes::devices::SerialPort& port : bytes::devices::serial_ports()) {
    answer["ports"].push_back({{"device", port.device}, {"path", port.path}, {"product", port.product}});
  }
  answer["recordings"] = ordered_json::array();
  for (const SavedFile& file : RecordingsFolder("").recordings()) answer["recordings"].push_back(file.name);
  answer["simulations"] = kScenes;
  return json_text(answer);
}

Result<SourceName> source_request(std::string_view text) {
  const Result<JsonRequest> request = JsonRequest::parse(text);
  if (!request) return request.error();
  const auto chosen = [&](const char* field) { return request->text(field, kMostText); };
  for (const char* field : {"port", "recording", "simulation", "address"}) {
    if (const Result<std::string> value = chosen(field); !value) return value.error();
  }
  if (const std::string path = *chosen("port"); !path.empty()) return port_of(*request, path);
  if (const std::string name = *chosen("recording"); !name.empty()) return recording_of(name);
  if (const std::string scene = *chosen("simulation"); !scene.empty()) return simulation_of(scene);
  return address_of(*chosen("address"));
}

}  // namespace dermis::out::serve
