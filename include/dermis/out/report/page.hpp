// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/out/report/svg.hpp"

namespace dermis::out::report {

/// One numbered figure of a page.
struct Figure {
  std::string file;  ///< "error_vs_force.svg"
  std::string title;
  std::string caption;  ///< Plain text; where there are no panels, why.
  std::vector<Drawing> panels;
  std::size_t columns = 1;  ///< Panels beside each other, where there is room.
};

/// A large number with its name above and remarks below.
struct Tile {
  std::string name;
  std::string value;
  std::string note;
  std::string explanation{};  ///< Where such a number comes from; may be empty.
};

/// A name and what is to be said about it.
using Fact = std::pair<std::string, std::string>;

struct Cell {
  std::string words;
  std::string style;  ///< "best" is bold.
};

struct Row {
  std::optional<std::size_t> series;  ///< Mark of a series of the figures before the name.
  std::string name;
  std::vector<Cell> cells;
};

struct Table {
  /// Stands above neighbouring columns.
  struct Group {
    std::string name;
    std::size_t columns = 1;
  };

  /// "numbers", also "numbers compact" for few columns and "numbers dense" for many rows; or "claims": sentences, which
  /// stand below each other on a narrow screen.
  std::string style = "numbers";
  std::vector<Group> groups;       ///< Groups of the columns after the first; none, or over all of them.
  std::vector<std::string> heads;  ///< The first is that of the names.
  std::vector<Row> rows;
};

/// A page with numbered figures, written from top to bottom. All words are plain text, except that the letter after
/// "\u03c9_" is set as an index. Well-formed as XML, too.
class Page {
 public:
  /// `window` names the page in lists of pages.
  Page(std::string_view window, std::string_view title);

  void heading(std::string_view words);
  /// `style`: "", "muted" or "note".
  void paragraph(std::string_view words, std::string_view style = "");
  void tiles(const std::vector<Tile>& tiles);
  void table(const Table& table);
  /// `style`: "facts" or "facts note".
  void facts(const std::vector<Fact>& facts, std::string_view style = "facts");
  void figure(const Figure& figure);
  /// Figures of one size, beside each other where there is room.
  void figures(const std::vector<Figure>& figures);

  [[nodiscard]] std::string html() &&;

 private:
  void element(std::string_view tag, std::string_view style, std::string_view words);

  std::string html_;
  std::size_t figures_ = 0;
};

}  // namespace dermis::out::report
