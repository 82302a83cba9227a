// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "bytes/formats/imported_frame.hpp"
#include "bytes/formats/text_lines.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::string_view kFrame = "Frame";

/// "ROWS 44" and "ROWS,44": the key, and the first word behind it.
struct Entry {
  std::string_view key;
  std::string_view value;
};

Entry entry_of(std::string_view line) {
  Cells cells(line, Cells::Separator::any);
  Entry entry;
  if (cells.next_filled(entry.key)) static_cast<void>(cells.next_filled(entry.value));
  return entry;
}

class Tekscan final : public FrameSource {
 public:
  Tekscan(std::unique_ptr<std::istream> in, const std::string& name, const ImportOptions& options)
      : lines_(std::move(in), name), options_(options) {}

  /// Reads up to the first frame.
  Status open() {
    while (!frame_number_) {
      std::string_view line;
      const Result<bool> more = lines_.next(line);
      if (!more) return more.error();
      if (!*more) return lines_.error("the file ends before its first frame");
      if (Status read = read_header_line(line); !read) return read;
    }
    for (const auto& [key, size] : {std::pair{"ROWS", shape_.rows}, std::pair{"COLS", shape_.cols}}) {
      if (size == 0) return lines_.error(std::string("there is no ") + key + " above the first frame");
    }
    return check_shape(lines_.name(), shape_, options_.shape);
  }

  Result<bool> next(RawFrame& frame) override {
    if (!frame_number_) return false;
    const Result<Nanos> time = time_of(*frame_number_);
    if (!time) return time.error();
    last_number_ = *frame_number_;
    begin_frame(frame, *time);
    frame.acquisition.sequence = *frame_number_;
    frame.counts.resize(shape_.taxel_count());
    for (std::size_t row = 0; row < shape_.rows; ++row) {
      Result<bool> read = read_row(std::span(frame.counts).subspan(row * shape_.cols, shape_.cols));
      if (!read || !*read) return read;
    }
    for (float& count : frame.counts) count = static_cast<float>(static_cast<double>(count) * factor_);
    ++frames_;
    if (const Status found = find_next_frame(); !found) return found.error();
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] std::string place() const override { return lines_.place(); }

 private:
  Status read_header_line(std::string_view line) {
    const auto [key, value] = entry_of(line);
    bool is_right = true;
    if (key == "ROWS") is_right = files::parse_number(value, shape_.rows);
    if (key == "COLS") is_right = files::parse_number(value, shape_.cols);
    if (key == "SECONDS_PER_FRAME")
      is_right = files::parse_number(value, seconds_per_frame_) && seconds_per_frame_ >= 0.0;
    if (key == "UNITS") return read_unit(line.substr(line.find(key) + key.size()));
    if (key.starts_with(kFrame)) is_right = read_frame_line(key, value);
    if (is_right) return Done{};
    return lines_.error(std::string(key) + " " + files::in_quotes(value) + " is not a number that it can be");
  }

  Status read_unit(std::string_view text) {
    Cells cells(text, Cells::Separator::comma);
    std::string_view unit;
    static_cast<void>(cells.next_filled(unit));
    const std::optional<double> factor = factor_of_unit(unit);
    if (!factor) return lines_.error("UNITS " + files::in_quotes(unit) + " is no unit that is known: " + known_units());
    factor_ = *factor;
    return Done{};
  }

  /// "Frame 7", "Frame: 7".
  bool read_frame_line(std::string_view key, std::string_view value) {
    std::size_t number = 0;
    if (key.substr(kFrame.size()).find_first_not_of(':') != std::string_view::npos) return true;  // another word
    if (!files::parse_number(value, number)) return false;
    frame_number_ = number;
    if (!first_number_) first_number_ = number;
    return true;
  }

  /// False where the text ends within the row.
  Result<bool> read_row(std::span<float> row) {
    std::string_view line;
    const Result<bool> more = lines_.next(line);
    if (!more) return more.error();
    const Status read = *more ? parse_row(line, Cells::Separator::comma, row) : bad_input("");
    if (read && !lines_.ends_in_comma()) return true;
    if (*more && !lines_.was_cut()) return lines_.error(read.error().message);
    tell_cut(options_, lines_.place(), frames_);
    frame_number_.reset();
    return false;
  }

  /// Finds the next of frames that follow each other without a number too little.
  Status find_next_frame() {
    frame_number_.reset();
    while (!frame_number_) {
      std::string_view line;
      const Result<bool> more = lines_.next(line);
      if (!more) return more.error();
      if (!*more) return Done{};
      const auto [key, value] = entry_of(line);
      if (!key.starts_with(kFrame)) continue;
      if (lines_.was_cut()) {
        tell_cut(options_, lines_.place(), frames_);
        return Done{};
      }
      if (read_frame_line(key, value)) continue;
      return lines_.error(files::in_quotes(line) + " has no number");
    }
    return Done{};
  }

  [[nodiscard]] Result<Nanos> time_of(std::size_t number) const {
    const std::string frame = "frame " + std::to_string(number);
    if (number < last_number_) return lines_.error(frame + " follows frame " + std::to_string(last_number_));
    if (number > *first_number_ && seconds_per_frame_ == 0.0)
      return lines_.error(frame + " has no SECONDS_PER_FRAME above it");
    const std::optional<Nanos> time =
        files::nanos_from_seconds(static_cast<double>(number - *first_number_) * seconds_per_frame_);
    if (!time) return lines_.error(frame + " would be later than 9e9 seconds, by its SECONDS_PER_FRAME");
    return *time;
  }

  TextLines lines_;
  ImportOptions options_;
  FrameShape shape_;
  double seconds_per_frame_ = 0.0;
  double factor_ = 1.0;
  std::optional<std::size_t> first_number_;
  std::size_t last_number_ = 0;
  std::optional<std::size_t> frame_number_;  ///< Of the frame that comes next.
  std::size_t frames_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_tekscan(std::unique_ptr<std::istream> in, const std::string& name,
                                                  const ImportOptions& options) {
  return open_as<Tekscan>(std::move(in), name, options);
}

}  // namespace dermis::bytes::formats
