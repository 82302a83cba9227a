// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bytes/formats/imported_frame.hpp"
#include "bytes/formats/text_lines.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::string_view kPicture = "Pict-No.:";
constexpr std::string_view kForce = "Force";
constexpr std::size_t kCellWidth = 8;  // of tables without tabs

/// The cells of a line of a table: between tabs, or 8 characters each.
std::vector<std::string_view> cells_of(std::string_view line) {
  const bool has_tabs = line.find('\t') != std::string_view::npos;
  std::vector<std::string_view> cells;
  while (!line.empty() && cells.size() <= kMaxLines + 2) {
    const std::size_t end = std::min(has_tabs ? line.find('\t') : kCellWidth, line.size());
    cells.push_back(files::trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(end + (has_tabs ? 1 : 0), line.size()));
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells;
}

/// A number of a row or column, from 1.
std::optional<std::size_t> line_number(std::string_view text) {
  std::size_t number = 0;
  if (!files::parse_number(text, number) || number < 1 || number > kMaxLines) return std::nullopt;
  return number;
}

/// A value of a table, rows and columns from 0.
struct Value {
  std::size_t row = 0;
  std::size_t col = 0;
  float kilopascals = 0.0F;
};

/// Walks through the tables of a listing.
class Listing {
 public:
  Listing(std::unique_ptr<std::istream> in, const std::string& name) : lines_(std::move(in), name) {}

  [[nodiscard]] const TextLines& lines() const { return lines_; }
  /// Within whose pages the text ended before the end of a line; empty outside of pages with a table.
  [[nodiscard]] std::optional<std::size_t> cut_picture() const { return lines_.was_cut() ? picture_ : std::nullopt; }
  [[nodiscard]] std::optional<double> seconds_per_picture() const { return seconds_per_picture_; }

  /// The next values, all of one line; `picture` is the number of theirs. False at the end.
  Result<bool> next(std::size_t& picture, std::vector<Value>& values) {
    while (true) {
      std::string_view line;
      Result<bool> more = lines_.next(line);
      if (!more || !*more) return more;
      read_heading(line);
      if (!picture_) continue;
      if (columns_.empty()) {
        read_columns(line);
        continue;
      }
      Result<bool> is_row = read_row(line, values);
      if (!is_row) return is_row;
      if (!*is_row) continue;
      picture = *picture_;
      return true;
    }
  }

  Status rewind() {
    picture_.reset();
    columns_.clear();
    return lines_.rewind();
  }

 private:
  void read_heading(std::string_view line) {
    if (const std::size_t at = line.find(kPicture); at != std::string_view::npos) {
      Cells cells(line.substr(at + kPicture.size()), Cells::Separator::any);
      std::string_view word;
      std::size_t number = 0;
      picture_.reset();
      columns_.clear();
      if (cells.next_filled(word) && files::parse_number(word, number)) picture_ = number;
    }
    constexpr std::string_view kPerPicture = "picture:";
    const std::size_t at = line.find(kPerPicture);
    if (at == std::string_view::npos || line.find("Time") == std::string_view::npos) return;
    Cells cells(line.substr(at + kPerPicture.size()), Cells::Separator::any);
    std::string_view number;
    std::string_view unit;
    double time = 0.0;
    if (!cells.next_filled(number) || !cells.next_filled(unit) || !files::parse_number(number, time) || !(time > 0.0))
      return;
    seconds_per_picture_ = unit.find("ms") != std::string_view::npos ? 1e-3 * time : time;
  }

  /// The line above a table: an empty cell, then the numbers of the columns.
  void read_columns(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    for (std::size_t i = 1; i < cells.size() && cells[i] != kForce; ++i) {
      const std::optional<std::size_t> number = line_number(cells[i]);
      if (!number) return columns_.clear();
      columns_.push_back(*number - 1);
    }
  }

  /// False where the line is none, and ends the table.
  Result<bool> read_row(std::string_view line, std::vector<Value>& values) {
    values.clear();
    const std::vector<std::string_view> cells = cells_of(line);
    const std::optional<std::size_t> row = cells.empty() ? std::nullopt : line_number(cells[0]);
    if (!row) {
      picture_.reset();
      return false;
    }
    for (std::size_t i = 0; i < columns_.size() && i + 1 < cells.size(); ++i) {
      Value value{*row - 1, columns_[i]};
      if (cells[i + 1].empty()) continue;
      if (!files::parse_number(cells[i + 1], value.kilopascals)) {
        return lines_.error(files::in_quotes(cells[i + 1]) + " is not a number");
      }
      values.push_back(value);
    }
    return true;
  }

  TextLines lines_;
  std::optional<double> seconds_per_picture_;
  std::optional<std::size_t> picture_;  ///< Whose table is read; empty outside of pages with one.
  std::vector<std::size_t> columns_;    ///< Numbers of those of the table, from 0.
};

class NovelLst final : public FrameSource {
 public:
  NovelLst(std::unique_ptr<std::istream> in, const std::string& name, const ImportOptions& options)
      : listing_(std::move(in), name), options_(options) {}

  /// Looks through all tables, and begins again.
  Status open() {
    std::size_t last_row = 0;
    std::size_t last_col = 0;
    first_row_ = first_col_ = kMaxLines;
    std::size_t picture = 0;
    while (true) {
      const Result<bool> more = listing_.next(picture, values_);
      if (!more) return more.error();
      if (!*more) break;
      for (const Value& value : values_) {
        first_row_ = std::min(first_row_, value.row);
        first_col_ = std::min(first_col_, value.col);
        last_row = std::max(last_row, value.row);
        last_col = std::max(last_col, value.col);
      }
    }
    if (first_row_ == kMaxLines) return listing_.lines().error("the file ends before its first table of pressures");
    if (!listing_.seconds_per_picture()) return listing_.lines().error("the file does not tell the time per picture");
    if (options_.shape) first_row_ = first_col_ = 0;
    shape_ = options_.shape.value_or(FrameShape{last_row - first_row_ + 1, last_col - first_col_ + 1});
    if (last_row >= first_row_ + shape_.rows || last_col >= first_col_ + shape_.cols) {
      return check_shape(listing_.lines().name(), {last_row + 1, last_col + 1}, options_.shape);
    }
    if (Status begun = listing_.rewind(); !begun) return begun;
    return read_line();
  }

  Result<bool> next(RawFrame& frame) override {
    if (is_at_end_) return false;
    const std::size_t picture = picture_;
    const Result<Nanos> time = time_of(picture);
    if (!time) return time.error();
    begin_frame(frame, *time);
    frame.acquisition.sequence = picture;
    frame.counts.assign(shape_.taxel_count(), 0.0F);
    while (!is_at_end_ && picture_ == picture) {
      for (const Value& value : values_) {
        frame.counts[(value.row - first_row_) * shape_.cols + value.col - first_col_] = value.kilopascals;
      }
      if (const Status read = read_line(); !read) return read.error();
    }
    const std::optional<std::size_t> cut = is_at_end_ ? listing_.cut_picture() : std::nullopt;
    if (cut == picture && frames_ > 0) {
      tell_cut(options_, listing_.lines().place(), frames_);
      return false;
    }
    ++frames_;
    last_picture_ = picture;
    if (cut && cut != picture) tell_cut(options_, listing_.lines().place(), frames_);
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] std::string place() const override { return listing_.lines().place(); }

 private:
  [[nodiscard]] Result<Nanos> time_of(std::size_t picture) const {
    const std::string name = "picture " + std::to_string(picture);
    if (picture < last_picture_) {
      return listing_.lines().error(name + " follows picture " + std::to_string(last_picture_));
    }
    const std::optional<Nanos> time =
        files::nanos_from_seconds(static_cast<double>(picture) * *listing_.seconds_per_picture());
    if (!time) return listing_.lines().error(name + " would be later than 9e9 seconds, by the time per picture");
    return *time;
  }

  Status read_line() {
    const Result<bool> more = listing_.next(picture_, values_);
    if (!more) return more.error();
    is_at_end_ = !*more;
    return Done{};
  }

  Listing listing_;
  ImportOptions options_;
  FrameShape shape_;
  std::size_t first_row_ = 0;  ///< Of the platform, in the frames.
  std::size_t first_col_ = 0;
  std::vector<Value> values_;  ///< Of the line that comes next,
  std::size_t picture_ = 0;    ///< and its picture.
  std::size_t last_picture_ = 0;
  bool is_at_end_ = false;
  std::size_t frames_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_novel_lst(std::unique_ptr<std::istream> in, const std::string& name,
                                                    const ImportOptions& options) {
  return open_as<NovelLst>(std::move(in), name, options);
}

}  // namespace dermis::bytes::formats
