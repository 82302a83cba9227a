// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>

#include "dermis/out/report/canvas.hpp"

namespace dermis::out::report {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Bytes of the UTF-8 character at the start of `text`, or 0 where there is none that XML allows.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
  const unsigned first = byte(0);
  if (first < 0x80U) return (first >= 0x20U && first != 0x7FU) || first == '\n' || first == '\t' ? 1 : 0;
  const std::size_t size = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < size) return 0;
  unsigned code = first & (0xFFU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool is_overlong = (size == 3 && code < 0x800U) || (size == 4 && code < 0x10000U);
  const bool is_forbidden = (code >= 0xD800U && code < 0xE000U) || (code & 0xFFFEU) == 0xFFFEU || code > 0x10FFFFU;
  return is_overlong || is_forbidden || code < 0xA0U ? 0 : size;
}

std::string_view entity(char character) {
  switch (character) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    case '\'': return "&#39;";
    default: return {};
  }
}

// The first five colours of the series differ by at least 0.12 in Oklab for normal, deuteranopic, protanopic and
// tritanopic vision (G. M. Machado et al., 2009), and stand out from the background by 3.2:1 or more.
constexpr std::string_view kFigureCss =
    ".fig{font:12.5px/1.2 system-ui,\"Segoe UI\",Helvetica,Arial,\"Liberation Sans\",sans-serif;"
    "font-variant-numeric:tabular-nums}\n"
    ".fig text{fill:#1c2128}\n"
    ".fig .title{font-weight:600}\n"
    ".fig .muted{fill:#59636e}\n"
    ".fig .small{font-size:11px}\n"
    ".fig .middle{text-anchor:middle}\n"
    ".fig .end{text-anchor:end}\n"
    ".fig .frame{fill:none;stroke:#59636e;stroke-width:1}\n"
    ".fig .grid{fill:none;stroke:#e3e7ec;stroke-width:1}\n"
    ".fig .tick{stroke:#59636e;stroke-width:1}\n"
    ".fig .region{fill:#1c2128;fill-opacity:.16;stroke:none}\n"
    ".fig .reference{fill:none;stroke:#1c2128;stroke-width:1.4}\n"
    ".fig .curve{fill:none;stroke:currentColor;stroke-width:1.5;stroke-linejoin:round}\n"
    ".fig .mark{fill:currentColor;stroke:none}\n"
    ".fig .whisker{fill:none;stroke:currentColor;stroke-width:1.3}\n"
    ".fig .cloud{fill:none;stroke:currentColor;stroke-width:3.2;stroke-linecap:round;stroke-opacity:.6}\n"
    ".fig .cell{stroke:none;shape-rendering:crispEdges}\n"
    ".fig .nothing{fill:#c9ced6;stroke:none;shape-rendering:crispEdges}\n"
    ".fig .cross{fill:none;stroke:#59636e;stroke-width:1}\n"
    ".fig .facet{stroke:#1c2128;stroke-width:.5;stroke-opacity:.45;stroke-linejoin:round}\n"
    ".fig .link{fill:none;stroke:#a9b1bb;stroke-width:1}\n"
    ".fig .own{fill:none;stroke:currentColor;stroke-width:2.2}\n"
    ".fig .unit{fill:#fff;stroke:#1c2128;stroke-width:1.4}\n"
    ".fig .dots{fill:none;stroke:#59636e;stroke-width:3.4;stroke-linecap:round}\n"
    ".fig .paper{fill:#fff}\n"
    ".fig .s0{color:#0d62ac}.fig .s1{color:#e06f4e}.fig .s2{color:#004729}.fig .s3{color:#af7da3}\n"
    ".fig .s4{color:#746001}.fig .s5{color:#3d8fc4}.fig .s6{color:#6b7280}\n"
    "@media screen and (prefers-color-scheme:dark){\n"
    ".fig text{fill:#e6eaf0}\n"
    ".fig .muted{fill:#9aa5b1}\n"
    ".fig .frame,.fig .tick,.fig .cross{stroke:#8b96a3}\n"
    ".fig .grid{stroke:#2b323b}\n"
    ".fig .region{fill:#e6eaf0;fill-opacity:.22}\n"
    ".fig .reference{stroke:#e6eaf0}\n"
    ".fig .nothing{fill:#4a525c}\n"
    ".fig .link{stroke:#525c68}\n"
    ".fig .unit{fill:#14181d;stroke:#e6eaf0}\n"
    ".fig .dots{stroke:#9aa5b1}\n"
    ".fig .paper{fill:#14181d}\n"
    ".fig .s0{color:#1c98fe}.fig .s1{color:#db450c}.fig .s2{color:#2d8972}.fig .s3{color:#da9bb9}\n"
    ".fig .s4{color:#eade92}.fig .s5{color:#9fd0f2}.fig .s6{color:#aab3bf}\n"
    "}\n";

std::string open_svg(const Drawing& drawing) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"fig\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\" aria-label=\"{2}\">\n",
      coordinate(drawing.width), coordinate(drawing.height), escape_xml(drawing.description));
}

}  // namespace

std::string valid_utf8(std::string_view text) {
  std::string valid;
  while (!text.empty()) {
    const std::size_t size = character_bytes(text);
    valid += size == 0 ? kReplacement : text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return valid;
}

std::string escape_xml(std::string_view text) {
  std::string escaped;
  for (const char character : valid_utf8(text)) {
    const std::string_view name = entity(character);
    if (name.empty()) escaped += character;
    escaped += name;
  }
  return escaped;
}

Drawing side_by_side(std::span<const Drawing> drawings, std::size_t columns) {
  assert(!drawings.empty() && columns >= 1);
  Drawing sheet;
  double top = 0.0;
  for (std::size_t first = 0; first < drawings.size(); first += columns) {
    double left = 0.0;
    double row_height = 0.0;
    for (const Drawing& drawing : drawings.subspan(first, std::min(columns, drawings.size() - first))) {
      fmt::format_to(std::back_inserter(sheet.elements), "<g transform=\"translate({} {})\">\n{}</g>\n",
                     coordinate(left), coordinate(top), drawing.elements);
      if (!sheet.description.empty()) sheet.description += "; ";
      sheet.description += drawing.description;
      left += drawing.width;
      row_height = std::max(row_height, drawing.height);
    }
    sheet.width = std::max(sheet.width, left);
    top += row_height;
  }
  sheet.height = top;
  return sheet;
}

std::string svg_element(const Drawing& drawing) {
  return open_svg(drawing) + drawing.elements + "</svg>\n";
}

std::string svg_document(const Drawing& drawing) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + open_svg(drawing) + "<style>\n" + std::string(figure_css()) +
         "</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n" + drawing.elements + "</svg>\n";
}

std::string_view figure_css() {
  return kFigureCss;
}

}  // namespace dermis::out::report
