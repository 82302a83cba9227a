// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Arrays whose readings come in parts, in frames of a CAN bus (docs/hands.md).
namespace dermis::live::buses {

/// A frame of the bus.
struct CanFrame {
  std::uint32_t id = 0;
  std::vector<std::uint8_t> data{};  ///< At most 64 bytes.
};

/// How a reading stands in the bytes of a frame.
enum class CanValue { u8, i8, u16be, u16le, i16be, i16le, f32be, f32le };

/// Where a number stands in a frame.
struct CanPlace {
  enum class Kind { nowhere, byte, high_nibble, low_nibble, identifier };
  Kind kind = Kind::nowhere;
  std::size_t byte = 0;
};

/// Many members: the keys of its table.
struct CanArray {
  std::string name;
  FrameShape shape{};
  std::uint32_t id = 0;                ///< Identifier of its frames; the first one where it counts the parts.
  std::vector<std::uint8_t> begins{};  ///< First bytes of its frames.
  CanPlace part{};                     ///< Where the number of the part stands: each holds `each` readings.
  CanPlace row{};                      ///< Or the row, and
  CanPlace col{};                      ///< the column, of the first reading of the frame.
  std::size_t first = 0;               ///< Byte of the first reading.
  std::size_t each = 0;                ///< Readings of a part; 0: as many as stand in its frame.
  CanValue value = CanValue::u8;
  bool by_columns = false;  ///< Column by column instead of row by row.
  bool last_row_first = false;
  double scale = 1.0;  ///< A reading is scale * number + offset.
  double offset = 0.0;
  std::vector<std::uint8_t> request{};  ///< Data of the frame that asks for the array; empty: it comes unasked.
  std::uint32_t request_id = 0;
};

/// By a description in TOML.
struct CanMap {
  std::vector<CanArray> arrays;
};

/// Names of the maps that are known: "linkerhand-12x6-right", ...
[[nodiscard]] std::vector<std::string> known_can_maps();
/// The text of a known map; empty: there is none of that name.
[[nodiscard]] std::string known_can_map(const std::string& name);

/// A known map by its name, or a file by its path. Errors name the file, the line and the key.
[[nodiscard]] Result<CanMap> read_can_map(const std::string& name_or_path);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<CanMap> can_map_from_toml(std::string_view text, const std::string& name);

/// Puts the parts of one array together. A part that comes again before all have come begins the next frame, and so
/// does the first part directly behind the last one. Not thread-safe.
class CanAssembly {
 public:
  explicit CanAssembly(const CanArray& array);

  enum class Taken {
    nothing,  ///< The frame is none of the array.
    part,
    frame,  ///< The last part: counts() has all.
  };
  [[nodiscard]] Taken take(const CanFrame& frame);

  /// Readings of the last whole frame, row by row.
  [[nodiscard]] const std::vector<float>& counts() const noexcept { return whole_; }
  /// Frames of which parts have not come.
  [[nodiscard]] std::uint32_t incomplete() const noexcept { return incomplete_; }

 private:
  [[nodiscard]] std::optional<std::size_t> first_reading(const CanFrame& frame) const;
  [[nodiscard]] std::size_t readings_in(const CanFrame& frame, std::size_t begin) const;
  [[nodiscard]] std::size_t taxel_of(std::size_t reading) const;

  CanArray array_;
  std::vector<float> counts_;  // by reading, in the order in which they come
  std::vector<bool> has_come_;
  std::size_t missing_;
  std::size_t last_end_ = 0;  // of the part before, in readings
  std::vector<float> whole_;
  std::uint32_t incomplete_ = 0;
};

}  // namespace dermis::live::buses
