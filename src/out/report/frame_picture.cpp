// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/frame_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "dermis/bytes/system/plugin.hpp"
#include "out/report/brush.hpp"
#include "out/report/picture_plugin.hpp"

namespace dermis::out::report {
namespace {

constexpr double kMargin = 20.0;
constexpr double kTop = 74.0;
constexpr double kLeft = 44.0;
constexpr double kLargestSide = 400.0;     // Of the array.
constexpr double kLeastHeight = 120.0;     // So that the scale can be read.
constexpr double kGap = 0.5;               // Between taxels,
constexpr double kLeastCellWithGap = 6.0;  // where they are large.
constexpr double kBarGap = 22.0;
constexpr double kBarWidth = 14.0;
constexpr double kBarLabels = 64.0;
constexpr std::size_t kBarSteps = 100;
constexpr std::size_t kMostTicks = 8;
constexpr double kLeastWidth = 340.0;

constexpr Colour kPaper{255, 255, 255};
constexpr Colour kInk{32, 33, 36};
constexpr Colour kMuted{110, 113, 120};
constexpr Colour kNothing{226, 227, 230};

class SvgBrush final : public Brush {
 public:
  void fill(Point corner, double width, double height, Colour colour) override {
    fmt::format_to(std::back_inserter(elements_),
                   "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" shape-rendering=\"crispEdges\"/>\n",
                   coordinate(corner.x), coordinate(corner.y), coordinate(width), coordinate(height), to_hex(colour));
  }
  void lines(const std::vector<std::vector<Point>>& lines, double width, Colour colour) override {
    std::string data;
    for (const std::vector<Point>& line : lines) {
      for (std::size_t i = 0; i < line.size(); ++i) data += i == 0 ? move_to(line[i]) : line_to(line[i]);
    }
    fmt::format_to(std::back_inserter(elements_),
                   "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\"/>\n", data,
                   to_hex(colour), coordinate(width));
  }
  void text(Anchor anchor, Point place, double size, Colour colour, const std::string& words) override {
    write(anchor, place, size, fmt::format("fill:{}", to_hex(colour)), words);
  }
  void label(Point centre, double size, const std::string& words) override {
    write(Anchor::middle, {centre.x, centre.y + 0.5 * size}, size,
          fmt::format("fill:{};stroke:{};stroke-width:{}px;paint-order:stroke;font-weight:600", to_hex(kMark),
                      to_hex(kMarkEdge), kLabelEdge),
          words);
  }
  [[nodiscard]] std::string take() && { return std::move(elements_); }

 private:
  void write(Anchor anchor, Point place, double size, const std::string& style, const std::string& words) {
    const char* const anchors[] = {"start", "middle", "end"};
    fmt::format_to(
        std::back_inserter(elements_),
        "<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" style=\"font-family:system-ui,sans-serif;font-size:{}px;{}\""
        ">{}</text>\n",
        coordinate(place.x), coordinate(place.y), anchors[static_cast<std::size_t>(anchor)],
        coordinate(font_size(size)), style, escape_xml(words));
  }

  std::string elements_;
};

class Painter {
 public:
  explicit Painter(const FramePicture& picture) : picture_(picture) {
    assert(picture.rows >= 1 && picture.cols >= 1 && picture.values.size() == picture.rows * picture.cols);
    assert(picture.high > 0.0 && std::isfinite(picture.high));
    assert(picture.places.empty() || picture.places.size() == picture.values.size());
    find_bounds();
    per_metre_ = kLargestSide / std::max(width_m_, height_m_);
    cell_width_ = per_metre_ * picture.col_pitch_m;
    cell_height_ = per_metre_ * picture.row_pitch_m;
  }

  [[nodiscard]] double width() const {
    return std::max(kLeft + array_width() + kBarGap + kBarWidth + kBarLabels, kLeastWidth);
  }
  [[nodiscard]] double height() const { return kTop + bar_height() + kMargin; }

  void paint(Brush& brush) const {
    brush.fill({0.0, 0.0}, width(), height(), kPaper);
    brush.text(Anchor::start, {kMargin, 30.0}, 12.0, kInk, valid_utf8(picture_.title));
    brush.text(Anchor::start, {kMargin, 50.0}, 8.5, kMuted, valid_utf8(picture_.subtitle));
    if (picture_.places.empty()) {
      paint_cells(brush);
      paint_lines(brush);
    } else {
      paint_discs(brush);
    }
    paint_scale(brush);
    for (const Contact& contact : picture_.contacts) {
      if (contact.phase != ContactPhase::release) paint_contact(brush, contact);
    }
  }

 private:
  void find_bounds() {
    width_m_ = static_cast<double>(picture_.cols) * picture_.col_pitch_m;
    height_m_ = static_cast<double>(picture_.rows) * picture_.row_pitch_m;
    if (picture_.places.empty()) return;
    left_m_ = top_m_ = std::numeric_limits<double>::infinity();
    double right_m = -left_m_;
    double bottom_m = -top_m_;
    for (const auto& [x, y, radius] : picture_.places) {
      left_m_ = std::min(left_m_, x - radius);
      right_m = std::max(right_m, x + radius);
      top_m_ = std::min(top_m_, y - radius);
      bottom_m = std::max(bottom_m, y + radius);
    }
    width_m_ = right_m - left_m_;
    height_m_ = bottom_m - top_m_;
  }

