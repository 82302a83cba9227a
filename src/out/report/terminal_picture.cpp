// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/terminal_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "dermis/out/report/heat_map.hpp"

namespace dermis::out::report {
namespace {

constexpr std::size_t kPanelColumns = 34;
constexpr std::size_t kPanelGap = 2;
constexpr std::size_t kHeadLines = 2;  // Header and colour scale.
constexpr Colour kNothing{70, 70, 74};
constexpr std::string_view kLevels = " .:-=+*#%@";

/// Values on a grid of square pixels.
struct Grid {
  std::size_t rows = 0;
  std::size_t cols = 0;
  std::vector<double> values;
};

/// As many pixels a taxel, or taxels a pixel, as fit.
Grid grid_of(const TerminalPicture& picture, std::size_t most_rows, std::size_t most_cols) {
  const auto [rows, cols] = picture.shape;
  const std::size_t times = std::min(most_rows / rows, most_cols / cols);
  Grid grid;
  if (times >= 1) {
    grid = {rows * times, cols * times, {}};
  } else {
    const std::size_t least_rows = std::max<std::size_t>(most_rows, 1);
    const std::size_t least_cols = std::max<std::size_t>(most_cols, 1);
    const std::size_t taxels = std::max((rows + least_rows - 1) / least_rows, (cols + least_cols - 1) / least_cols);
    grid = {(rows + taxels - 1) / taxels, (cols + taxels - 1) / taxels, {}};
  }
  grid.values.assign(grid.rows * grid.cols, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t y = 0; y < std::max(grid.rows, rows); ++y) {
    for (std::size_t x = 0; x < std::max(grid.cols, cols); ++x) {
      const double value = picture.values[(times >= 1 ? y / times : y) * cols + (times >= 1 ? x / times : x)];
      const std::size_t row = times >= 1 ? y : y * grid.rows / rows;
      const std::size_t col = times >= 1 ? x : x * grid.cols / cols;
      double& pixel = grid.values[row * grid.cols + col];
      pixel = std::isnan(pixel) ? value : std::max(pixel, std::isnan(value) ? pixel : value);
    }
  }
  return grid;
}

/// Collects a line; colours are only said where they change.
class Line {
 public:
  Line(TerminalColours colours, std::size_t most_columns) : colours_(colours), most_columns_(most_columns) {}

  void text(std::string_view words) {
    reset();
    const std::size_t fitting = std::min(words.size(), most_columns_ - width_);
    text_ += words.substr(0, fitting);
    width_ += fitting;
  }
  void go_to(std::size_t column) {
    reset();
    if (column > width_) text_.append(column - width_, ' ');
    width_ = std::max(width_, column);
  }
  /// A block with an upper and a lower half.
  void halves(Colour upper, Colour lower) {
    if (width_ == most_columns_) return;
    set("38", code(upper), foreground_);
    set("48", code(lower), background_);
    text_ += "\u2580";
    ++width_;
  }
  [[nodiscard]] std::string finished() && {
    reset();
    return std::move(text_) + "\x1b[K";
  }

 private:
  [[nodiscard]] std::string code(Colour colour) const {
    if (colours_ == TerminalColours::rgb) return fmt::format("2;{};{};{}", colour.red, colour.green, colour.blue);
    const auto level = [](std::uint8_t part) { return (static_cast<unsigned>(part) * 5U + 127U) / 255U; };
    return fmt::format("5;{}", 16U + 36U * level(colour.red) + 6U * level(colour.green) + level(colour.blue));
  }
  void set(const char* what, std::string code, std::string& present) {
    if (code == present) return;
    text_ += fmt::format("\x1b[{};{}m", what, code);
    present = std::move(code);
  }
  void reset() {
    if (foreground_.empty() && background_.empty()) return;
    text_ += "\x1b[0m";
    foreground_.clear();
    background_.clear();
  }

