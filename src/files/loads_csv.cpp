// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/files/loads_csv.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "dermis/files/atomic_file.hpp"
#include "dermis/files/input.hpp"
#include "dermis/files/taxel_text.hpp"
#include "dermis/files/text.hpp"
#include "files/csv_reader.hpp"

namespace dermis::files {
namespace {

constexpr std::string_view kHeader = "frame,kind,where,value";
constexpr double kMostLoad = 1e6;  // N or kPa
constexpr double kPascalPerKilopascal = 1000.0;

struct NumberedLoad {
  Load load;
  std::size_t line = 0;
};

Result<LoadKind> parse_kind(std::string_view text, const ArrayDescription& array) {
  if (text == "force") return LoadKind::force;
  if (text != "pressure") return bad_input("unknown kind " + in_quotes(text) + "; write force or pressure");
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

Result<double> parse_value(std::string_view text, LoadKind kind) {
  double value = 0.0;
  if (!parse_number(text, value)) return bad_input("value " + in_quotes(text) + " is not a number");
  if (!(value >= 0.0 && value <= kMostLoad)) {
    return bad_input("value " + in_quotes(text) + " must be 0 to 1000000 (N or kPa)");
  }
  if (kind == LoadKind::pressure) value *= kPascalPerKilopascal;
  return value;
}

Result<Load> parse_load(std::string_view line, const ArrayDescription& array, std::size_t frame_count) {
  constexpr std::size_t kCells = 4;
  if (count_cells(line) != kCells) {
    return bad_input("has " + std::to_string(count_cells(line)) + " values, the header " + std::to_string(kCells));
  }
  const std::vector<std::string_view> cells = split_cells(line);
  const Result<std::size_t> frame = parse_frame(cells[0], frame_count);
  if (!frame) return frame.error();
  const Result<LoadKind> kind = parse_kind(cells[1], array);
  if (!kind) return kind.error();
  const Result<TaxelRegion> where = parse_region(cells[2], {array.rows, array.cols});
  if (!where) return where.error();
  const Result<double> value = parse_value(cells[3], *kind);
  if (!value) return value.error();
  return Load{*frame, *kind, *where, *value};
}

Status check_header(CsvReader& csv) {
  std::string_view line;
  const Result<bool> got_line = csv.next_line(line);
  if (!got_line) return got_line.error();
  if (!*got_line) return csv.error("is empty; expected the header " + std::string(kHeader));
  const std::size_t cell_count = count_cells(line);
  const bool is_header = cell_count == count_cells(kHeader) && split_cells(line) == split_cells(kHeader);
  if (!is_header) return csv.error("has the header " + in_quotes(line) + "; expected " + std::string(kHeader));
  return Done{};
}

/// Finds loads of one frame that share a taxel: which of them counts would be a guess.
class OverlapCheck {
 public:
  OverlapCheck(const std::string& name, const ArrayDescription& array) : name_(name), array_(array) {}

  [[nodiscard]] Status check(std::vector<NumberedLoad>& loads) {
    std::stable_sort(loads.begin(), loads.end(),
                     [](const NumberedLoad& a, const NumberedLoad& b) { return a.load.frame < b.load.frame; });
    for (auto first = loads.begin(); first != loads.end();) {
      const auto last = std::find_if(first, loads.end(),
                                     [&](const NumberedLoad& other) { return other.load.frame != first->load.frame; });
      if (Status frame = check_frame({first, last}); !frame) return frame;
      first = last;
    }
    return Done{};
  }

 private:
  [[nodiscard]] Status check_frame(std::span<const NumberedLoad> loads) {
    if (loads.size() == 1) return Done{};
    line_of_taxel_.assign(array_.taxel_count(), 0);
    for (const NumberedLoad& numbered : loads) {
      for (const std::size_t taxel : taxel_indices(numbered.load.where, array_.cols)) {
        const std::size_t earlier = std::exchange(line_of_taxel_[taxel], numbered.line);
        if (earlier != 0) return overlap(numbered, earlier, taxel);
      }
    }
    return Done{};
  }

  [[nodiscard]] Error overlap(const NumberedLoad& numbered, std::size_t earlier, std::size_t taxel) const {
    return bad_input(name_ + ":" + std::to_string(numbered.line) + ": overlaps line " + std::to_string(earlier) +
                     " at " + array_.taxel_name(taxel) + " of frame " + std::to_string(numbered.load.frame) +
                     "; name each taxel once per frame");
  }

  const std::string& name_;
  const ArrayDescription& array_;
  std::vector<std::size_t> line_of_taxel_;
};

}  // namespace

Result<std::vector<Load>> read_loads(const std::string& path, const ArrayDescription& array, std::size_t frame_count) {
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read_loads(**in, path, array, frame_count);
}

Result<std::vector<Load>> read_loads(std::istream& in, const std::string& name, const ArrayDescription& array,
                                     std::size_t frame_count) {
  CsvReader csv(in, name);
  if (const Status header = check_header(csv); !header) return header.error();
  std::vector<Load> loads;
  std::vector<NumberedLoad> numbered;
  while (true) {
    std::string_view line;
    const Result<bool> got_line = csv.next_line(line);
    if (!got_line) return got_line.error();
    if (!*got_line) break;
    const Result<Load> load = parse_load(line, array, frame_count);
    if (!load) return csv.error(load.error().message);
    loads.push_back(*load);
    numbered.push_back({*load, csv.line_number()});
  }
  if (const Status overlap = OverlapCheck(name, array).check(numbered); !overlap) return overlap.error();
  return loads;
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

}  // namespace dermis::files
