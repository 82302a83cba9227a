// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// Pictures and pages. Everything here is pure (text in, text out), deterministic and thread-safe, and no "nan" or
/// "inf" reaches a picture. Lengths are CSS pixels.
namespace dermis::out::report {

/// The text with U+FFFD in place of bytes that are not UTF-8, and of control characters that XML forbids.
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// Text for XML and HTML, in elements and in quoted attributes: valid_utf8(), and & < > " ' are escaped.
[[nodiscard]] std::string escape_xml(std::string_view text);

/// A finished picture. It carries no ids, so that any number of them may share a page.
struct Drawing {
  double width = 0.0;       ///< [px], > 0
  double height = 0.0;      ///< [px], > 0
  std::string description;  ///< Plain text for those who cannot see it.
  std::string elements;     ///< SVG elements inside (0, 0) ... (width, height).
};

/// One drawing of several, filled row by row with `columns` >= 1 in each; at least one drawing.
[[nodiscard]] Drawing side_by_side(std::span<const Drawing> drawings, std::size_t columns);

/// The element for a page that carries figure_css(); it scales with the width of its parent.
[[nodiscard]] std::string svg_element(const Drawing& drawing);

/// A file of its own: style and background included, light and dark.
[[nodiscard]] std::string svg_document(const Drawing& drawing);

/// Style of all drawings: fonts, axes and the colours of the series, for light and dark screens and for print.
[[nodiscard]] std::string_view figure_css();

}  // namespace dermis::out::report