  [[nodiscard]] double array_width() const { return per_metre_ * width_m_; }
  [[nodiscard]] double array_height() const { return per_metre_ * height_m_; }

  [[nodiscard]] Point at(double x_m, double y_m) const {
    return {kLeft + per_metre_ * (x_m - left_m_), kTop + per_metre_ * (y_m - top_m_)};
  }

  /// A dot is a line without a length.
  void paint_discs(Brush& brush) const {
    std::vector<std::vector<Point>> crosses;
    for (std::size_t taxel = 0; taxel < picture_.places.size(); ++taxel) {
      const auto& [x, y, radius_m] = picture_.places[taxel];
      const Point centre = at(x, y);
      const double value = picture_.values[taxel];
      const double width = 2.0 * per_metre_ * radius_m;
      brush.lines({{centre, centre}}, width, kMarkEdge);
      brush.lines({{centre, centre}}, std::max(width - 2.0 * kGap, 0.5 * width),
                  std::isfinite(value) ? sequential_colour(value / picture_.high) : kNothing);
      if (std::isfinite(value)) continue;
      const double reach = 0.35 * width;
      crosses.push_back({{centre.x - reach, centre.y - reach}, {centre.x + reach, centre.y + reach}});
      crosses.push_back({{centre.x - reach, centre.y + reach}, {centre.x + reach, centre.y - reach}});
    }
    if (!crosses.empty()) brush.lines(crosses, 1.0, kMuted);
  }

  /// Between the taxels that follow each other where they are in no grid.
  [[nodiscard]] Point centre_of(const Contact& contact) const {
    const double col = contact.position.x / picture_.col_pitch_m;
    const double row = contact.position.y / picture_.row_pitch_m;
    if (picture_.places.empty()) return {kLeft + cell_width_ * (col + 0.5), kTop + cell_height_ * (row + 0.5)};
    const auto last = static_cast<double>(picture_.places.size() - 1);
    const double along = std::clamp(picture_.rows == 1 ? col : row, 0.0, last);
    const FreePlace& before = picture_.places[static_cast<std::size_t>(along)];
    const FreePlace& after = picture_.places[static_cast<std::size_t>(std::ceil(along))];
    const double share = along - std::floor(along);
    return at(std::lerp(before.x, after.x, share), std::lerp(before.y, after.y, share));
  }
  [[nodiscard]] double bar_height() const { return std::max(array_height(), kLeastHeight); }

  void paint_cells(Brush& brush) const {
    std::vector<std::vector<Point>> crosses;
    const double gap = std::min(cell_width_, cell_height_) > kLeastCellWithGap ? kGap : 0.0;
    brush.fill({kLeft, kTop}, array_width(), array_height(), kMarkEdge);
    for (std::size_t row = 0; row < picture_.rows; ++row) {
      for (std::size_t col = 0; col < picture_.cols; ++col) {
        const double value = picture_.values[row * picture_.cols + col];
        const Point corner{kLeft + cell_width_ * static_cast<double>(col),
                           kTop + cell_height_ * static_cast<double>(row)};
        const bool is_known = std::isfinite(value);
        brush.fill(corner, cell_width_ - gap, cell_height_ - gap,
                   is_known ? sequential_colour(value / picture_.high) : kNothing);
        if (is_known) continue;
        const Point far{corner.x + cell_width_, corner.y + cell_height_};
        crosses.push_back({corner, far});
        crosses.push_back({{corner.x, far.y}, {far.x, corner.y}});
      }
    }
    if (!crosses.empty()) brush.lines(crosses, 1.0, kMuted);
  }

  /// Names of the first and the last lines.
  void paint_lines(Brush& brush) const {
    const auto column = [&](std::size_t col) {
      const double x = kLeft + cell_width_ * (static_cast<double>(col) + 0.5);
      brush.text(Anchor::middle, {x, kTop - 5.0}, 7.0, kMuted, "c" + std::to_string(col));
    };
    const auto row = [&](std::size_t line) {
      const double y = kTop + cell_height_ * (static_cast<double>(line) + 0.5);
      brush.text(Anchor::end, {kLeft - 6.0, y + 3.5}, 7.0, kMuted, "r" + std::to_string(line));
    };
    column(0);
    row(0);
    if (array_width() > 60.0 && picture_.cols > 1) column(picture_.cols - 1);
    if (array_height() > 30.0 && picture_.rows > 1) row(picture_.rows - 1);
  }

