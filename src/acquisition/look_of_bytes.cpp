// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "acquisition/look_of_bytes.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string_view>

namespace dermis::acquisition {
namespace {

constexpr double kShareOfText = 0.95;
constexpr std::size_t kMostLetters = 40;  // of a line that is shown

bool is_text(std::uint8_t byte) {
  return std::isprint(byte) != 0 || byte == '\t' || byte == '\r' || byte == '\n';
}

/// How many numbers a line has; 0 where it holds anything else.
std::size_t numbers_in(std::string_view line) {
  constexpr std::string_view kDividers = ",; \t";
  std::size_t numbers = 0;
  bool is_inside = false;
  for (const char letter : line) {
    const bool divides = kDividers.find(letter) != std::string_view::npos;
    if (!divides && std::string_view("0123456789+-.").find(letter) == std::string_view::npos) return 0;
    if (!divides && !is_inside) ++numbers;
    is_inside = !divides;
  }
  return numbers;
}

/// The lines of a text that neither its beginning nor its end cuts.
struct Lines {
  std::size_t all = 0;
  std::size_t of_numbers = 0;
  std::size_t least = 0;  // numbers in one of these
  std::size_t most = 0;
  std::string_view first_other{};  // that is not of numbers

  explicit Lines(std::string_view text) {
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
      add(text.substr(0, text[end == 0 ? 0 : end - 1] == '\r' ? end - 1 : end));
      text.remove_prefix(end + 1);
    }
  }

 private:
  void add(std::string_view line) {
    if (line.empty()) return;
    ++all;
    const std::size_t numbers = numbers_in(line);
    if (numbers == 0 && first_other.empty()) first_other = line;
    if (numbers == 0) return;
    least = of_numbers == 0 ? numbers : std::min(least, numbers);
    most = std::max(most, numbers);
    ++of_numbers;
  }
};

std::string look_of_text(std::string_view text) {
  const Lines lines(text);
  if (lines.all == 0) return "They are text, but no line of it ends";
  if (2 * lines.of_numbers < lines.all) {
    const std::string_view shown = lines.first_other.substr(0, kMostLetters);
    return "They are text whose lines are not numbers alone, such as '" + std::string(shown) + "'";
  }
  if (lines.most == 1) return "Each line has one number: print a row or a frame in a line";
  if (lines.least == lines.most)
    return "Their lines have " + std::to_string(lines.most) + " numbers: check rows and cols";
  return "Their lines have " + std::to_string(lines.least) + " to " + std::to_string(lines.most) +
         " numbers: print as many in each";
}

}  // namespace

std::string look_of_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return "There is not a single byte";
  const auto is_first = [&](std::uint8_t byte) { return byte == bytes.front(); };
  if (std::ranges::all_of(bytes, is_first)) {
    std::array<char, 8> hex{};
    std::snprintf(hex.data(), hex.size(), "0x%02x", bytes.front());
    return "Each of them is " + std::string(hex.data());
  }
  const auto letters = static_cast<double>(std::ranges::count_if(bytes, is_text));
  if (letters < kShareOfText * static_cast<double>(bytes.size())) {
    return "They are not text, and no frame of a known protocol comes again in them";
  }
  return look_of_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace dermis::acquisition
