// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>
#include <utility>

#include "bytes/proposals/column_names.hpp"
#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kFewestOfArray = 4;
constexpr std::size_t kFewestOfMotion = 3;
constexpr std::size_t kMostBlocks = 6;
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

/// thumb of `"thumb": [[`.
std::string name_in_label(const std::string& label) {
  std::string name;
  for (const char c : label) {
    const bool is_part = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    if (is_part) name += c;
  }
  return name;
}

/// Few blocks of columns with signs and fractions stand beside others, as those of an IMU do.
bool has_two_kinds(const std::vector<Column>& columns) {
  std::size_t changes = 0;
  std::size_t signs = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    signs += columns[k].has_signs ? 1 : 0;
    changes += k > 0 && columns[k].has_signs != columns[k - 1].has_signs ? 1 : 0;
  }
  return signs >= kFewestOfMotion && signs + kFewestOfArray <= columns.size() && changes <= kMostBlocks;
}

/// Readings side by side, cut where their names change, or where numbers with signs and fractions begin or end.
std::vector<Span> spans_of(const std::vector<Column>& columns) {
  std::vector<Span> spans;
  const auto is_reading = [&](std::size_t k) {
    return columns[k].kind == Token::Kind::number && columns[k].field.empty();
  };
  const bool is_mixed = has_two_kinds(columns);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!is_reading(k)) continue;
    const bool goes_on = !spans.empty() && spans.back().end == k && columns[k].run == columns[k - 1].run &&
                         without_digits(columns[k].name) == without_digits(columns[k - 1].name) &&
                         (!is_mixed || columns[k].has_signs == columns[k - 1].has_signs);
    if (!goes_on) {
      const bool is_shared = k + 1 < columns.size() && columns[k + 1].name == columns[k].name;  // a cell of many
      const std::string name = columns[k].name.empty() ? name_in_label(columns[k].label) : stem_of(columns[k].name);
      spans.push_back({k, k, is_shared && !columns[k].name.empty() ? columns[k].name : name});
    }
    spans.back().end = k + 1;
  }
  for (Span& span : spans) {
    span.shown_shape = parted_shape(columns, span.begin, span.end);
    if (!span.shown_shape) span.shown_shape = named_shape(columns, span.begin, span.end);
  }
  return spans;
}

/// Drops sensors of motion, unless there are no others.
void drop_motion(const std::vector<Column>& columns, std::vector<Span>& spans) {
  const auto is_motion = [&](const Span& span) {
    const bool has_signs = has_two_kinds(columns) && columns[span.begin].has_signs;
    return has_signs ||
           is_of_motion(columns[span.begin].name.empty() ? columns[span.begin].label : columns[span.begin].name);
  };
  if (!std::ranges::all_of(spans, is_motion)) std::erase_if(spans, is_motion);
}

/// Those that are arrays. Readings beside them are something that nobody has told.
std::vector<Span> arrays_among(std::vector<Span> spans) {
  std::size_t most = 0;
  for (const Span& span : spans) most = std::max(most, span.size());
  if (most == 1) return {spans.back()};
  std::erase_if(spans, [&](const Span& span) {
    return span.size() < most && (span.size() < kFewestOfArray || 8 * span.size() < most);
  });
  return spans;
}

/// The key of a value: adc of `"label": "heel", "adc": `.
std::string key_of(const Column& column) {
  std::string key;
  for (const char c : without_digits(column.label)) {
    const bool is_part = std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '(';
    if (is_part) key += c;
  }
  return key;
}

/// Columns that lie as far apart as the first two.
std::optional<Span> evenly_spaced(const std::vector<std::size_t>& columns) {
  if (columns.size() < 2) return std::nullopt;
  const std::size_t step = columns[1] - columns[0];
  for (std::size_t k = 2; k < columns.size(); ++k) {
    if (columns[k] - columns[k - 1] != step) return std::nullopt;
  }
  return Span{.begin = columns.front(),
              .end = columns.back() + 1,
              .shown_shape = FrameShape{1, columns.size()},
              .step = step,
              .has_labels = true};
}