  void paint_scale(Brush& brush) const {
    const double left = kLeft + array_width() + kBarGap;
    const double step = bar_height() / static_cast<double>(kBarSteps);
    for (std::size_t i = 0; i < kBarSteps; ++i) {
      const double top = kTop + bar_height() - step * static_cast<double>(i + 1);
      const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kBarSteps);
      brush.fill({left, top}, kBarWidth, step, sequential_colour(share));
    }
    brush.text(Anchor::start, {left, kTop - 9.0}, 8.0, kInk, valid_utf8(picture_.unit));  // above the tick at the end
    for (const double tick : linear_ticks(0.0, picture_.high, kMostTicks)) {
      const double y = kTop + bar_height() * (1.0 - tick / picture_.high);
      const double right = left + kBarWidth;
      brush.lines({{{right, y}, {right + 4.0, y}}}, 1.0, kMuted);
      brush.text(Anchor::start, {right + 8.0, y + 4.0}, 8.0, kInk, tick_label(tick));
    }
  }

  /// An ellipse of the area of the contact, long as its pressure is.
  void paint_contact(Brush& brush, const Contact& contact) const {
    const Point centre = centre_of(contact);
    const bool has_axes = contact.minor_axis_m > 0.0 && contact.major_axis_m > 0.0;
    const double ratio = has_axes ? std::min(contact.major_axis_m / contact.minor_axis_m, 4.0) : 1.0;
    const double minor = std::sqrt(contact.area_m2 / std::numbers::pi / ratio) * cell_width_ / picture_.col_pitch_m;
    constexpr int kCorners = 48;
    std::vector<Point> outline;
    for (int i = 0; i <= kCorners; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / kCorners;
      const double along = ratio * minor * std::cos(turn);
      const double across = minor * std::sin(turn);
      outline.push_back({centre.x + along * std::cos(contact.angle_rad) - across * std::sin(contact.angle_rad),
                         centre.y + along * std::sin(contact.angle_rad) + across * std::cos(contact.angle_rad)});
    }
    const std::vector<std::vector<Point>> lines{std::move(outline)};
    brush.lines(lines, 3.2, kMarkEdge);
    brush.lines(lines, 1.6, kMark);
    brush.label(centre, 8.5, fmt::format("{:.3g} N", contact.force_n));
  }

  const FramePicture& picture_;
  double left_m_ = 0.0;  // of the picture, in the plane of the places
  double top_m_ = 0.0;
  double width_m_ = 0.0;
  double height_m_ = 0.0;
  double per_metre_ = 0.0;
  double cell_width_ = 0.0;
  double cell_height_ = 0.0;
};

Result<const PicturePlugin*> load_pictures() {
  const Result<void*> function =
      find_plugin_function({"a .png or .gif", "libdermis_pictures.so",
                            "(Debian: dermis), cairo and giflib (Debian: libcairo2, libgif7), which .svg does not"},
                           kFindPictures);
  if (!function) return function.error();
  const PicturePlugin* found = nullptr;
  reinterpret_cast<FindPictures>(*function)(found);
  return found;
}

/// The colours of the sequential map, and greys.
std::vector<Colour> film_palette() {
  constexpr int kMapColours = 208;
  constexpr int kGreys = 48;
  std::vector<Colour> palette;
  for (int i = 0; i < kMapColours; ++i) palette.push_back(sequential_colour(i / (kMapColours - 1.0)));
  for (int i = 0; i < kGreys; ++i) {
    const auto grey = static_cast<std::uint8_t>(255 * i / (kGreys - 1));
    palette.push_back({grey, grey, grey});
  }
  return palette;
}

}  // namespace

double force_scale(double newtons) {
  double decade = 1.0;
  while (decade < 1e9 && 10.0 * decade <= newtons) decade *= 10.0;
  for (const double step : {1.0, 2.0, 5.0}) {
    if (newtons <= step * decade) return step * decade;
  }
  return 10.0 * decade;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::isfinite(value) ? value : 0.0);
  return largest;
}

Drawing frame_drawing(const FramePicture& picture) {
  const Painter painter(picture);
  SvgBrush brush;
  painter.paint(brush);
  return {painter.width(), painter.height(), picture.title + ", " + picture.subtitle, std::move(brush).take()};
}

Result<std::string> frame_png(const FramePicture& picture) {
  const Result<const PicturePlugin*> plugin = load_pictures();
  if (!plugin) return plugin.error();
  const Painter painter(picture);
  return (*plugin)->png(
      {painter.width(), painter.height(), 1, [&](std::size_t, Brush& brush) { painter.paint(brush); }});
}

Result<std::string> frame_film(std::span<const FramePicture> pictures, std::chrono::milliseconds time) {
  assert(!pictures.empty());
  const Result<const PicturePlugin*> plugin = load_pictures();
  if (!plugin) return plugin.error();
  const std::vector<Painter> painters(pictures.begin(), pictures.end());
  return (*plugin)->gif({painters.front().width(), painters.front().height(), painters.size(),
                         [&](std::size_t k, Brush& brush) { painters[k].paint(brush); }},
                        {time, film_palette()});
}

}  // namespace dermis::out::report
