// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <array>
#include <cmath>
#include <memory>

#include "bytes/files/csv_reader.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/millimetres.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kMostTaxels = kMaxLines * kMaxLines;
constexpr std::array<std::string_view, 3> kHeader{"x_mm", "y_mm", "z_mm"};

Status check_header(const CsvReader& csv, std::string_view line) {
  CsvCells cells(line);
  std::string_view cell;
  for (const std::string_view name : kHeader) {
    if (!cells.next(cell) || cell != name) return csv.error("the first line must be x_mm,y_mm,z_mm");
  }
  if (cells.next(cell)) return csv.error("the first line must be x_mm,y_mm,z_mm");
  return Done{};
}

Result<Vector3> place_of(const CsvReader& csv, std::string_view line) {
  CsvCells cells(line);
  std::string_view cell;
  std::array<double, 3> metres{};
  for (double& value : metres) {
    const bool is_number = cells.next(cell) && parse_number(cell, value) && std::isfinite(value);
    if (!is_number) return csv.error("must be three numbers: x, y and z in mm");
    value /= kMillimetresPerMetre;
  }
  if (cells.next(cell)) return csv.error("must be three numbers: x, y and z in mm");
  return Vector3{metres[0], metres[1], metres[2]};
}

}  // namespace

Result<std::vector<Vector3>> read_positions(std::istream& in, const std::string& name) {
  CsvReader csv(in, name);
  std::vector<Vector3> positions;
  bool is_first = true;
  for (std::string_view line;;) {
    const Result<bool> more = csv.next_line(line);
    if (!more) return more.error();
    if (!*more && is_first) return bad_input(name + ": is empty; the first line must be x_mm,y_mm,z_mm");
    if (!*more) return positions;
    if (is_first) {
      if (const Status header = check_header(csv, line); !header) return header.error();
      is_first = false;
      continue;
    }
    const Result<Vector3> place = place_of(csv, line);
    if (!place) return place.error();
    if (positions.size() == kMostTaxels) return csv.error("there are more places than an array has taxels");
    positions.push_back(*place);
  }
}

Result<std::vector<Vector3>> read_positions(const std::string& path) {
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read_positions(**in, path);
}

}  // namespace dermis::bytes::files
