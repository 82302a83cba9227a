// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/text_drafts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bytes/proposals/bare_numbers.hpp"
#include "bytes/proposals/byte_text.hpp"
#include "bytes/proposals/column_names.hpp"
#include "bytes/proposals/document.hpp"
#include "bytes/proposals/frame_marks.hpp"
#include "bytes/proposals/line_draft.hpp"
#include "bytes/proposals/line_end.hpp"
#include "bytes/proposals/line_fields.hpp"
#include "bytes/proposals/line_readings.hpp"
#include "bytes/proposals/shapes.hpp"
#include "bytes/proposals/smoothness.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kFewRows = 3;  // so many are rather arrays in turn
constexpr std::size_t kMostColsOfRow = 32;
constexpr double kWithObjects = 1.0;     // lists of a document that has objects are rather parts of these
constexpr std::size_t kMostFrames = 24;  // whose readings are compared

/// Drafts of one group of lines.
class GroupDrafts {
 public:
  GroupDrafts(const std::vector<Line>& lines, const LineGroup& group, const Numerals& numerals, const Known& known)
      : text_{lines, group, numerals, columns_of(lines, group, numerals, false)}, known_(known) {}

  std::vector<Draft> all() {
    for (const LineFields& fields : fields_of(text_.columns)) add_all(fields);
    return std::move(drafts_);
  }

 private:
  void add_all(const LineFields& fields) {
    if (fields.shape && fields.shape->rows > 1) return add_rows(fields, *fields.shape);
    if (fields.shape)
      return add_arrays(
          fields, {fields.shape->cols},
          readings_of_taxels(text_.lines, text_.group.members, fields.spans.front(), fields.shape->cols, kMostFrames));
    if (fields.spans.size() == 1 && fields.ids.empty() && text_.group.names.empty()) {
      for (const FrameMark& mark : frame_marks_of(text_.lines, text_.group.members)) add_marked(fields, mark);
    }
    std::vector<std::size_t> sizes;
    for (const Span& span : fields.spans) sizes.push_back(span.size());
    const std::size_t taxels = known_.rows.value_or(0) * known_.cols.value_or(0);
    const auto is_share = [&](std::size_t size) { return size * sizes.size() == taxels; };
    if (sizes.size() > 1 && fields.ids.empty() && std::ranges::all_of(sizes, is_share))
      add_arrays(fields, {taxels}, {});  // a clock stands between its readings
    const std::size_t beside = text_.columns.size() - sizes.front();
    if (!text_.group.names.empty()) sizes.clear();
    for (const std::size_t numbers : text_.group.numbers) sizes.push_back(numbers > beside ? numbers - beside : 1);
    add_arrays(fields, sizes, readings_of_lines(text_.lines, text_.group.members, fields.spans.front(), kMostFrames));
    const bool is_alone = fields.spans.size() == 1 && fields.ids.empty() && text_.group.names.empty();
    if (is_alone) add_in_lines(fields);
    if (fields.spans.size() == 1 && !fields.spans.front().has_labels) add_without_ends(fields);
  }

  void add_rows(const LineFields& fields, const FrameShape& shape) {
    if (!is_known(shape, known_)) return;
    Draft draft = begin_line_draft(text_, fields, known_);
    draft.has_certain_shape = true;
    draft.merit += shape.rows > kFewRows || known_.rows ? 0.2 : -0.2;
    for (const std::uint64_t id : fields.ids) draft.arrays.push_back({"array_" + std::to_string(id), shape, id});
    for (const std::string& name : text_.group.names) draft.arrays.push_back({name, shape});
    if (draft.arrays.empty()) draft.arrays.push_back({"", shape});
    if (draft.arrays.size() == 1) draft.head = head_of_rows(shape.rows);
    draft.merit += draft.head.empty() ? 0.0 : 0.1;
    write_line(text_, fields, draft);
    drafts_.push_back(std::move(draft));
  }

  /// The lines that begin a frame, where they tell its number or time.
  [[nodiscard]] std::string head_of_rows(std::size_t rows) const {
    for (const FrameMark& mark : frame_marks_of(text_.lines, text_.group.members)) {
      if (mark.rows != rows) continue;
      if (std::string head = head_of(text_, mark.lines); !head.empty()) return head;
    }
    return {};
  }

