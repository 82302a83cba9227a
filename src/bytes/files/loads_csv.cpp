// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/loads_csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "bytes/files/csv_reader.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/force_text.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::string_view kHeader = "frame,kind,where,value";
constexpr double kMostValue = 1e6;  // N, kPa or mm
constexpr double kPascalPerKilopascal = 1000.0;
constexpr std::string_view kNewtons = "N";
constexpr double kMetresPerMillimetre = 0.001;

/// A line is a load or a position.
struct Line {
  std::optional<Load> load;
  TouchPosition position;
  std::string taken{};  ///< "0.5 kg, taken for 4.903 N" of a value in another unit than newtons and kPa.
};

Result<LoadKind> parse_kind(std::string_view text, const ArrayDescription& array) {
  if (text == "force") return LoadKind::force;
  if (text != "pressure") {
    return bad_input("unknown kind " + in_quotes(text) + "; write force, pressure or position");
  }
  if (!array.taxel_area_m2) return bad_input("a pressure needs array.taxel_area_mm2 in the description of the array");
  return LoadKind::pressure;
}

Result<std::size_t> parse_frame(std::string_view text, std::size_t frame_count) {
  std::size_t frame = 0;
  if (!parse_number(text, frame)) return bad_input("frame " + in_quotes(text) + " is not a whole number of 0 or more");
  if (frame >= frame_count) {
    return bad_input("frame " + std::to_string(frame) + " does not exist; there are " + std::to_string(frame_count) +
                     " frames, counted from 0");
  }
  return frame;
}

/// `unit`: of a force that has none.
Result<double> parse_value(std::string_view text, LoadKind kind, std::string_view unit) {
  const bool is_force = kind == LoadKind::force;
  Result<double> value = is_force ? parse_force(text, unit) : parse_pressure(text);
  if (!value) return bad_input("value " + value.error().message);
  const double most = is_force ? kMostValue : kMostValue * kPascalPerKilopascal;
  if (!(*value >= 0.0 && *value <= most)) {
    return bad_input("value " + in_quotes(text) + " must be 0 to 1000000 (N or kPa)");
  }
  return value;
}

/// Where a person wrote something else than a number of newtons or kPa.
std::string taken_for(std::string_view text, const Load& load, std::string_view unit) {
  double number = 0.0;
  const bool is_force = load.kind == LoadKind::force;
  const bool is_number = parse_number(text, number);
  if (load.value == 0.0 || (is_number && (unit == kNewtons || !is_force))) return {};
  std::string taken(text);
  if (is_number) taken += " " + std::string(unit);
  taken += ", taken for ";
  append_number(taken, static_cast<float>(is_force ? load.value : load.value / kPascalPerKilopascal));
  return taken + (is_force ? " N" : " kPa");
}

Result<Line> parse_position(std::size_t frame, const TaxelRegion& where, std::string_view text,
                            const ArrayDescription& array) {
  if (array.rows > 1 && array.cols > 1) {
    return bad_input("a position is a place along an array of one row or one column; this one is " +
                     size_text({array.rows, array.cols}));
  }
  if (where != all_taxels(array)) return bad_input("a position is one of the whole strip; write all");
  double millimetres = 0.0;
  if (!parse_number(text, millimetres) || !(std::abs(millimetres) <= kMostValue)) {
    return bad_input("value " + in_quotes(text) + " is not a position in mm");
  }
  return Line{std::nullopt, {frame, kMetresPerMillimetre * millimetres}};
}

Result<Line> parse_line(std::string_view line, const ArrayDescription& array, std::size_t frame_count,
                        std::string_view unit) {
  constexpr std::size_t kCells = 4;
  if (const Status right = check_count(line, kCells); !right) return right.error();
  const std::vector<std::string_view> cells = split_cells(line);
  const Result<std::size_t> frame = parse_frame(cells[0], frame_count);
  if (!frame) return frame.error();
  const bool is_position = cells[1] == "position";
  const Result<LoadKind> kind = is_position ? LoadKind::force : parse_kind(cells[1], array);
  if (!kind) return kind.error();
  const Result<TaxelRegion> where = parse_region(cells[2], {array.rows, array.cols});
  if (!where) return where.error();
  if (is_position) return parse_position(*frame, *where, cells[3], array);
  const Result<double> value = parse_value(cells[3], *kind, unit);
  if (!value) return value.error();
  const Load load{*frame, *kind, *where, *value};
  return Line{load, {}, taken_for(cells[3], load, unit)};
}

/// The unit of forces without one: of the header frame,kind,where,kg or value_kg.
Result<std::string> read_header(CsvReader& csv) {
  std::string_view line;
  const Result<bool> got_line = csv.next_line(line);
  if (!got_line) return got_line.error();
  if (!*got_line) return csv.error("is empty; expected the header " + std::string(kHeader));
  const std::size_t cell_count = count_cells(line);
  std::vector<std::string_view> cells = split_cells(line);
  std::string_view named = cell_count == count_cells(kHeader) ? cells.back() : "";
  if (named.starts_with("value_")) named.remove_prefix(std::string_view("value_").size());
  std::string unit(kNewtons);
  if (is_force_unit(named)) {
    unit = named;
    cells.back() = "value";
  }
  if (cells != split_cells(kHeader)) {
    return csv.error("has the header " + in_quotes(line) + "; expected " + std::string(kHeader));
  }
  return unit;
}

