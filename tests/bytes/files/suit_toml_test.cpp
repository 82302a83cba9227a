// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/suit_toml.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

constexpr const char* kComplete = R"([suit]
name = "body"
classes = "hugs.safetensors"

[[array]]
name = "chest"
from = "sim:multitouch?rate=200&seed=1"
model = "chest.safetensors"
classes = "touches.safetensors"
base_from_array = {translation_mm = [-75, 100.5, 1e2], rotation_deg = [90, 0, 0]}

[[array]]
name = "arm"
from = "arm.mcap"
model = "models/arm.safetensors"
mirrored = true
cylinder = {axis = "x", radius_mm = 45}

[[array]]
name = "hand"
from = "serial:///dev/ttyACM0"
model = "/m/hand.safetensors"
positions_mm = [[0, 0, 0], [10, 0, -1.5]]

[[array]]
name = "foot"
from = "foot.csv"
model = "foot.safetensors"
positions_mm = "foot_places.csv"
)";

constexpr double kRoundOff = 1e-12;

Result<std::vector<Vector3>> no_positions(const std::string& path) {
  return bad_input(path + ": cannot be read");
}

Result<std::vector<Vector3>> one_position(const std::string&) {
  return std::vector<Vector3>{{1.0, 2.0, 3.0}};
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = kComplete;
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

std::string error_of(const std::string& text) {
  const Result<SuitDescription> suit = suit_from_toml(text, "suit.toml", one_position);
  if (suit) return "no error";
  EXPECT_EQ(suit.error().kind, ErrorKind::bad_input);
  return suit.error().message;
}

TEST(SuitToml, reads_every_key) {
  const Result<SuitDescription> suit = suit_from_toml(kComplete, "suit.toml", one_position);
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->name, "body");
  EXPECT_EQ(suit->classes, "hugs.safetensors");
  ASSERT_EQ(suit->arrays.size(), 4U);
  const SuitArray& chest = suit->arrays[0];
  EXPECT_EQ(chest.classes, "touches.safetensors");
  EXPECT_EQ(suit->arrays[1].classes, "");
  EXPECT_EQ(chest.name, "chest");
  EXPECT_EQ(chest.from, "sim:multitouch?rate=200&seed=1");
  EXPECT_EQ(chest.model, "chest.safetensors");
  EXPECT_FALSE(chest.mirrored);
  EXPECT_TRUE(std::holds_alternative<FlatShape>(chest.shape));
  EXPECT_EQ(chest.base_from_array.translation, (Vector3{-0.075, 0.1005, 0.1}));
  const SuitArray& arm = suit->arrays[1];
  EXPECT_TRUE(arm.mirrored);
  EXPECT_EQ(arm.base_from_array, Pose{});
  EXPECT_EQ(arm.shape, (ArrayShape{CylinderShape{CylinderShape::Axis::x, 0.045}}));
  EXPECT_EQ(suit->arrays[2].shape, (ArrayShape{FreeShape{{{0.0, 0.0, 0.0}, {0.010, 0.0, -0.0015}}}}));
  EXPECT_EQ(suit->arrays[3].shape, (ArrayShape{FreeShape{{{1.0, 2.0, 3.0}}}}));
}

TEST(SuitToml, reads_the_body_and_the_link_of_an_array) {
  const std::string array = "[[array]]\nname = \"chest\"\nfrom = \"sim:idle\"\nmodel = \"m\"\nlink = \"torso\"\n";
  const Result<SuitDescription> suit =
      suit_from_toml("[suit]\nbody = \"robot.stl\"\nbody_scale = 0.001\n" + array, "s/suit.toml", no_positions);
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->body, "s/robot.stl");
  EXPECT_EQ(suit->body_scale, 0.001);
  EXPECT_EQ(suit->arrays[0].link, "torso");
  EXPECT_EQ(error_of(array), "suit.toml: array 'chest': link: needs the body of the suit");
}

TEST(SuitToml, turns_by_roll_pitch_and_yaw_about_fixed_axes_in_this_order) {
  const Result<SuitDescription> suit = suit_from_toml(with("[90, 0, 0]", "[90, 30, -60]"), "suit.toml", one_position);
  ASSERT_TRUE(suit) << suit.error().message;
  ArrayDescription array;
  array.rows = 2;
  array.cols = 2;
  const SuitArray& chest = suit->arrays[0];
  const ArraySurface surface = ArraySurface::create(array, chest.shape, {{}, chest.base_from_array.rotation}).value();
  // x stays under the roll, falls by the pitch, and is swung by the yaw
  const Vector3 x = surface.along({}, {1.0, 0.0});
  const double pitched = std::cos(std::numbers::pi / 6.0);
  EXPECT_NEAR(x.x, pitched * 0.5, kRoundOff);
  EXPECT_NEAR(x.y, -pitched * std::sin(std::numbers::pi / 3.0), kRoundOff);
  EXPECT_NEAR(x.z, -0.5, kRoundOff);
  // y becomes z by the roll, leans forward by the pitch
  const Vector3 y = surface.along({}, {0.0, 1.0});
  EXPECT_NEAR(y.x, 0.5 * 0.5, kRoundOff);
  EXPECT_NEAR(y.y, -0.5 * std::sin(std::numbers::pi / 3.0), kRoundOff);
  EXPECT_NEAR(y.z, pitched, kRoundOff);
}