  void add_marked(const LineFields& fields, const FrameMark& mark) {
    const Span& span = fields.spans.front();
    const FrameShape shape{mark.rows, span.size()};
    if (span.size() == 1) return add_marked_numbers(fields, mark);
    if (!is_known(shape, known_)) return;
    Draft draft = begin_line_draft(text_, fields, known_);
    draft.has_certain_shape = true;
    draft.head = head_of(text_, mark.lines);
    const bool says_nothing = mark.text.find_first_not_of("[](){}-=#\x1b") == std::string::npos;
    draft.merit += says_nothing || !draft.head.empty() ? 0.3 : shape.cols <= kMostColsOfRow ? 0.1 : 0.0;
    draft.merit += gain_of_rows(readings_of_lines(text_.lines, text_.group.members, span, 4 * mark.rows), mark.rows);
    if (draft.head.empty())
      draft.keys.emplace_back(mark.lines.empty() ? "frame_begin" : "frame_end", files::quoted_toml(mark.text));
    draft.reasons.push_back((mark.text.empty() ? "an empty line" : "'" + printable(mark.text) + "'") + " comes every " +
                            std::to_string(mark.rows) + " rows");
    draft.arrays = {{"", shape}};
    write_line(text_, fields, draft);
    drafts_.push_back(std::move(draft));
  }

  /// One number a line, up to a line that is none.
  void add_marked_numbers(const LineFields& fields, const FrameMark& mark) {
    LineFields parts = fields;
    parts.is_part = true;
    parts.merit += 0.4;
    parts.reasons.push_back("'" + printable(mark.text) + "' comes every " + std::to_string(mark.rows) + " numbers");
    const std::string head = head_of(text_, mark.lines);
    add_frames(parts, mark.rows, text_.group.members, [&](Draft& draft) {
      draft.head = head;
      if (head.empty())
        draft.keys.emplace_back(mark.lines.empty() ? "frame_begin" : "frame_end", files::quoted_toml(mark.text));
    });
  }

  /// A frame goes over several lines of which none says where it begins, but for a number that marks it.
  void add_in_lines(const LineFields& fields) {
    LineFields parts = fields;
    parts.is_part = true;
    const std::vector<std::size_t>& members = text_.group.members;
    const std::size_t size = fields.spans.front().size();
    const bool is_bare = size == 1 && text_.columns.size() == 1;
    if (const auto mark = is_bare ? number_that_marks(text_.lines, members) : std::nullopt) {
      parts.merit += 0.5;
      parts.reasons.push_back("'" + mark->text + "' comes every " + std::to_string(mark->numbers) + " numbers");
      std::vector<std::size_t> others = members;
      std::erase_if(others, [&](std::size_t line) { return text_.lines[line].text == mark->text; });
      return add_frames(parts, mark->numbers, others, [&](Draft& draft) { draft.head = mark->text; });
    }
    const std::size_t taxels = known_.rows.value_or(0) * known_.cols.value_or(0);
    const std::size_t found = taxels == 0 && is_bare ? period_of_numbers(text_.lines, members) : taxels;
    if (found <= size || found % size != 0 || found / size > members.size()) return;
    parts.merit -= 0.2;
    parts.doubts.emplace_back("nothing marks where a frame begins: the first line is taken for the first of a frame");
    add_frames(parts, found, members, [](Draft&) {});
  }

  /// `end`: what a draft says beside its line.
  template <typename End>
  void add_frames(const LineFields& fields, std::size_t taxels, const std::vector<std::size_t>& members, End end) {
    const std::size_t before = drafts_.size();
    const Readings frames = readings_of_taxels(text_.lines, members, fields.spans.front(), taxels, kMostFrames);
    for (const auto& shapes : shapes_of({taxels}, frames, known_)) {
      if (shapes.size() > 1) continue;
      Draft draft = begin_line_draft(text_, fields, known_);
      draft.merit -= 0.05 * static_cast<double>(drafts_.size() - before);
      draft.arrays = {{"", shapes.front()}};
      end(draft);
      write_line(text_, fields, draft);
      drafts_.push_back(std::move(draft));
    }
  }

