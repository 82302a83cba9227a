// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "check_error.hpp"
#include "dermis/live/buses/can_map.hpp"
#include "dermis/live/buses/candump.hpp"

/// A map, and behind a NUL a log that is read by it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace buses = dermis::live::buses;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  const auto map = buses::can_map_from_toml(text.substr(0, end), "map.toml");
  if (!map) dermis::fuzz::check_line(map.error());
  const std::string log(text.substr(std::min(end + 1, text.size())));
  const buses::CanArray usual{
      .name = "a", .shape = {2, 2}, .id = 5, .row = {buses::CanPlace::Kind::byte, 0}, .first = 1};
  for (const buses::CandumpOptions& options : {buses::CandumpOptions{}, {.interface = "", .rate_hz = 100.0}}) {
    const buses::CanArray& array = map ? map->arrays.front() : usual;
    const auto source = buses::open_candump(std::make_unique<std::istringstream>(log), "fuzz", array, options);
    dermis::RawFrame frame;
    while (true) {
      const dermis::Result<bool> more = (*source)->next(frame);
      if (!more) dermis::fuzz::check_error(more.error());
      if (!more || !*more) break;
      if (frame.counts.size() != array.shape.taxel_count()) std::abort();
    }
  }
  return 0;
}