TEST(SuitToml, takes_paths_from_the_folder_of_the_file_and_leaves_uris) {
  std::string asked;
  const Result<SuitDescription> suit = suit_from_toml(kComplete, "/body/suit.toml", [&](const std::string& path) {
    asked = path;
    return one_position(path);
  });
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->arrays[0].from, "sim:multitouch?rate=200&seed=1");
  EXPECT_EQ(suit->arrays[0].model, "/body/chest.safetensors");
  EXPECT_EQ(suit->arrays[1].from, "/body/arm.mcap");
  EXPECT_EQ(suit->arrays[1].model, "/body/models/arm.safetensors");
  EXPECT_EQ(suit->arrays[2].from, "serial:///dev/ttyACM0");
  EXPECT_EQ(suit->arrays[2].model, "/m/hand.safetensors");
  EXPECT_EQ(asked, "/body/foot_places.csv");
}

TEST(SuitToml, needs_little) {
  const Result<SuitDescription> suit =
      suit_from_toml("[[array]]\nname = \"a\"\nfrom = \"stdin:\"\nmodel = \"m\"\n", "suit.toml", no_positions);
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->name, SuitDescription{}.name);
  EXPECT_EQ(suit->arrays[0].base_from_array, Pose{});
}

TEST(SuitToml, refuses_what_is_missing) {
  EXPECT_EQ(error_of(""), "suit.toml: array: must be 1 to 256 arrays");
  EXPECT_EQ(error_of(with("from = \"arm.mcap\"\n", "")), "suit.toml: array[1].from: is missing; it has no default");
  EXPECT_EQ(error_of(with("name = \"chest\"\n", "")), "suit.toml: array[0].name: is missing; it has no default");
  EXPECT_EQ(error_of(with("\"x\", radius_mm = 45", "\"x\"")),
            "suit.toml: array[1].cylinder.radius_mm: is missing; it has no default");
}

TEST(SuitToml, refuses_a_misspelt_key_with_the_nearest_known) {
  EXPECT_EQ(error_of(with("mirrored", "mirored")),
            "suit.toml:16: unknown key 'array[1].mirored'; did you mean 'array[1].mirrored'?");
  EXPECT_EQ(error_of(with("cylinder", "cylindre")),
            "suit.toml:17: unknown table 'array[1].cylindre'; did you mean 'array[1].cylinder'?");
  EXPECT_EQ(error_of(with("rotation_deg", "rotation_degs")),
            "suit.toml:10: unknown key 'array[0].base_from_array.rotation_degs'; did you mean "
            "'array[0].base_from_array.rotation_deg'?");
  EXPECT_EQ(error_of(with("[[array]]", "[[arrays]]")), "suit.toml:5: unknown key 'arrays'; did you mean 'array'?");
  EXPECT_EQ(error_of(with("[suit]", "[suite]")), "suit.toml:1: unknown table 'suite'; did you mean 'suit'?");
}

TEST(SuitToml, refuses_values_that_cannot_be) {
  EXPECT_EQ(error_of(with("[-75, 100.5, 1e2]", "[-75, 100.5]")),
            "suit.toml:10: array[0].base_from_array.translation_mm: must be a list of 3 numbers, has 2");
  EXPECT_EQ(error_of(with("\"x\"", "\"z\"")), "suit.toml:17: array[1].cylinder.axis: must be \"x\" or \"y\"");
  EXPECT_EQ(error_of(with("= 45", "= 0")), "suit.toml:17: array[1].cylinder.radius_mm: must be more than 0 mm");
  EXPECT_EQ(error_of(with("[10, 0, -1.5]", "[10, 0]")),
            "suit.toml:23: array[2].positions_mm: must be a list of lists of 3 numbers");
  EXPECT_EQ(error_of(with("mirrored = true", "positions_mm = []")),
            "suit.toml:16: array[1].positions_mm: has no meaning beside cylinder; remove one");
  EXPECT_EQ(
      error_of(with("[[array]]", "[array]")),
      "suit.toml:12:1: Error while parsing table header: cannot redefine existing table 'array' as array-of-tables");
  EXPECT_EQ(error_of("[array]\nname = \"a\"\n"),
            "suit.toml:1: array: must be a list of tables, each begun by [[array]]");
}

TEST(SuitToml, names_the_array_that_validate_refuses) {
  EXPECT_EQ(error_of(with("\"chest\"", "\"the chest\"")),
            "suit.toml: array 'the chest': name: must be a letter, then up to 63 letters, digits or '_'");
  EXPECT_EQ(error_of(with("\"chest\"", "\"hand\"")), "suit.toml: array 'hand': name: is taken by another array");
}