struct Labelled {
  std::string key{};
  Span span{};
  int rank = 0;
};

/// One reading behind each label: those of the same key, or those whose keys do not come again. The likeliest first.
std::vector<Labelled> labelled_of(const std::vector<Column>& columns, const std::vector<Span>& spans) {
  std::map<std::string, std::vector<std::size_t>> by_key;
  for (const Span& span : spans) by_key[key_of(columns[span.begin])].push_back(span.begin);
  std::vector<std::size_t> unique;
  std::vector<Labelled> found;
  const auto add = [&](const std::string& key, const std::vector<std::size_t>& places) {
    const auto varies = [&](std::size_t column) { return columns[column].varies; };
    std::optional<Span> span = evenly_spaced(places);
    if (!span || std::ranges::none_of(places, varies)) return;
    const auto is_numbered = [&](std::size_t column) {
      return column > 0 && columns[column - 1].kind == Token::Kind::number && !columns[column - 1].varies;
    };
    if (std::ranges::all_of(places, is_numbered)) span->shown_shape.reset();  // numbers in labels are no places
    found.push_back({key, *span, 2 * rank_of_key(key) + (columns[places.front()].has_fractions ? 0 : 1)});
  };
  for (const auto& [key, places] : by_key) {
    const bool may_be_reading = columns[places.front()].varies || rank_of_key(key) >= 0;
    if (places.size() == 1 && may_be_reading) unique.push_back(places.front());
    add(key, places);
  }
  std::ranges::sort(unique);
  add("", unique);
  std::ranges::stable_sort(found, [](const Labelled& a, const Labelled& b) {
    return std::pair(a.span.size(), a.rank) > std::pair(b.span.size(), b.rank);
  });
  return found;
}

std::size_t changes_in(const Series& series) {
  std::size_t changes = 0;
  for (std::size_t k = 1; k < series.size(); ++k) changes += series[k] != series[k - 1] ? 1 : 0;
  return changes;
}

class Interpreter {
 public:
  /// `labelled`: the place among the readings behind labels, where there are such.
  explicit Interpreter(const std::vector<Column>& columns, std::size_t labelled = 0) : columns_(columns) {
    base_.spans = spans_of(columns);
    if (base_.spans.empty()) return;
    drop_motion(columns, base_.spans);
    take_arrays(labelled);
    if (base_.spans.empty()) return;
    for (const Column& column : columns) {
      base_.fields.push_back(column.field);
      if (!column.reason.empty() && column.field != "cycle") base_.reasons.push_back(column.reason);
      if (!column.field.empty() && column.field != "skip") base_.merit += 0.02;
    }
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto has = [&](const Span& span) { return span.has(k); };
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
    const bool is_taxel = base_.spans.front().size() == 1;
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
  void take_arrays(std::size_t labelled) {
    const bool are_single = std::ranges::all_of(base_.spans, [](const Span& span) { return span.size() == 1; });
    const std::vector<Labelled> all = are_single ? labelled_of(columns_, base_.spans) : std::vector<Labelled>();
    if (all.empty() && labelled == 0) {
      base_.spans = arrays_among(std::move(base_.spans));
    } else if (labelled >= all.size()) {
      base_.spans.clear();
    } else {
      base_.spans = {all[labelled].span};
      base_.merit -= 0.3 * static_cast<double>(labelled);
      const std::string what = all[labelled].key.empty() ? "a reading" : "'" + all[labelled].key + "'";
      base_.reasons.push_back(what + " stands behind each of " + std::to_string(all[labelled].span.size()) + " labels");
      if (all.size() > 1)
        base_.doubts.push_back("the readings may also be those behind '" + all[labelled == 0 ? 1 : 0].key + "', not " +
                               what);
    }
  }

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
    FrameShape shape{0, fields.spans.front().size()};
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
  for (LineFields& fields : Interpreter(columns, 1).all()) all.push_back(std::move(fields));
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
