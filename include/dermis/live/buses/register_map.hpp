// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::buses {

/// How a reading stands in the registers.
enum class RegisterValue { u16, i16, u32, i32, f32 };

/// An array whose readings stand in registers, one behind the other.
struct RegisterArray {
  std::string name;
  FrameShape shape{};
  std::uint16_t address = 0;
  RegisterValue value = RegisterValue::u16;
  bool low_word_first = false;  ///< Of readings of two words.
  bool by_columns = false;      ///< Column by column instead of row by row.
  bool last_row_first = false;
  double scale = 1.0;  ///< A reading is scale * number + offset.
  double offset = 0.0;

  [[nodiscard]] std::size_t words() const noexcept {
    return shape.taxel_count() * (value == RegisterValue::u16 || value == RegisterValue::i16 ? 1 : 2);
  }
};

/// The registers of a device, by a description in TOML (docs/hands.md).
struct RegisterMap {
  bool input = false;         ///< Input registers (function 4) instead of holding registers (function 3).
  unsigned address_step = 1;  ///< Addresses from one word to the next; 2 where they count bytes.
  std::uint16_t port = 502;   ///< Modbus TCP uses it where an address names none.
  int unit = 1;
  std::vector<RegisterArray> arrays;
};

/// Words of a read that belong to one array.
struct RegisterPart {
  std::size_t array = 0;        ///< In RegisterMap::arrays.
  std::size_t array_begin = 0;  ///< Word of the array that comes first.
  std::size_t read_begin = 0;   ///< The same word in the read.
  std::size_t words = 0;
};

/// One question to the device.
struct RegisterRead {
  std::uint16_t address = 0;
  std::size_t words = 0;  ///< 1 ... 125
  std::vector<RegisterPart> parts;
};

/// Names of the maps that are known: "dfrobot-sen0704", "inspire-rh56", ...
[[nodiscard]] std::vector<std::string> known_register_maps();

/// The text of a known map; empty: there is none of that name.
[[nodiscard]] std::string_view known_register_map(std::string_view name);

/// A known map by its name, or a file by its path. Errors name the file, the line and the key.
[[nodiscard]] Result<RegisterMap> read_register_map(const std::string& name_or_path);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<RegisterMap> register_map_from_toml(std::string_view text, const std::string& name);

/// Questions that give all words of these arrays. Arrays that follow upon each other share one where they have room.
[[nodiscard]] std::vector<RegisterRead> plan_reads(const RegisterMap& map, std::span<const std::size_t> arrays);

/// Sets the counts of a frame. `words`: all of the array.
void decode_registers(const RegisterArray& array, std::span<const std::uint16_t> words, RawFrame& frame);

}  // namespace dermis::live::buses
