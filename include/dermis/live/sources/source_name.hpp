// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/live/buses/bus_address.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

enum class SourceKind {
  device,      ///< By its URI; also the bytes of a device in a file.
  simulation,  ///< sim:SCENE
  recording,   ///< MCAP, of one or several arrays.
  file,        ///< Any other file of frames, by its path, by file:PATH?rate=... or candump:PATH?map=...
  stream,      ///< nats://HUB?robot=...&array=...
  bus,  ///< modbus-tcp://HOST?map=..., modbus-rtu:///dev/...?map=..., dds://DOMAIN/TOPIC?type=..., can://can0?map=...
};

/// The name of a source, parsed (docs/devices.md). Opens nothing.
struct SourceName {
  std::string text;  ///< As it was given.
  SourceKind kind = SourceKind::file;
  std::string file{};                              ///< Path of the file, recording or bytes; empty: it is none.
  std::string array{};                             ///< "chest" of "rec.mcap#chest"; empty: none is named.
  std::optional<bytes::devices::SourceUri> uri{};  ///< Empty: the name is the path of a file.
  std::optional<fleet::StreamAddress> stream{};    ///< A stream of NATS; empty: it is none.
  std::optional<buses::BusAddress> bus{};          ///< Registers, a topic or CAN; empty: it is none.

  /// Fails on what bytes::devices::parse_source_uri(), fleet::parse_stream_address() or buses::parse_bus_address()
  /// refuses. Everything else is the path of a file.
  [[nodiscard]] static Result<SourceName> parse(const std::string& text);

  /// The files that such a source reads, as far as the name says: of frames, a layout, an array, a map.
  [[nodiscard]] std::vector<std::string> files() const;
  /// "rec.mcap#chest": the file without its folder, as tables name it.
  [[nodiscard]] std::string short_name() const;
  /// Frames come as fast as they are read: to be live, the name must give a rate.
  [[nodiscard]] bool needs_rate() const noexcept;
  /// Times begin at 0 and follow from the rate in the name: they are not those of the readings.
  [[nodiscard]] bool has_times_of_its_own() const noexcept;
  /// It is a topic of DDS, as DDS names it: "rt/chest/frame".
  [[nodiscard]] bool hears(std::uint32_t domain, std::string_view topic) const;
};

}  // namespace dermis::live::sources
