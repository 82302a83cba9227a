// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "random_layout.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <variant>

namespace dermis::bytes {
namespace {

using layouts::Layout;
using Bytes = std::vector<std::uint8_t>;

template <std::size_t Size>
std::string one_of(Random& random, const std::array<std::string_view, Size>& words) {
  return std::string(words[random.below(Size)]);
}

bool with(Random& random, std::size_t percent) {
  return random.below(100) < percent;
}

std::string quoted(const std::string& text) {
  return "\"" + text + "\"";
}

std::string mark(Random& random) {
  const std::string byte = one_of<4>(random, {"AA", "00", "55", "FF"});
  std::string text = byte;
  for (std::size_t k = random.below(5); k > 1; --k) text += " " + (with(random, 70) ? byte : std::string("55"));
  return text;
}

std::string number_type(Random& random) {
  return one_of<10>(random, {"u8", "i8", "u16le", "i16be", "u24le", "u32be", "f32le", "f64be", "u12be", "u10le"});
}

std::string checksum(Random& random) {
  static constexpr std::array<std::string_view, 9> kKinds = {
      "sum8", "sum16le", "sum32be", "xor8", "crc8", "crc8-maxim", "crc16le", "crc16-kermit be", "crc32le"};
  return "checksum " + one_of(random, kKinds) + (with(random, 30) ? " from=1" : "") +
         (with(random, 10) ? " init=1D" : "");
}

std::string head_field(Random& random) {
  return one_of<10>(random, {"frame u8", "time_us u32le", "temperature u16be *0.01", "supply u8", "flags u8", "row u8",
                             "first u16le", "count u16le", "length u16le", "skip 3"});
}

std::string packet(Random& random, const std::string& begin) {
  std::string fields = begin.empty() ? "" : quoted(begin) + ",";
  for (std::size_t k = random.below(5); k > 0; --k) fields += quoted(head_field(random)) + ",";
  fields += quoted("values " + number_type(random) + (with(random, 20) ? " x4" : ""));
  if (with(random, 60)) fields += "," + quoted(checksum(random));
  if (with(random, 20)) fields += "," + quoted(mark(random));
  return "[" + fields + "]";
}

std::string packets(Random& random) {
  const std::string begin = with(random, 90) ? mark(random) : "";
  std::string text = "packet = [" + packet(random, begin);
  for (std::size_t k = random.below(3); k > 0; --k)
    text += "," + packet(random, with(random, 70) ? begin : mark(random));
  text += "]\n";
  if (with(random, 20))
    text += "escape = " + quoted(one_of<4>(random, {"cobs", "slip", "7E 7D 20", "5D 5C 00=5C 01=5B 02=5D"})) + "\n";
  return text;
}

std::string line(Random& random) {
  static constexpr std::array<std::string_view, 10> kHeads = {
      "{frame}: ",        "{time_ms},", "{time_us:x} ", "T {temperature} ", "row {row} ",
      "{row-1},{col-1},", "{first} ",   "{skip}a: ",    "{clock} ",         "{flags};"};
  std::string text;
  for (std::size_t k = random.below(4); k > 0; --k) text += one_of(random, kHeads);
  return quoted(text + one_of<4>(random, {"{values}", "{values x4}", "{value},{value}", "{values} end"}));
}

std::string lines(Random& random) {
  std::string text = "line = [" + line(random);
  for (std::size_t k = random.below(4); k > 0; --k) text += "," + line(random);
  text += "]\n";
  if (with(random, 20)) text += "frame_end = " + quoted(one_of<2>(random, {"", "--"})) + "\n";
  if (with(random, 20)) text += "line_end = " + quoted(one_of<3>(random, {"\\r", ";", "]"})) + "\n";
  if (with(random, 20)) text += "comment = \"#\"\n";
  if (with(random, 20)) text += "separator = " + quoted(one_of<3>(random, {",", "\\t", "::"})) + "\n";
  return text;
}

Bytes words_of(const layouts::PacketLayout& form, Random& random) {
  Bytes words = {0, 0xAA, 0x55, 0xFF, 0xC0, 0x7E, static_cast<std::uint8_t>(random.below(256))};
  for (const auto& packet : form.packets) {
    for (const auto& field : packet) words.insert(words.end(), field.literal.begin(), field.literal.end());
  }
  return words;
}

Bytes words_of(const layouts::TextLayout& /*form*/, Random& /*random*/) {
  constexpr std::string_view kWords = "0123456789 ,;\t\n\r[]()-+.:axeT#\"";
  return {kWords.begin(), kWords.end()};
}

/// The literal bytes of one packet or line after another, with anything between them.
Bytes beginnings(const Layout& layout, Random& random) {
  Bytes bytes;
  if (const auto* const form = std::get_if<layouts::PacketLayout>(&layout.form)) {
    const Bytes& first = form->packets[random.below(form->packets.size())].front().literal;
    bytes = first;
  } else {
    const auto& fields = std::get<layouts::TextLayout>(layout.form).lines.front();
    for (const auto& field : fields) {
      for (const char c : field.literal) bytes.push_back(static_cast<std::uint8_t>(c));
      bytes.push_back(static_cast<std::uint8_t>('0' + random.below(10)));
    }
    if (with(random, 50)) bytes.push_back('\n');
  }
  return bytes;
}

}  // namespace

std::string random_layout(Random& random) {
  constexpr std::array<std::size_t, 8> kLines = {1, 2, 3, 8, 16, 32, 64, 512};
  const auto lines_of = [&] { return std::to_string(kLines[random.below(kLines.size())]); };
  std::string text = "[layout]\nrows = " + lines_of() + "\ncols = " + lines_of() + "\n";
  text += with(random, 70) ? packets(random) : lines(random);
  if (with(random, 10)) text += "scale = 2.0\nabsent = [[0, 3]]\n";
  return text;
}

std::vector<std::uint8_t> hard_bytes(const Layout& layout, std::size_t size, Random& random) {
  const Bytes words = std::visit([&](const auto& form) { return words_of(form, random); }, layout.form);
  Bytes bytes;
  while (bytes.size() < size) {
    const std::size_t run = 1 + random.below(std::size_t{1} << random.below(17));
    switch (random.below(5)) {
      case 0: bytes.insert(bytes.end(), run, words[random.below(words.size())]); break;
      case 1: std::generate_n(std::back_inserter(bytes), run, [&] { return words[random.below(words.size())]; }); break;
      case 2:
        std::generate_n(std::back_inserter(bytes), run % 64, [&] { return static_cast<std::uint8_t>(random.bits()); });
        break;
      default: {
        const Bytes piece = beginnings(layout, random);
        for (std::size_t k = 0; k < run && bytes.size() < size; k += piece.size() + 1) {
          bytes.insert(bytes.end(), piece.begin(), piece.end());
          if (with(random, 30) || piece.empty()) bytes.push_back(words[random.below(words.size())]);
        }
      }
    }
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace dermis::bytes
