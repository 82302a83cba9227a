// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/source_name.hpp"

#include <filesystem>
#include <utility>
#include <variant>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::live::sources {
namespace {

using bytes::devices::Transport;

/// Without a protocol, a file may be more than the bytes of a device. It is so with a rate or an order of lines, or
/// with a shape where its system does not tell one.
bool is_file_of_frames(const bytes::devices::SourceUri& uri) {
  if (uri.transport != Transport::file || uri.protocol.name != "auto" || uri.protocol.has_layout()) return false;
  const Result<bytes::recordings::FrameFormat> format =
      bytes::recordings::frame_format(bytes::recordings::recording_place(uri.path).path);
  if (!format) return false;
  const bool needs_shape = bytes::recordings::may_have_times(*format) ||
                           *format == bytes::recordings::FrameFormat::novel_asc ||
                           *format == bytes::recordings::FrameFormat::mcap;
  return uri.rate_hz || !uri.order.is_plain() || (uri.protocol.shape && needs_shape);
}

SourceKind kind_of(const bytes::devices::SourceUri& uri) {
  if (uri.transport == Transport::simulation) return SourceKind::simulation;
  return is_file_of_frames(uri) ? SourceKind::file : SourceKind::device;
}

bool is_recording(const std::string& path) {
  const Result<bytes::recordings::FrameFormat> format = bytes::recordings::frame_format(path);
  return format && *format == bytes::recordings::FrameFormat::mcap;
}

}  // namespace

Result<SourceName> SourceName::parse(const std::string& text) {
  SourceName name{.text = text};
  std::string path = text;
  if (fleet::is_stream_address(text)) {
    Result<fleet::StreamAddress> address = fleet::parse_stream_address(text);
    if (!address) return address.error();
    name.kind = SourceKind::stream;
    name.stream = *std::move(address);
    return name;
  }
  if (buses::is_bus_address(text)) {
    Result<buses::BusAddress> address = buses::parse_bus_address(text);
    if (!address) return address.error();
    const auto* const log = std::get_if<buses::CanLog>(&address->place);
    name.kind = log != nullptr ? SourceKind::file : SourceKind::bus;
    if (log != nullptr) name.file = log->path;
    name.bus = *std::move(address);
    return name;
  }
  if (bytes::devices::is_source_uri(text)) {
    Result<bytes::devices::SourceUri> uri = bytes::devices::parse_source_uri(text);
    if (!uri) return uri.error();
    name.kind = kind_of(*uri);
    path = uri->transport == Transport::file ? uri->path : "";
    name.uri = *std::move(uri);
  }
  bytes::recordings::RecordingPlace place = bytes::recordings::recording_place(path);
  if (!name.uri && is_recording(place.path)) name.kind = SourceKind::recording;
  name.file = std::move(place.path);
  name.array = std::move(place.array);
  return name;
}

std::vector<std::string> SourceName::files() const {
  std::vector<std::string> named{file};
  if (uri) named.insert(named.end(), {uri->protocol.layout, uri->array});
  if (bus) named.push_back(buses::map_of(*bus));
  std::erase(named, "");
  return named;
}

std::string SourceName::short_name() const {
  return std::filesystem::path(file).filename().string() + (array.empty() ? "" : "#" + array);
}

bool SourceName::needs_rate() const noexcept {
  return kind == SourceKind::simulation && !uri->rate_hz;
}

bool SourceName::has_times_of_its_own() const noexcept {
  return uri && uri->transport == Transport::file && (uri->rate_hz || uri->protocol.has_layout());
}

bool SourceName::hears(std::uint32_t domain, std::string_view topic) const {
  const auto* const place = bus ? std::get_if<buses::TopicPlace>(&bus->place) : nullptr;
  return place != nullptr && place->domain == domain && place->topic == topic;
}

}  // namespace dermis::live::sources
