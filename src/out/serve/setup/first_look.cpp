// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/first_look.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "dermis/bytes/devices/device_source.hpp"
#include "dermis/live/sources/patience.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kMostKept = 65536;

/// These bytes, possibly none, made no frame.
void explain(const live::sources::SourceName& name, std::vector<std::uint8_t> bytes, FirstLook& found) {
  if (!name.uri || bytes.empty()) {
    if (found.message.empty()) found.message = "nothing came within 8 s";
    return;
  }
  bytes::devices::UndecodedReason reason = bytes::devices::why_undecoded(*name.uri, bytes);
  found.message = std::move(reason.why);
  found.shape = reason.likely_shape;
  found.bytes = std::move(bytes);
}

}  // namespace

Result<FirstLook> first_look(const live::sources::SourceName& name, live::sources::SourceOptions options) {
  FirstLook found;
  const live::sources::Patience waits(options.stop, kPatience);
  options.stop = waits.over();
  const auto log = std::move(options.notice);
  options.notice = [&](const std::string& line) {
    found.message = line;
    if (log) log(line);
  };
  std::vector<std::uint8_t> bytes;
  options.received = [&](std::span<const std::uint8_t> more) {
    more = more.first(std::min(more.size(), kMostKept - bytes.size()));
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  const Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(name, options);
  if (!source) return source.error();
  RawFrame frame;
  const Result<bool> came = (*source)->next(frame);
  if (!came && came.error().kind != ErrorKind::bad_input) return came.error();
  if (!came) found.message = came.error().message;
  found.has_frames = came && *came;
  if (found.has_frames) {
    found.shape = (*source)->shape();
  } else {
    explain(name, std::move(bytes), found);
  }
  return found;
}

}  // namespace dermis::out::serve
