// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Sources on other machines, which a page cannot reach: buses, and the streams of a fleet.
#include "dermis/live/buses/open_bus.hpp"
#include "dermis/live/fleet/frame_stream.hpp"

namespace dermis::live {
namespace {

Error not_in_a_page() {
  return bad_input("a page cannot reach it; the command dermis can");
}

}  // namespace

namespace buses {

bool is_bus_address(std::string_view /*text*/) {
  return false;
}

Result<BusAddress> parse_bus_address(const std::string& /*text*/) {
  return not_in_a_page();
}

std::string map_of(const BusAddress& /*address*/) {
  return {};
}

bool sends_turned_frames(const BusAddress& /*address*/) {
  return false;
}

Result<std::unique_ptr<FrameSource>> open_bus(const BusAddress& /*address*/, const BusOptions& /*options*/) {
  return not_in_a_page();
}

}  // namespace buses

namespace fleet {

class FrameStream::Implementation {};
FrameStream::~FrameStream() = default;

Result<std::unique_ptr<FrameStream>> FrameStream::open(const StreamAddress& /*address*/,
                                                       FrameStreamOptions /*options*/) {
  return not_in_a_page();
}

Result<bool> FrameStream::next(RawFrame& /*frame*/) {
  return not_in_a_page();
}

std::optional<FrameShape> FrameStream::shape() const {
  return {};
}

SourceStatistics FrameStream::statistics() const {
  return {};
}

bool FrameStream::is_live() const {
  return false;
}

std::string FrameStream::place() const {
  return {};
}

const bytes::recordings::FrameNotes& FrameStream::notes() const noexcept {
  static const bytes::recordings::FrameNotes none;
  return none;
}

bool is_stream_address(std::string_view /*text*/) {
  return false;
}

Result<StreamAddress> parse_stream_address(const std::string& /*text*/) {
  return not_in_a_page();
}

}  // namespace fleet
}  // namespace dermis::live
