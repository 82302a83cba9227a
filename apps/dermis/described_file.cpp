// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "described_file.hpp"

#include <filesystem>

#include "dermis/bytes/devices/device_source.hpp"
#include "dermis/bytes/layouts/layout.hpp"
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

bool is_stream(const std::string& name) {
  return live::fleet::is_stream_address(name) || live::buses::is_bus_address(name);
}

}  // namespace

bool DescribedFile::is_described() const {
  return !layout.empty() || bytes::devices::is_source_uri(name) || live::buses::is_bus_address(name);
}

Result<bytes::devices::SourceUri> DescribedFile::uri() const {
  const bool is_uri = bytes::devices::is_source_uri(name);
  Result<bytes::devices::SourceUri> uri = is_uri ? bytes::devices::parse_source_uri(name) : uri_of_path(name);
  if (!uri) return uri.error();
  if (uri->transport != bytes::devices::Transport::file) return bad_input("'" + name + "': name a file, as file:PATH");
  if (is_uri && !layout.empty()) return bad_input("--layout: '" + name + "' is a URI; write layout= in it");
  if (!layout.empty()) uri->protocol.layout = layout;
  if (rate_hz) uri->rate_hz = rate_hz;
  if (shape) uri->protocol.shape = shape;
  return uri;
}

Result<std::vector<std::string>> DescribedFile::arrays() const {
  const std::vector<std::string> one{""};
  if (is_stream(name)) return one;
  const Result<bytes::devices::SourceUri> from = uri();
  if (!from) return from.error();
  if (!from->protocol.has_layout() || !from->protocol.array.empty()) return one;
  const Result<bytes::layouts::Layout> described = bytes::devices::read_layout(from->protocol);
  if (!described) return described.error();
  std::vector<std::string> names;
  for (const bytes::layouts::LayoutArray& array : described->arrays) names.push_back(array.name);
  return names.size() > 1 ? names : one;
}

Result<std::unique_ptr<FrameSource>> DescribedFile::open(const std::string& array) const {
  if (is_stream(name)) return open_stream(name);
  Result<bytes::devices::SourceUri> from = uri();
  if (!from) return from.error();
  if (!array.empty()) from->protocol.array = array;
  return bytes::devices::open_device(*std::move(from), {.notice = print_notice});
}

}  // namespace dermis::app