TEST(SuitToml, tells_what_is_wrong_with_a_file_of_positions) {
  const Result<SuitDescription> suit = suit_from_toml(kComplete, "/body/suit.toml", no_positions);
  ASSERT_FALSE(suit);
  EXPECT_EQ(suit.error().message, "/body/foot_places.csv: cannot be read");
}

TEST(SuitToml, reads_files) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("suit.toml"), kComplete);
  const Result<SuitDescription> without = read_suit(folder.file("suit.toml"));
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().message, "cannot open '" + folder.file("foot_places.csv") + "': No such file or directory");
  support::write_bytes(folder.file("foot_places.csv"), "x_mm,y_mm,z_mm\n1,2,3\n4,5.5,-6\n");
  const Result<SuitDescription> suit = read_suit(folder.file("suit.toml"));
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->arrays[3].shape, (ArrayShape{FreeShape{{{0.001, 0.002, 0.003}, {0.004, 0.0055, -0.006}}}}));
  EXPECT_EQ(suit->arrays[1].from, folder.file("arm.mcap"));
}

std::string positions_error(const std::string& text) {
  std::istringstream in(text);
  const Result<std::vector<Vector3>> places = read_positions(in, "p.csv");
  return places ? "no error" : places.error().message;
}

TEST(PositionsCsv, refuses_lines_that_are_no_places) {
  EXPECT_EQ(positions_error(""), "p.csv: is empty; the first line must be x_mm,y_mm,z_mm");
  EXPECT_EQ(positions_error("x,y,z\n"), "p.csv:1: the first line must be x_mm,y_mm,z_mm");
  EXPECT_EQ(positions_error("x_mm,y_mm,z_mm,w_mm\n"), "p.csv:1: the first line must be x_mm,y_mm,z_mm");
  EXPECT_EQ(positions_error("x_mm,y_mm,z_mm\n1,2\n"), "p.csv:2: must be three numbers: x, y and z in mm");
  EXPECT_EQ(positions_error("x_mm,y_mm,z_mm\n1,2,3,4\n"), "p.csv:2: must be three numbers: x, y and z in mm");
  EXPECT_EQ(positions_error("x_mm,y_mm,z_mm\n1,2,3\n1,nan,3\n"), "p.csv:3: must be three numbers: x, y and z in mm");
  EXPECT_EQ(positions_error("x_mm,y_mm,z_mm\n"), "no error");
}

TEST(SuitToml, gives_a_value_or_a_one_line_error_for_mutations) {
  support::expect_value_or_one_line_error(
      kComplete, 3000, [](const std::string& mutated) { return suit_from_toml(mutated, "mutated", one_position); });
  support::expect_value_or_one_line_error("x_mm,y_mm,z_mm\n1,2,3\n4,5.5,-6\n", 1000, [](const std::string& mutated) {
    std::istringstream in(mutated);
    return read_positions(in, "mutated");
  });
}

Result<std::vector<NamedPlace>> places_in(const std::string& text) {
  std::istringstream in(text);
  return read_places(in, "places.csv");
}

TEST(PlacesCsv, has_z_and_names_where_they_are_known) {
  const auto flat = places_in("x_mm,y_mm\n1,2\n");
  ASSERT_TRUE(flat) << flat.error().message;
  EXPECT_EQ(flat->front().position, (Vector3{0.001, 0.002, 0.0}));
  const auto named = places_in("x_mm,y_mm,z_mm,name\n1,2,3,index tip\n4,5,6,\n");
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ((*named)[0].name, "index tip");
  EXPECT_EQ((*named)[1].name, "");
  EXPECT_EQ((*named)[1].position.z, 0.006);
}

TEST(PlacesCsv, is_refused_with_its_line) {
  const std::string header = "places.csv:1: the first line must be x_mm,y_mm, with z_mm, name or both behind them";
  EXPECT_EQ(places_in("x_mm\n1\n").error().message, header);
  EXPECT_EQ(places_in("name,x_mm,y_mm\nthumb,1,2\n").error().message, header);
  const std::string line = "places.csv:2: must be what the first line says: numbers in mm, and a name where it has one";
  for (const char* const text : {"x_mm,y_mm\n1\n", "x_mm,y_mm\n1,2,3\n", "x_mm,y_mm\nnan,2\n", "x_mm,y_mm,name\n1,2\n"})
    EXPECT_EQ(places_in(text).error().message, line) << text;
  EXPECT_EQ(places_in("x_mm,y_mm,name\n1,2,a\x1b[2Jb\n").error().message, line);
}

TEST(PositionsCsv, is_written_as_it_is_read) {
  const std::vector<Vector3> places = {{0.001, -0.0025, 0.0}, {0.0123, 0.0, 0.004}};
  std::istringstream in(positions_csv(places));
  const Result<std::vector<Vector3>> read = read_positions(in, "p.csv");
  ASSERT_TRUE(read) << read.error().message;
  for (std::size_t k = 0; k < places.size(); ++k) EXPECT_NEAR((*read)[k].x, places[k].x, 1e-9);
}

}  // namespace
}  // namespace dermis::bytes::files
