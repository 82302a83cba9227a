// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "bytes/proposals/column_names.hpp"
#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kFewestOfArray = 4;
constexpr std::size_t kFewRows = 3;  // so many are rather arrays in turn
constexpr double kOfChance = 0.3;    // merit of a number that counts by chance
constexpr std::size_t kMostInTurn = 5;
constexpr std::size_t kMostArrays = 16;

std::vector<std::size_t> numbers_in(std::string_view name) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(name[i])) == 0) continue;
    std::size_t& value = numbers.emplace_back();
    if (files::number_at(name.substr(i), value) == 0) value = 0;
    while (i < name.size() && files::is_digit(name[i])) ++i;
  }
  return numbers;
}

std::string without_digits(std::string_view name) {
  std::string text(name);
  std::erase_if(text, [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; });
  return text;
}

/// "r0c0", "r0c1" ... count rows and columns.
std::optional<FrameShape> named_shape(const std::vector<Column>& columns, std::size_t begin, std::size_t end) {
  std::array<std::size_t, 2> first{};
  std::array<std::size_t, 2> last{};
  for (std::size_t k = begin; k < end; ++k) {
    const std::vector<std::size_t> numbers = numbers_in(columns[k].name);
    if (numbers.size() != 2) return std::nullopt;
    if (k == begin) first = {numbers[0], numbers[1]};
    last = {numbers[0], numbers[1]};
  }
  if (last[0] <= first[0] || last[1] < first[1] || last[0] - first[0] > end || last[1] - first[1] > end)
    return std::nullopt;
  const FrameShape shape{last[0] - first[0] + 1, last[1] - first[1] + 1};
  return shape.taxel_count() == end - begin ? std::optional(shape) : std::nullopt;
}

/// Rows in brackets, or with another separator between them than between their readings.
std::optional<FrameShape> parted_shape(const std::vector<Column>& columns, std::size_t begin, std::size_t end) {
  std::size_t cols = 0;
  for (std::size_t k = begin + 1; k < end; ++k) {
    const bool begins_row = columns[k].before != columns[begin + 1].before;
    if (begins_row && cols == 0) cols = k - begin;
    if (cols > 0 && begins_row != ((k - begin) % cols == 0)) return std::nullopt;
  }
  if (cols < 2 || (end - begin) % cols != 0) return std::nullopt;
  return FrameShape{(end - begin) / cols, cols};
}

/// Readings side by side, cut where their names change.
std::vector<Span> spans_of(const std::vector<Column>& columns) {
  std::vector<Span> spans;
  const auto is_reading = [&](std::size_t k) {
    return columns[k].kind == Token::Kind::number && columns[k].field.empty();
  };
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!is_reading(k)) continue;
    const bool goes_on = !spans.empty() && spans.back().end == k && columns[k].run == columns[k - 1].run &&
                         without_digits(columns[k].name) == without_digits(columns[k - 1].name);
    if (!goes_on) {
      const bool is_shared = k + 1 < columns.size() && columns[k + 1].name == columns[k].name;  // a cell of many
      spans.push_back({k, k, is_shared ? columns[k].name : stem_of(columns[k].name)});
    }
    spans.back().end = k + 1;
  }
  for (Span& span : spans) {
    span.shown_shape = parted_shape(columns, span.begin, span.end);
    if (!span.shown_shape) span.shown_shape = named_shape(columns, span.begin, span.end);
  }
  return spans;
}

/// Those that are arrays. Readings beside them are something that nobody has told.
std::vector<Span> arrays_among(std::vector<Span> spans) {
  const auto size = [](const Span& span) { return span.end - span.begin; };
  std::size_t most = 0;
  for (const Span& span : spans) most = std::max(most, size(span));
  if (most == 1) return {spans.back()};
  std::erase_if(spans, [&](const Span& span) {
    return size(span) < most && (size(span) < kFewestOfArray || 8 * size(span) < most);
  });
  return spans;
}

std::size_t changes_in(const Series& series) {
  std::size_t changes = 0;
  for (std::size_t k = 1; k < series.size(); ++k) changes += series[k] != series[k - 1] ? 1 : 0;
  return changes;
}

