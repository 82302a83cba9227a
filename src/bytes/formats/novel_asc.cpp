// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <optional>
#include <string_view>
#include <utility>

#include "bytes/formats/imported_frame.hpp"
#include "bytes/formats/text_lines.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::string_view kTime = "time[";

class NovelAsc final : public FrameSource {
 public:
  NovelAsc(std::unique_ptr<std::istream> in, const std::string& name, const ImportOptions& options)
      : lines_(std::move(in), name), options_(options) {}

  /// Reads up to the line above the frames.
  Status open() {
    std::string_view line;
    while (true) {
      const Result<bool> more = lines_.next(line);
      if (!more) return more.error();
      if (!*more) return lines_.error("the file ends before a line 'time[secs]' with the numbers of the sensors");
      if (files::trimmed(line).starts_with(kTime)) break;
    }
    seconds_per_unit_ = line.find("[ms") == std::string_view::npos ? 1.0 : 1e-3;
    return choose_shape(sensor_count(line));
  }

  Result<bool> next(RawFrame& frame) override {
    std::string_view line;
    do {
      Result<bool> more = lines_.next(line);
      if (!more || !*more) return more;
    } while (files::trimmed(line).empty());
    if (lines_.was_cut()) {
      tell_cut(options_, lines_.place(), frames_);
      return false;
    }
    const Result<Nanos> time = take_time(line);
    if (!time) return time.error();
    begin_frame(frame, *time);
    frame.counts.resize(shape_.taxel_count());
    if (const Status read = parse_row(line, Cells::Separator::any, frame.counts); !read) {
      return lines_.error(read.error().message);
    }
    ++frames_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] std::string place() const override { return lines_.place(); }

 private:
  /// The cells after the time.
  static std::size_t sensor_count(std::string_view line) {
    Cells cells(line, Cells::Separator::any);
    std::string_view cell;
    std::size_t count = 0;
    while (cells.next_filled(cell)) ++count;
    return count - 1;
  }

  /// Leaves the readings in the line.
  [[nodiscard]] Result<Nanos> take_time(std::string_view& line) const {
    Cells cells(line, Cells::Separator::any);
    std::string_view cell;
    double units = 0.0;
    if (!cells.next_filled(cell) || !files::parse_number(cell, units)) return lines_.error("begins with no time");
    line.remove_prefix(static_cast<std::size_t>(cell.data() - line.data()) + cell.size());
    if (const std::size_t separator = line.find_first_not_of(' '); separator != std::string_view::npos) {
      line.remove_prefix(separator + (line[separator] == '\t' || line[separator] == ';' ? 1 : 0));
    }
    const std::optional<Nanos> time = files::nanos_from_seconds(seconds_per_unit_ * units);
    if (!time) return lines_.error("a frame has no time; at most 9e9 seconds are expected");
    return *time;
  }

  Status choose_shape(std::size_t sensors) {
    shape_ = options_.shape.value_or(FrameShape{1, sensors});
    if (sensors > 0 && shape_.taxel_count() == sensors) return check_shape(lines_.name(), shape_, options_.shape);
    return check_shape(lines_.name(), {1, sensors}, options_.shape);
  }

  TextLines lines_;
  ImportOptions options_;
  double seconds_per_unit_ = 1.0;
  FrameShape shape_;
  std::size_t frames_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_novel_asc(std::unique_ptr<std::istream> in, const std::string& name,
                                                    const ImportOptions& options) {
  return open_as<NovelAsc>(std::move(in), name, options);
}

}  // namespace dermis::bytes::formats
