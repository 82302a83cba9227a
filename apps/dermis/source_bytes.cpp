// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "source_bytes.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "asking.hpp"
#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/proposals/proposals.hpp"
#include "dermis/bytes/recordings/frame_file_info.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/live/buses/candump.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{5};  // until a device answers
constexpr std::chrono::seconds kListens{3};
constexpr std::chrono::milliseconds kStep{100};
constexpr std::size_t kEnough = 65536;

Status open_stream(bytes::devices::ByteStream& stream, const std::string& source) {
  for (const auto end = steady_clock::now() + kPatience;;) {
    const Result<bool> opened = stream.open(kStep);
    if (!opened) return opened.error();
    if (*opened) return Done{};
    if (steady_clock::now() > end || stop_flag()) return failed("'" + source + "': nobody has connected");
  }
}

std::vector<std::uint8_t> bytes_of_stream(bytes::devices::ByteStream& stream) {
  std::vector<std::uint8_t> bytes(kEnough);
  std::size_t size = 0;
  for (const auto end = steady_clock::now() + kListens; size < kEnough && steady_clock::now() < end && !stop_flag();) {
    const auto came = stream.read(std::span(bytes).subspan(size), kStep);
    size += came.bytes;
    if (came.end != bytes::devices::ByteStream::End::none) break;
  }
  bytes.resize(size);
  return bytes;
}

/// A format whose content proves it: by its first bytes, or since it holds frames. Numbers alone are in any.
std::optional<bytes::recordings::FrameFormat> proven_format(const std::string& path, std::string_view first_bytes) {
  const Result<bytes::recordings::FrameFormat> format = bytes::recordings::recognise_frames(path);
  if (!format || *format == bytes::recordings::FrameFormat::text_matrix) return std::nullopt;
  if (*format == bytes::recordings::FrameFormat::matlab && first_bytes.starts_with("MATLAB")) return *format;
  const auto info = bytes::recordings::frame_file_info(path, std::nullopt);
  return info && info->frames > 0 ? std::optional(*format) : std::nullopt;
}

bool is_candump(std::string_view text) {
  return live::buses::parse_candump_line(text.substr(0, text.find_first_of("\r\n"))).has_value();
}

Result<SourceBytes> bytes_of_file(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return bytes::files::open_input(path).error();
  SourceBytes found;
  const std::string text = bytes::files::first_bytes_of(path, bytes::proposals::kMostBytes);
  if (const auto format = proven_format(path, text)) found.known = bytes::recordings::to_string(*format);
  if (found.known.empty() && is_candump(text)) found.known = "a log of candump (candump:" + path + "?map=MAP)";
  found.bytes.assign(text.begin(), text.end());
  return found;
}

Result<SourceBytes> bytes_of_device(const bytes::devices::SourceUri& uri, const std::string& asks) {
  const Result<std::unique_ptr<bytes::devices::ByteStream>> stream = bytes::devices::make_source_stream(uri);
  if (!stream) return stream.error();
  if (const Status opened = open_stream(**stream, uri.text); !opened) return opened.error();
  SourceBytes found;
  found.is_stream = true;
  if (asks.empty()) {
    found.bytes = bytes_of_stream(**stream);
  } else {
    Result<Asked> asked = ask_device(**stream, asks);
    if (!asked) return asked.error();
    found.bytes = std::move(asked->bytes);
    found.start = std::move(asked->start);
    found.request = std::move(asked->request);
  }
  found.known = bytes::devices::detect_protocol(found.bytes);
  return found;
}

}  // namespace

Result<SourceBytes> read_source_bytes(const std::string& source, const std::string& asks) {
  const Result<live::sources::SourceName> name = live::sources::SourceName::parse(source);
  if (!name) return name.error();
  if (name->kind == live::sources::SourceKind::simulation)
    return bad_input("'" + source + "': a simulation needs no layout");
  if (name->stream || name->bus) return bad_input("'" + source + "': has frames, not bytes, and needs no layout");
  if (!name->uri && !asks.empty()) return bad_input("--ask: '" + source + "' is no device");
  Result<SourceBytes> found = name->uri ? bytes_of_device(*name->uri, asks) : bytes_of_file(source);
  if (found && found->bytes.empty()) {
    return bad_input("'" + source + "': not a single byte came" +
                     (name->uri && asks.empty() ? "; where the device waits to be asked, --ask finds it" : ""));
  }
  return found;
}

}  // namespace dermis::app