  void add_arrays(const LineFields& fields, const std::vector<std::size_t>& sizes, const Readings& frames) {
    std::optional<FrameShape> shown = fields.spans.front().shown_shape;
    if (sizes.size() > 1 || (shown && (shown->taxel_count() != sizes.front() || !is_known(*shown, known_))))
      shown.reset();
    std::vector<std::vector<FrameShape>> shapes;
    if (shown) shapes.push_back({*shown});
    if (!shown) shapes = shapes_of(sizes, frames, known_);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      Draft draft = begin_line_draft(text_, fields, known_);
      draft.merit -= 0.05 * static_cast<double>(k);
      draft.has_certain_shape = shown.has_value();
      if (shown && !fields.spans.front().has_labels) draft.reasons.emplace_back("a line shows where its rows end");
      for (const std::uint64_t id : fields.ids) {
        draft.arrays.push_back({"array_" + std::to_string(id), shapes[k].front(), id});
      }
      for (std::size_t i = 0; fields.ids.empty() && i < shapes[k].size(); ++i) {
        draft.arrays.push_back(array_at(fields, i, shapes[k][i], shapes[k].size()));
      }
      write_line(text_, fields, draft);
      drafts_.push_back(std::move(draft));
    }
  }

  [[nodiscard]] DraftArray array_at(const LineFields& fields, std::size_t index, const FrameShape& shape,
                                    std::size_t count) const {
    if (count == 1 && text_.group.names.empty()) return {"", shape};
    if (!text_.group.names.empty()) return {text_.group.names[index], shape};
    std::string name = fields.spans.size() == count ? fields.spans[index].name : std::string();
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return std::string_view("{}#& \t\"").find(c) != std::string_view::npos; }, '_');
    while (!name.empty() && (name.back() == '_' || name.back() == '-')) name.pop_back();
    const auto is_same = [&](const Span& span) { return span.name == fields.spans[index].name; };
    const bool is_alone = !name.empty() && std::count_if(fields.spans.begin(), fields.spans.end(), is_same) == 1 &&
                          field_of_name(name).empty();
    return {is_alone ? name : "array_" + std::to_string(index + 1), shape};
  }

  /// Numbers before or behind the readings that nothing tells apart from them.
  void add_without_ends(const LineFields& fields) {
    const Span span = fields.spans.front();
    const std::size_t size = span.size();
    for (std::size_t leading = 0; leading <= 4; ++leading) {
      for (std::size_t trailing = 0; leading + trailing <= 4; ++trailing) {
        const std::size_t rest = leading + trailing > 0 && size > leading + trailing ? size - leading - trailing : 0;
        if (!is_size_without_ends(rest, leading + trailing)) continue;
        LineFields fewer = fields;
        for (std::size_t k = 0; k < leading; ++k) fewer.fields[span.begin + k] = "skip";
        for (std::size_t k = 0; k < trailing; ++k) fewer.fields[span.end - 1 - k] = "skip";
        fewer.spans.front().begin += leading;
        fewer.spans.front().end -= trailing;
        fewer.merit -= 0.1 + (leading > 0 && trailing > 0 ? 0.1 : 0.0);
        fewer.reasons.push_back(std::to_string(leading + trailing) + " numbers of a line are none of the readings");
        add_arrays(fewer, {rest},
                   readings_of_lines(text_.lines, text_.group.members, fewer.spans.front(), kMostFrames));
      }
    }
  }

  [[nodiscard]] bool is_size_without_ends(std::size_t rest, std::size_t ends) const {
    if (known_.rows && known_.cols) return rest == *known_.rows * *known_.cols;
    const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(rest))));
    return ends <= 2 && side >= 4 && side * side == rest && !known_.rows && !known_.cols;
  }

  LinesAlike text_;
  const Known& known_;
  std::vector<Draft> drafts_;
};

}  // namespace

std::vector<Draft> text_drafts(std::string_view text, const Known& known) {
  std::vector<Draft> drafts;
  const auto add = [&](std::vector<Line> lines, const std::string& line_end, const std::string& before) {
    for (Numerals& numerals : numerals_of(lines)) {
      tokenise(lines, numerals);
      for (const LineGroup& group : groups_of(lines)) {
        for (Draft& draft : GroupDrafts(lines, group, numerals, known).all()) {
          if (!line_end.empty()) draft.keys.emplace_back("line_end", files::quoted_toml(line_end));
          if (!draft.line.empty()) draft.line.insert(0, before);
          drafts.push_back(std::move(draft));
        }
      }
    }
  };
  const std::string line_end = line_end_of(text);
  add(lines_of(text, line_end), line_end, "");
  if (!is_document(text)) return drafts;
  const std::string unbroken = without_breaks(text);
  const std::size_t before = drafts.size();
  add(pieces_of_document(unbroken, '{', '}'), "}", "{skip}");
  const bool has_objects = drafts.size() > before;
  const std::size_t objects = drafts.size();
  add(pieces_of_document(unbroken, '[', ']'), "]", "{skip}[");
  for (std::size_t k = objects; has_objects && k < drafts.size(); ++k) drafts[k].merit -= kWithObjects;
  return drafts;
}

}  // namespace dermis::bytes::proposals
