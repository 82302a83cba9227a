// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_columns.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bytes/proposals/column_names.hpp"
#include "bytes/proposals/tokens.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostLeading = 5;   // numbers before the readings
constexpr std::size_t kMostTrailing = 3;  // behind them
constexpr std::size_t kFewestLines = 4;
constexpr std::size_t kMostRuns = 256;
constexpr std::size_t kManyLines = 12;        // show that a number rises by no chance
constexpr std::size_t kMostRising = 3;        // beside the readings
constexpr std::size_t kEnoughToFlicker = 20;  // lines after which a measured fraction has changed
constexpr double kSince1970 = 1e9;            // seconds

/// The word before a number: "temp" of `,"temp":`.
std::string label_of(std::string_view text) {
  const std::size_t from = text.find_last_of(",;{|");
  return std::string(text.substr(from == std::string_view::npos ? 0 : from + 1));
}

class ColumnReader {
 public:
  ColumnReader(const std::vector<Line>& lines, const LineGroup& group, const Numerals& numerals, bool is_head)
      : lines_(lines), group_(group), is_head_(is_head) {
    find_runs(numerals);
    if (!columns_.empty() && columns_.back().run >= kMostRuns) columns_.clear();
    name_columns();
    read_series();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (is_beside_readings(k)) columns_[k].series = all_series_[k];
    }
  }

  std::vector<Column> read() {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      Column& column = columns_[k];
      if (column.kind == Token::Kind::clock) give(column, "clock", "time of day");
      if (column.kind == Token::Kind::datetime) give(column, "datetime", "date and time");
      if (k + 1 < columns_.size()) read_time_of_two(column, columns_[k + 1], k);
      if (column.field.empty() && !column.series.empty() && !has_sisters(k)) read_name(column);
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (is_leading(k)) read_course(columns_[k], true);
    }
    for (std::size_t k = columns_.size(); k-- > 0;) {
      if (is_trailing(k) && run_size(k) > 1) read_course(columns_[k], false);
    }
    read_rising();
    return std::move(columns_);
  }

 private:
  void find_runs(const Numerals& numerals) {
    const std::vector<Token>& tokens = lines_[group_.members.front()].tokens;
    std::string_view before;
    for (std::size_t k = 0; k < tokens.size(); ++k) {
      if (tokens[k].kind == Token::Kind::text) {
        before = tokens[k].text;
        continue;
      }
      const bool follows_number = !columns_.empty() && tokens[k].kind == Token::Kind::number &&
                                  columns_.back().kind == Token::Kind::number && is_separator(before, numerals);
      const bool is_glued = k > 1 && is_part_of_word(tokens, k - 2);
      const std::size_t run = columns_.empty() ? 0 : columns_.back().run + (follows_number && !is_glued ? 0 : 1);
      std::string separator(follows_number ? before : std::string_view());
      std::erase(separator, ' ');
      columns_.push_back({.kind = tokens[k].kind,
                          .run = run,
                          .label = follows_number ? "" : label_of(before),
                          .before = std::move(separator),
                          .field = tokens[k].has_mark ? "skip" : ""});
      before = {};
    }
  }

  void name_columns() {
    const std::vector<std::string> names = names_of_columns(lines_, group_.members.front());
    for (std::size_t k = 0; k < std::min(names.size(), columns_.size()); ++k) columns_[k].name = names[k];
  }

  [[nodiscard]] std::size_t run_size(std::size_t k) const {
    return static_cast<std::size_t>(
        std::count_if(columns_.begin(), columns_.end(), [&](const Column& one) { return one.run == columns_[k].run; }));
  }
  [[nodiscard]] std::size_t place_in_run(std::size_t k) const {
    std::size_t place = 0;
    while (k > place && columns_[k - place - 1].run == columns_[k].run) ++place;
    return place;
  }
  [[nodiscard]] bool is_beside_readings(std::size_t k) const {
    if (columns_[k].kind != Token::Kind::number) return false;
    const bool is_near_begin = k < kMostLeading || columns_[k - kMostLeading].run != columns_[k].run;
    const bool is_near_end = k + kMostTrailing >= columns_.size() || columns_[k + kMostTrailing].run != columns_[k].run;
    return is_near_begin || is_near_end;
  }

  /// Columns beside it have the same name but for a number, as those of readings do.
  [[nodiscard]] bool has_sisters(std::size_t k) const {
    const std::string stem = stem_of(columns_[k].name);
    const auto is_sister = [&](std::size_t other) {
      return other < columns_.size() && columns_[other].run == columns_[k].run && !columns_[other].name.empty() &&
             stem_of(columns_[other].name) == stem;
    };
    return !columns_[k].name.empty() && (is_sister(k + 1) || is_sister(k - 1));
  }

  void read_series() {
    all_series_.resize(columns_.size());
    for (const std::size_t member : group_.members) {
      std::size_t column = 0;
      for (const Token& token : lines_[member].tokens) {
        if (token.kind == Token::Kind::text) continue;
        if (column < columns_.size()) all_series_[column].push_back(token.value);
        ++column;
      }
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Series& series = all_series_[k];
      const auto is_broken = [](double value) { return value != std::floor(value) && std::isfinite(value); };
      const auto is_below_0 = [](double value) { return value < 0.0; };
      columns_[k].varies = std::ranges::any_of(series, [&](double value) { return value != series.front(); });
      columns_[k].has_fractions = std::ranges::any_of(series, is_broken);
      columns_[k].has_signs = columns_[k].has_fractions && std::ranges::any_of(series, is_below_0);
    }
  }

  [[nodiscard]] bool is_given(const std::string& field) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const Column& one) { return one.field == field; });
  }
  [[nodiscard]] bool has_time() const {
    return std::any_of(columns_.begin(), columns_.end(), [](const Column& one) {
      return one.field.starts_with("time") || one.field == "clock" || one.field == "datetime";
    });
  }

  void give(Column& column, const std::string& field, const std::string& what) {
    const bool is_second =
        field.starts_with("time") || field == "clock" || field == "datetime" ? has_time() : is_given(field);
    if (is_second && field != "cycle" && field != "turn") {
      column.field = "skip";
      return;
    }
    column.field = field;
    column.reason = what;
  }

  static const std::string& name_of(const Column& column) { return column.name.empty() ? column.label : column.name; }

  /// Whole seconds, and the rest in a smaller unit, in either order: "secs" and "nsecs".
  void read_time_of_two(Column& one, Column& other, std::size_t k) {
    if (!one.field.empty() || one.kind != Token::Kind::number || other.kind != Token::Kind::number || has_time())
      return;
    double unit = time_unit_of_name(name_of(one));
    double next_unit = time_unit_of_name(name_of(other));
    const bool is_unnamed = one.name.empty() && other.name.empty() && one.run == other.run;
    if (is_unnamed && all_series_[k].front() > kSince1970 && all_series_[k].front() < 4.0 * kSince1970) {
      unit = 1.0;
      next_unit = smallest_unit_of(all_series_[k + 1]);
    }
    if (std::max(unit, next_unit) != 1.0 || std::min(unit, next_unit) == 0.0 || unit == next_unit) return;
    const Series& seconds = all_series_[unit == 1.0 ? k : k + 1];
    const Series& rest = all_series_[unit == 1.0 ? k + 1 : k];
    Series both;
    for (std::size_t i = 0; i < std::min(seconds.size(), rest.size()); ++i) {
      const double part = rest[i] * std::min(unit, next_unit);
      if (seconds[i] != std::floor(seconds[i]) || !(part >= 0.0 && part < 1.0)) return;
      both.push_back(seconds[i] - seconds.front() + part);
    }
    if (both.size() < 2 || both.back() < both.front() || (both.size() > 4 && !is_time(both, 0.0))) return;
    one.reason = "two numbers of each line are one time, in seconds and the rest of one";
    one.field = field_of_unit(unit);
    other.field = field_of_unit(next_unit);
  }

  static const char* field_of_unit(double unit) {
    return unit == 1.0 ? "time_s" : unit == 1e-3 ? "time_ms" : unit == 1e-6 ? "time_us" : "time_ns";
  }

  /// In which a part of a second is less than one; 0 where it is none.
  static double smallest_unit_of(const Series& series) {
    const double most = *std::max_element(series.begin(), series.end());
    if (!(most >= 1e3 && most < 1e9)) return 0.0;
    return most < 1e6 ? 1e-6 : 1e-9;
  }

  /// Values that rise from line to line are no readings, wherever they stand; unless most rise, as in a press.
  void read_rising() {
    std::vector<std::size_t> rising;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const bool is_open = columns_[k].kind == Token::Kind::number && columns_[k].field.empty();
      if (is_open && rises(all_series_[k])) rising.push_back(k);
    }
    if (rising.size() > kMostRising || 4 * rising.size() > columns_.size()) return;
    for (const std::size_t k : rising) {
      columns_[k].series = all_series_[k];
      read_course(columns_[k], false);
    }
  }

  static bool rises(const Series& series) {
    if (series.size() < kManyLines) return false;
    for (std::size_t i = 1; i < series.size(); ++i) {
      if (!(series[i] > series[i - 1])) return false;
    }
    return is_frame_number(series, 0.0) || is_time(series, 0.0);
  }

  void read_name(Column& column) {
    const std::string& name = name_of(column);
    const std::string field = field_of_name(name);
    const Series& series = column.series;
    const std::string called = "'" + name + "' ";
    if (field.starts_with("time") && is_time(series, 0.0)) {
      give(column, field == "time" ? time_field_of(series, 0.0) : field, called + "grows evenly: it is the time");
    } else if (field == "frame" && (is_frame_number(series, 0.0) || is_time(series, 0.0))) {
      give(column, field, called + "grows: it is the number of the frame");
    } else if ((field == "row" || field == "col") && cycle_of(series)) {
      give(column, "cycle", called + "counts through the same numbers again and again");
      column.is_counted_from_1 = cycle_of(series)->first == 1;
    } else if (field == "array" && !numbers_in_turn(series).empty()) {
      give(column, "turn", "");
    } else if (field == "temperature" || field == "supply" || field == "flags") {
      const bool is_possible = std::all_of(series.begin(), series.end(), [&](double value) {
        return field == "flags" ? value >= 0.0 && value == static_cast<double>(static_cast<std::uint64_t>(value))
                                : value > -60.0 && value < 200.0;
      });
      if (is_possible) give(column, field, called + "is its " + field);
    }
  }

  [[nodiscard]] bool is_leading(std::size_t k) const {
    const Column& column = columns_[k];
    if (column.series.empty() || !column.field.empty() || has_namesake(k)) return false;
    const std::size_t place = place_in_run(k);
    const bool is_last = place + 1 == run_size(k);
    if (place > 0 && columns_[k - 1].field.empty()) return false;
    const bool are_readings_behind = k + 1 < columns_.size();
    return is_head_ || are_readings_behind || !is_last || run_size(k) == 1;
  }

  /// Others stand behind the same words, as the readings of places do.
  [[nodiscard]] bool has_namesake(std::size_t k) const {
    const std::string& label = columns_[k].label;
    return !label.empty() && std::ranges::count(columns_, label, &Column::label) > 1;
  }

  [[nodiscard]] bool is_trailing(std::size_t k) const {
    const Column& column = columns_[k];
    const bool is_last =
        k + 1 == columns_.size() || columns_[k + 1].run != column.run || !columns_[k + 1].field.empty();
    return is_last && !column.series.empty() && column.field.empty() && place_in_run(k) > 1;
  }

  void read_course(Column& column, bool may_cycle) {
    const Series& series = column.series;
    if (series.size() < kFewestLines) return;
    const std::optional<Cycle> cycle = cycle_of(series);
    const std::string which =
        column.label.empty() ? "a number of each line " : "the number behind '" + column.label + "' ";
    if (may_cycle && cycle && cycle->first <= 1) {
      give(column, "cycle", "");
      column.is_counted_from_1 = cycle->first == 1;
    } else if (is_frame_number(series, 0.0)) {
      give(column, "frame", which + "grows by 1: it is the number of the frame");
    } else if (is_time(series, 0.0)) {
      give(column, time_field_of(series, 0.0), which + "grows evenly: it is the time");
    } else if (may_cycle && !numbers_in_turn(series).empty()) {
      give(column, "turn", "");
    }
  }

  const std::vector<Line>& lines_;
  const LineGroup& group_;
  bool is_head_ = false;  // no readings stand in the lines
  std::vector<Column> columns_;
  std::vector<Series> all_series_;
};

}  // namespace

std::vector<Column> columns_of(const std::vector<Line>& lines, const LineGroup& group, const Numerals& numerals,
                               bool is_head) {
  std::vector<Column> columns = ColumnReader(lines, group, numerals, is_head).read();
  const bool stands_still = std::ranges::none_of(columns, &Column::varies);
  const bool has_fractions = std::ranges::any_of(columns, &Column::has_fractions);
  if (!is_head && stands_still && has_fractions && group.members.size() >= kEnoughToFlicker) columns.clear();
  return columns;
}

}  // namespace dermis::bytes::proposals