  TerminalColours colours_;
  std::size_t most_columns_;
  std::string text_;
  std::size_t width_ = 0;
  std::string foreground_;
  std::string background_;
};

class Screen {
 public:
  Screen(const TerminalPicture& picture, const TerminalSize& size, TerminalColours colours)
      : picture_(picture), size_(size), colours_(colours) {
    const bool has_panel = picture.has_contacts && size.columns >= kPanelColumns + kPanelGap + picture.shape.cols;
    const std::size_t columns = size.columns - (has_panel ? kPanelColumns + kPanelGap : 0);
    const std::size_t lines = size.lines > kHeadLines ? size.lines - kHeadLines : 0;
    const bool has_colours = colours != TerminalColours::without;
    grid_ = grid_of(picture, has_colours ? 2 * lines : lines, has_colours ? columns : columns / 2);
    panel_column_ = has_panel ? (has_colours ? grid_.cols : 2 * grid_.cols) + kPanelGap : size.columns;
  }

  std::string paint() {
    std::string text = header();
    if (size_.lines >= kHeadLines) text += "\r\n" + scale();
    const std::vector<std::string> panel = panel_lines();
    for (std::size_t line = 0; line + kHeadLines < size_.lines; ++line) {
      Line painted(colours_, size_.columns);
      paint_taxels(line, painted);
      if (line < panel.size() && panel_column_ < size_.columns) {
        painted.go_to(panel_column_);
        painted.text(panel[line]);
      }
      text += "\r\n" + std::move(painted).finished();
    }
    return text;
  }

 private:
  std::string header() const {
    Line line(colours_, size_.columns);
    const SourceStatistics& statistics = picture_.statistics;
    std::string words =
        fmt::format("{}  {}x{}  {:.1f} frames/s  {} lost  {} damaged", picture_.name, picture_.shape.rows,
                    picture_.shape.cols, statistics.rate_hz, statistics.lost_frames, statistics.damaged_frames);
    if (picture_.has_ended) words += "  ended";
    line.text(words);
    return std::move(line).finished();
  }

  std::string scale() const {
    constexpr std::size_t kSteps = 20;
    Line line(colours_, size_.columns);
    line.text("0 ");
    for (std::size_t i = 0; i < kSteps; ++i) {
      const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kSteps);
      paint_pixel(share * picture_.high, share * picture_.high, line);
    }
    line.text(fmt::format(" {:g} {}", picture_.high, picture_.unit));
    return std::move(line).finished();
  }

  void paint_pixel(double upper, double lower, Line& line) const {
    if (colours_ == TerminalColours::without) {
      line.text(std::string(1, letter_of(upper)));
    } else {
      line.halves(colour_of(upper), colour_of(lower));
    }
  }

  [[nodiscard]] Colour colour_of(double value) const {
    return std::isfinite(value) ? sequential_colour(value / picture_.high) : kNothing;
  }

  [[nodiscard]] char letter_of(double value) const {
    if (!std::isfinite(value)) return '?';
    const double level = std::clamp(value / picture_.high, 0.0, 1.0) * static_cast<double>(kLevels.size() - 1);
    return kLevels[static_cast<std::size_t>(std::lround(level))];
  }

  void paint_taxels(std::size_t line, Line& painted) const {
    const bool has_colours = colours_ != TerminalColours::without;
    const std::size_t row = has_colours ? 2 * line : line;
    if (row >= grid_.rows) return;
    for (std::size_t col = 0; col < grid_.cols; ++col) {
      const double upper = grid_.values[row * grid_.cols + col];
      const bool has_lower = row + 1 < grid_.rows;
      paint_pixel(upper, has_lower ? grid_.values[(row + 1) * grid_.cols + col] : 0.0, painted);
      if (!has_colours) paint_pixel(upper, upper, painted);
    }
  }

  [[nodiscard]] std::vector<std::string> panel_lines() const {
    std::vector<std::string> lines;
    lines.push_back(fmt::format("total {:7.2f} N", picture_.report.total_force_n));
    lines.emplace_back();
    for (const Contact& contact : picture_.report.contacts) {
      if (contact.phase == ContactPhase::release) continue;
      lines.push_back(fmt::format("#{:<4} {:7.2f} N  {:6.1f} {:6.1f} mm", contact.id, contact.force_n,
                                  1e3 * contact.position.x, 1e3 * contact.position.y));
    }
    return lines;
  }

  const TerminalPicture& picture_;
  TerminalSize size_;
  TerminalColours colours_;
  Grid grid_;
  std::size_t panel_column_ = 0;
};

}  // namespace

std::string terminal_screen(const TerminalPicture& picture, const TerminalSize& size, TerminalColours colours) {
  return Screen(picture, size, colours).paint();
}

}  // namespace dermis::out::report