class Interpreter {
 public:
  explicit Interpreter(const std::vector<Column>& columns) : columns_(columns) {
    base_.spans = spans_of(columns);
    if (base_.spans.empty()) return;
    base_.spans = arrays_among(std::move(base_.spans));
    for (const Column& column : columns) {
      base_.fields.push_back(column.field);
      if (!column.reason.empty() && column.field != "cycle") base_.reasons.push_back(column.reason);
      if (!column.field.empty() && column.field != "skip") base_.merit += 0.02;
    }
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto has = [&](const Span& span) { return k >= span.begin && k < span.end; };
      const bool is_read = std::any_of(base_.spans.begin(), base_.spans.end(), has);
      if (!is_read && base_.fields[k].empty()) base_.fields[k] = "skip";
      if (base_.fields[k] == "cycle" || base_.fields[k] == "turn") counting_.push_back(k);
    }
    std::stable_sort(counting_.begin(), counting_.end(), [&](std::size_t a, std::size_t b) {
      return changes_in(columns_[a].series) < changes_in(columns_[b].series);
    });
  }

  std::vector<LineFields> all() {
    if (base_.spans.empty() || base_.fields.size() != columns_.size()) return {};
    const bool is_taxel = base_.spans.front().end - base_.spans.front().begin == 1;
    const std::size_t count = counting_.size();
    const auto turns = std::count(base_.fields.begin(), base_.fields.end(), "turn");
    if (turns > 1) return {};  // rather readings that never change
    if (count == 0) {
      found_.push_back(base_);
    } else if (is_taxel) {
      if (count == 1) add_taxels_in_turn();
      if (count == 2) add(base_, {row_of(0), col_of(1)});
      if (count == 3) add(base_, {"array", row_of(1), col_of(2)});
    } else if (count == 1) {
      const std::size_t lines = numbers_of(0).size();
      const bool is_row = columns_[counting_[0]].field == "cycle";
      if (is_row) add(base_, {row_of(0)}, lines > kFewRows ? 0.1 : 0.0);
      if (lines <= kMostInTurn) add(base_, {"array"}, lines > kFewRows ? 0.0 : 0.1);
    } else if (count == 2) {
      add(base_, {"array", row_of(1)});
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] Series numbers_of(std::size_t place) const {
    Series numbers = columns_[counting_[place]].series;
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
  }
  [[nodiscard]] std::string named(std::size_t place, const char* otherwise) const {
    const Column& column = columns_[counting_[place]];
    const std::string name = field_of_name(column.name.empty() ? column.label : column.name);
    return name == "row" || name == "col" ? name : otherwise;
  }
  [[nodiscard]] std::string row_of(std::size_t place) const { return named(place, "row"); }
  [[nodiscard]] std::string col_of(std::size_t place) const { return named(place, "col"); }

  void add_taxels_in_turn() {
    LineFields fields = base_;
    fields.fields[counting_[0]] = columns_[counting_[0]].is_counted_from_1 ? "first-1" : "first";
    const std::size_t count = numbers_of(0).size();
    fields.shape = FrameShape{1, count};
    fields.reasons.push_back("a number of each line counts " + std::to_string(count) + " taxels");
    found_.push_back(std::move(fields));
  }

  void add(LineFields fields, const std::vector<std::string>& counted, double merit = 0.0) {
    FrameShape shape{0, fields.spans.front().end - fields.spans.front().begin};
    for (std::size_t k = 0; k < counted.size(); ++k) {
      const Series numbers = numbers_of(k);
      const std::string what = counted[k] == "array" ? "arrays" : counted[k].starts_with("row") ? "rows" : "columns";
      if (what == "rows") shape.rows = numbers.size();
      if (what == "columns") shape.cols = numbers.size();
      if (what == "arrays") fields.ids.assign(numbers.begin(), numbers.end());
      fields.fields[counting_[k]] = counted[k];
      if (what != "arrays" && columns_[counting_[k]].is_counted_from_1) fields.fields[counting_[k]] += "-1";
      fields.reasons.push_back("a number of each line counts " + std::to_string(numbers.size()) + " " + what);
    }
    if (fields.ids.size() > kMostArrays) return;
    if (shape.rows > 0) fields.shape = shape;
    fields.merit += merit;
    found_.push_back(std::move(fields));
  }

  const std::vector<Column>& columns_;
  LineFields base_;
  std::vector<std::size_t> counting_;  // columns, the slowest first
  std::vector<LineFields> found_;
};

}  // namespace

std::vector<LineFields> fields_of(const std::vector<Column>& columns) {
  std::vector<LineFields> all = Interpreter(columns).all();
  std::vector<Column> plain = columns;
  bool has_counted = false;
  for (Column& column : plain) {
    if (column.field != "cycle" && column.field != "turn") continue;
    column.field = "";
    has_counted = true;
  }
  if (!has_counted) return all;
  for (LineFields& fields : Interpreter(plain).all()) {  // what seems to count may be readings
    fields.merit -= kOfChance;
    all.push_back(std::move(fields));
  }
  return all;
}

}  // namespace dermis::bytes::proposals
