// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/suit_toml.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "dermis/bytes/bodies/body.hpp"
#include "dermis/bytes/files/config_table.hpp"
#include "dermis/touch/frames/millimetres.hpp"

namespace dermis::bytes::files {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

/// "sim:...", "serial://...": left as it is; everything else is a path.
bool is_uri(std::string_view from) {
  const std::string_view scheme = from.substr(0, from.find(':'));
  const auto is_scheme_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; };
  return scheme.size() < from.size() && scheme.size() > 1 &&
         std::all_of(scheme.begin(), scheme.end(), is_scheme_letter);
}

std::string path_beside(const std::string& suit_file, const std::string& path) {
  return path.empty() ? path : (std::filesystem::path(suit_file).parent_path() / path).string();
}

Vector3 metres_from(const std::vector<double>& mm) {
  return {mm[0] / kMillimetresPerMetre, mm[1] / kMillimetresPerMetre, mm[2] / kMillimetresPerMetre};
}

void read_pose(ConfigFile& file, const std::string& key, Pose& pose) {
  std::vector<double> translation_mm(3, 0.0);
  std::vector<double> rotation_deg(3, 0.0);
  file.numbers(key + ".translation_mm", 3, translation_mm);
  file.numbers(key + ".rotation_deg", 3, rotation_deg);
  const auto radians = [&](std::size_t k) { return rotation_deg[k] / kDegreesPerRadian; };
  pose = {metres_from(translation_mm), rotation_of(radians(0), radians(1), radians(2))};
}

/// Empty where the array is not wound round a cylinder.
std::optional<CylinderShape> read_cylinder(ConfigFile& file, const std::string& key) {
  CylinderShape cylinder;
  auto axis = static_cast<std::size_t>(cylinder.axis);
  file.choice(key + ".axis", {"x", "y"}, axis);
  cylinder.axis = static_cast<CylinderShape::Axis>(axis);
  double radius_mm = cylinder.radius_m * kMillimetresPerMetre;
  file.number(key + ".radius_mm", radius_mm);
  cylinder.radius_m = radius_mm / kMillimetresPerMetre;
  if (!file.contains(key)) return std::nullopt;
  file.require(key + ".radius_mm");
  if (!(radius_mm > 0.0)) file.fail(key + ".radius_mm", "must be more than 0 mm");
  return cylinder;
}

class SuitReader {
 public:
  SuitReader(ConfigFile file, std::string name, const ReadPositions& read_positions)
      : file_(std::move(file)), name_(std::move(name)), read_positions_(read_positions) {}

  Result<SuitDescription> read() {
    SuitDescription suit;
    file_.text("suit.name", suit.name);
    file_.text("suit.classes", suit.classes);
    suit.classes = path_beside(name_, suit.classes);
    file_.text("suit.body", suit.body);
    file_.number("suit.body_scale", suit.body_scale);
    suit.body = path_beside(name_, suit.body);
    suit.arrays.resize(file_.table_count("array"));
    for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
      read_array(fmt::format("array[{}]", k), suit.arrays[k]);
    }
    if (const Status read = file_.finish(); !read) return read.error();
    if (failure_) return *failure_;
    if (const Status valid = suit.validate(); !valid) return bad_input(name_ + ": " + valid.error().message);
    return suit;
  }

 private:
  void read_array(const std::string& key, SuitArray& array) {
    for (const char* const needed : {".name", ".from", ".model"}) file_.require(key + needed);
    file_.text(key + ".name", array.name);
    file_.text(key + ".from", array.from);
    file_.text(key + ".model", array.model);
    file_.text(key + ".classes", array.classes);
    file_.text(key + ".link", array.link);
    file_.boolean(key + ".mirrored", array.mirrored);
    if (!is_uri(array.from)) array.from = path_beside(name_, array.from);
    array.model = path_beside(name_, array.model);
    array.classes = path_beside(name_, array.classes);
    read_pose(file_, key + ".base_from_array", array.base_from_array);
    read_shape(key, array.shape);
  }

  void read_shape(const std::string& key, ArrayShape& shape) {
    const std::string positions = key + ".positions_mm";
    const std::optional<CylinderShape> cylinder = read_cylinder(file_, key + ".cylinder");
    std::vector<Vector3> places = read_places(positions);
    if (cylinder && file_.contains(positions)) file_.fail(positions, "has no meaning beside cylinder; remove one");
    if (file_.contains(positions)) shape = FreeShape{std::move(places)};
    if (cylinder) shape = *cylinder;
  }

  std::vector<Vector3> read_places(const std::string& key) {
    if (file_.holds_text(key)) return read_file_of_places(key);
    std::vector<std::vector<double>> rows;
    file_.number_rows(key, 3, rows);
    std::vector<Vector3> places;
    for (const std::vector<double>& row : rows) places.push_back(metres_from(row));
    return places;
  }

  std::vector<Vector3> read_file_of_places(const std::string& key) {
    std::string path;
    file_.text(key, path);
    Result<std::vector<Vector3>> places = read_positions_(path_beside(name_, path));
    if (places) return *std::move(places);
    if (!failure_) failure_ = places.error();
    return {};
  }

  ConfigFile file_;
  std::string name_;
  const ReadPositions& read_positions_;
  std::optional<Error> failure_;  // of a file of positions
};

}  // namespace

Result<SuitDescription> suit_from_toml(std::string_view text, const std::string& name,
                                       const ReadPositions& read_positions) {
  Result<ConfigFile> file = ConfigFile::parse(text, name);
  if (!file) return file.error();
  return SuitReader(*std::move(file), name, read_positions).read();
}

Result<SuitDescription> read_suit(const std::string& path) {
  Result<ConfigFile> file = ConfigFile::read(path);
  if (!file) return file.error();
  const ReadPositions read = [](const std::string& positions) { return read_positions(positions); };
  return SuitReader(*std::move(file), path, read).read();
}

}  // namespace dermis::bytes::files