/// visit(line, number) for all lines.
template <typename Visit>
Status read_lines(std::istream& in, const std::string& name, const ArrayDescription& array, std::size_t frame_count,
                  Visit visit) {
  CsvReader csv(in, name);
  const Result<std::string> unit = read_header(csv);
  if (!unit) return unit.error();
  while (true) {
    std::string_view text;
    const Result<bool> got_line = csv.next_line(text);
    if (!got_line) return got_line.error();
    if (!*got_line) return Done{};
    const Result<Line> line = parse_line(text, array, frame_count, *unit);
    if (!line) return csv.error(line.error().message);
    visit(*line, csv.line_number());
  }
}

/// Finds loads of one frame that share a taxel: which of them counts would be a guess.
class OverlapCheck {
 public:
  /// `lines`: the number of the line of each load.
  OverlapCheck(const std::string& name, const ArrayDescription& array, std::span<const Load> loads,
               std::span<const std::uint32_t> lines)
      : name_(name), array_(array), loads_(loads), lines_(lines) {}

  [[nodiscard]] Status check() {
    std::vector<std::uint32_t> order(loads_.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    const auto is_earlier = [&](std::uint32_t a, std::uint32_t b) { return loads_[a].frame < loads_[b].frame; };
    if (!std::is_sorted(order.begin(), order.end(), is_earlier)) {
      std::stable_sort(order.begin(), order.end(), is_earlier);
    }
    for (auto first = order.begin(); first != order.end();) {
      const auto last = std::find_if(first, order.end(),
                                     [&](std::uint32_t other) { return loads_[other].frame != loads_[*first].frame; });
      if (Status frame = check_frame({first, last}); !frame) return frame;
      first = last;
    }
    return Done{};
  }

 private:
  [[nodiscard]] Status check_frame(std::span<const std::uint32_t> loads) {
    if (loads.size() == 1) return Done{};
    line_of_taxel_.assign(array_.taxel_count(), 0);
    for (const std::uint32_t load : loads) {
      for (const std::size_t taxel : taxel_indices(loads_[load].where, array_.cols)) {
        const std::uint32_t earlier = std::exchange(line_of_taxel_[taxel], lines_[load]);
        if (earlier != 0) return overlap(load, earlier, taxel);
      }
    }
    return Done{};
  }

  [[nodiscard]] Error overlap(std::uint32_t load, std::uint32_t earlier, std::size_t taxel) const {
    return bad_input(name_ + ":" + std::to_string(lines_[load]) + ": overlaps line " + std::to_string(earlier) +
                     " at " + array_.taxel_name(taxel) + " of frame " + std::to_string(loads_[load].frame) +
                     "; name each taxel once per frame");
  }

  const std::string& name_;
  const ArrayDescription& array_;
  std::span<const Load> loads_;
  std::span<const std::uint32_t> lines_;
  std::vector<std::uint32_t> line_of_taxel_;
};

}  // namespace

Result<std::vector<Load>> read_loads(const std::string& path, const ArrayDescription& array, std::size_t frame_count,
                                     std::string* taken) {
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read_loads(**in, path, array, frame_count, taken);
}

Result<std::vector<Load>> read_loads(std::istream& in, const std::string& name, const ArrayDescription& array,
                                     std::size_t frame_count, std::string* taken) {
  std::vector<Load> loads;
  std::vector<std::uint32_t> lines;
  const Status read = read_lines(in, name, array, frame_count, [&](const Line& line, std::size_t number) {
    if (!line.load) return;
    if (taken != nullptr && taken->empty()) *taken = line.taken;
    loads.push_back(*line.load);
    lines.push_back(static_cast<std::uint32_t>(number));
  });
  if (!read) return read.error();
  if (const Status overlap = OverlapCheck(name, array, loads, lines).check(); !overlap) return overlap.error();
  return loads;
}

Result<std::vector<TouchPosition>> read_touch_positions(const std::string& path, const ArrayDescription& array,
                                                        std::size_t frame_count) {
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read_touch_positions(**in, path, array, frame_count);
}

Result<std::vector<TouchPosition>> read_touch_positions(std::istream& in, const std::string& name,
                                                        const ArrayDescription& array, std::size_t frame_count) {
  std::map<std::size_t, double> along_m;
  std::optional<Error> repeated;
  const Status read = read_lines(in, name, array, frame_count, [&](const Line& line, std::size_t number) {
    if (line.load || repeated) return;
    const auto& [frame, place_m] = line.position;
    if (along_m.emplace(frame, place_m).second) return;
    repeated = bad_input(name + ":" + std::to_string(number) + ": frame " + std::to_string(frame) +
                         " has a position already; write one");
  });
  if (!read) return read.error();
  if (repeated) return *std::move(repeated);
  std::vector<TouchPosition> positions;
  for (const auto& [frame, place_m] : along_m) positions.push_back({frame, place_m});
  return positions;
}

Status write_loads(const std::string& path, const ArrayDescription& array, const std::vector<Load>& loads) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->write(std::string(kHeader) + "\n");
  std::string line;
  for (const Load& load : loads) {
    const bool is_pressure = load.kind == LoadKind::pressure;
    line = std::to_string(load.frame) + (is_pressure ? ",pressure," : ",force,") + to_string(load.where, array) + ",";
    append_number(line, is_pressure ? load.value / kPascalPerKilopascal : load.value);
    file->write(line + "\n");
  }
  return file->commit();
}

}  // namespace dermis::bytes::files
