// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "bytes/files/csv_reader.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/millimetres.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kMostTaxels = kMaxLines * kMaxLines;
/// The columns of a file, and how messages name them.
struct Columns {
  const char* must_begin;
  const char* must_be;
  bool has_z = true;
  bool has_name = false;
};

constexpr std::size_t kMostName = 100;  // bytes
constexpr Columns kPositions{"the first line must be x_mm,y_mm,z_mm", "must be three numbers: x, y and z in mm"};
constexpr Columns kPlaces{"the first line must be x_mm,y_mm, with z_mm, name or both behind them",
                          "must be what the first line says: numbers in mm, and a name where it has one"};

/// The columns that are there.
std::optional<Columns> columns_of(std::string_view header, Columns columns) {
  const std::vector<std::string_view> names = split_cells(header);
  std::vector<std::string_view> known = {"x_mm", "y_mm"};
  columns.has_z = columns.must_be == kPositions.must_be || std::find(names.begin(), names.end(), "z_mm") != names.end();
  columns.has_name = columns.must_be == kPlaces.must_be && !names.empty() && names.back() == "name";
  if (columns.has_z) known.emplace_back("z_mm");
  if (columns.has_name) known.emplace_back("name");
  return names == known ? std::optional(columns) : std::nullopt;
}

bool is_name(std::string_view name) {
  return name.size() <= kMostName && std::none_of(name.begin(), name.end(), [](char c) {
           return static_cast<unsigned char>(c) < ' ' || c == 0x7F;
         });
}

Result<NamedPlace> place_of(const CsvReader& csv, const Columns& columns, std::string_view line) {
  CsvCells cells(line);
  std::string_view cell;
  std::array<double, 3> metres{};
  for (std::size_t axis = 0; axis < (columns.has_z ? 3U : 2U); ++axis) {
    const bool is_number = cells.next(cell) && parse_number(cell, metres[axis]) && std::isfinite(metres[axis]);
    if (!is_number) return csv.error(columns.must_be);
    metres[axis] /= kMillimetresPerMetre;
  }
  NamedPlace place{{metres[0], metres[1], metres[2]}};
  if (columns.has_name) {
    if (!cells.next(cell) || !is_name(cell)) return csv.error(columns.must_be);
    place.name = cell;
  }
  if (cells.next(cell)) return csv.error(columns.must_be);
  return place;
}

Result<std::vector<NamedPlace>> read_table(std::istream& in, const std::string& name, const Columns& may) {
  CsvReader csv(in, name);
  std::vector<NamedPlace> places;
  std::optional<Columns> columns;
  for (std::string_view line;;) {
    const Result<bool> more = csv.next_line(line);
    if (!more) return more.error();
    if (!*more && !columns) return bad_input(name + ": is empty; " + may.must_begin);
    if (!*more) return places;
    if (!columns) {
      columns = columns_of(line, may);
      if (!columns) return csv.error(may.must_begin);
      continue;
    }
    Result<NamedPlace> place = place_of(csv, *columns, line);
    if (!place) return place.error();
    if (places.size() == kMostTaxels) return csv.error("there are more places than an array has taxels");
    places.push_back(*std::move(place));
  }
}

}  // namespace

Result<std::vector<NamedPlace>> read_places(std::istream& in, const std::string& name) {
  return read_table(in, name, kPlaces);
}

Result<std::vector<NamedPlace>> read_places(const std::string& path) {
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read_places(**in, path);
}

Result<std::vector<Vector3>> read_positions(std::istream& in, const std::string& name) {
  const Result<std::vector<NamedPlace>> places = read_table(in, name, kPositions);
  if (!places) return places.error();
  std::vector<Vector3> positions;
  positions.reserve(places->size());
  for (const NamedPlace& place : *places) positions.push_back(place.position);
  return positions;
}

Result<std::vector<Vector3>> read_positions(const std::string& path) {
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read_positions(**in, path);
}

std::string positions_csv(const std::vector<Vector3>& positions) {
  std::string text = "x_mm,y_mm,z_mm\n";
  for (const Vector3& place : positions) {
    text += fmt::format("{:.6g},{:.6g},{:.6g}\n", place.x * kMillimetresPerMetre, place.y * kMillimetresPerMetre,
                        place.z * kMillimetresPerMetre);
  }
  return text;
}

}  // namespace dermis::bytes::files
