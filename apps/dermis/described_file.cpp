// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "described_file.hpp"

#include <filesystem>

#include "dermis/bytes/devices/device_source.hpp"
#include "dermis/live/buses/bus_address.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "lost_input.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

bytes::devices::SourceUri uri_of_path(const std::string& name) {
  bytes::devices::SourceUri uri;
  uri.text = name;
  const std::size_t mark = std::filesystem::exists(name) ? std::string::npos : name.rfind('#');
  uri.path = name.substr(0, mark);
  if (mark != std::string::npos) uri.protocol.array = name.substr(mark + 1);
  uri.protocol.is_whole_file = true;
  return uri;
}

/// The frames of a robot or of the log of a bus, of which a file is to be made or told.
Result<std::unique_ptr<FrameSource>> open_stream(const std::string& name) {
  Result<std::unique_ptr<FrameSource>> stream =
      live::sources::open_source(name, {.stop = &stop_flag(), .notice = print_notice});
  const bool is_bus = live::buses::is_bus_address(name);
  if (stream && (*stream)->is_live() && is_bus) return live::sources::has_no_end(name);
  if (stream && (*stream)->is_live()) return bad_input("'" + name + "': has no end; add from=1&to=last");
  return stream;
}

}  // namespace

bool DescribedFile::is_described() const {
  return !layout.empty() || bytes::devices::is_source_uri(name) || live::buses::is_bus_address(name);
}

Result<std::unique_ptr<FrameSource>> DescribedFile::open() const {
  if (live::fleet::is_stream_address(name) || live::buses::is_bus_address(name)) return open_stream(name);
  const bool is_uri = bytes::devices::is_source_uri(name);
  Result<bytes::devices::SourceUri> uri = is_uri ? bytes::devices::parse_source_uri(name) : uri_of_path(name);
  if (!uri) return uri.error();
  if (uri->transport != bytes::devices::Transport::file) return bad_input("'" + name + "': name a file, as file:PATH");
  if (is_uri && !layout.empty()) return bad_input("--layout: '" + name + "' is a URI; write layout= in it");
  if (!layout.empty()) uri->protocol.layout = layout;
  if (rate_hz) uri->rate_hz = rate_hz;
  if (shape) uri->protocol.shape = shape;
  return bytes::devices::open_device(*std::move(uri), {.notice = print_notice});
}

}  // namespace dermis::app
