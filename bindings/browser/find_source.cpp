// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// find_source() for a page, which cannot wait for frames: the board that is connected is the one, or there is none.
#include <algorithm>
#include <utility>
#include <vector>

#include "dermis/bytes/devices/serial_ports.hpp"
#include "live/sources/likely_sources.hpp"

namespace dermis::live::sources {
namespace {

bool is_there(const SourceName& name) {
  if (!name.uri || name.uri->transport != bytes::devices::Transport::serial) return name.uri.has_value();
  const std::vector<bytes::devices::SerialPort> ports = bytes::devices::serial_ports();
  return std::ranges::find(ports, name.uri->path, &bytes::devices::SerialPort::path) != ports.end();
}

}  // namespace

Result<SourceName> find_source(const ArrayFolder& folder, FrameShape /*sent*/, const SourceOptions& /*options*/) {
  for (SourceName& name : likely_sources(folder)) {
    if (is_there(name)) return std::move(name);
  }
  return bad_input("'" + folder.path + "': is not connected: press Connect a board");
}

}  // namespace dermis::live::sources
