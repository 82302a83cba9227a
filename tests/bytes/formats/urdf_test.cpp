// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/urdf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr const char* kArm = R"(<?xml version="1.0"?>
<robot name="arm">
  <material name="skin"><color rgba="0.8 0.7 0.6 1"/></material>
  <link name="trunk">
    <visual>
      <origin xyz="0 0 0.5" rpy="0 0 1.5707963267948966"/>
      <geometry><box size="0.2 0.3 1"/></geometry>
      <material name="skin"/>
    </visual>
    <visual><geometry><sphere radius="0.1"/></geometry></visual>
    <collision><geometry><box size="9 9 9"/></geometry></collision>
    <inertial><origin xyz="7 7 7"/><mass value="1"/></inertial>
  </link>
  <link name="forearm">
    <visual>
      <geometry><cylinder radius="0.04" length="0.25"/></geometry>
      <material name="own"><color rgba="1 0 0 0.5"/></material>
    </visual>
    <visual><geometry><mesh filename="package://arm/meshes/hand.stl" scale="0.001 0.001 0.001"/></geometry></visual>
  </link>
  <joint name="elbow" type="revolute">
    <origin xyz="0.1 0.2 0.3" rpy="0 0 0"/>
    <parent link="trunk"/>
    <child link="forearm"/>
    <axis xyz="0 0 2"/>
    <limit lower="-0.5" upper="2.5" effort="1" velocity="1"/>
  </joint>
  <transmission name="t"><joint name="elbow"/></transmission>
  <gazebo reference="trunk"><visual><geometry><box size="1 1 1"/></geometry></visual></gazebo>
</robot>
)";

TEST(Urdf, gives_links_joints_and_what_is_seen) {
  const Result<Body> body = body_from_urdf(kArm, "arm.urdf");
  ASSERT_TRUE(body.has_value()) << body.error().message;
  EXPECT_EQ(body->name, "arm");
  ASSERT_EQ(body->links.size(), 2U);
  const std::vector<BodyVisual>& trunk = body->links[0].visuals;
  ASSERT_EQ(trunk.size(), 2U) << "collisions and what is of gazebo are not seen";
  EXPECT_EQ(std::get<BoxSolid>(trunk[0].solid).size, (Vector3{0.2, 0.3, 1.0}));
  EXPECT_EQ(trunk[0].link_from_visual.translation, (Vector3{0.0, 0.0, 0.5}));
  EXPECT_NEAR(trunk[0].link_from_visual.rotation.z, std::numbers::sqrt2 / 2.0, 1e-12);
  EXPECT_EQ(trunk[0].rgba, (std::array{0.8, 0.7, 0.6, 1.0})) << "of the material that is named";
  EXPECT_EQ(std::get<SphereSolid>(trunk[1].solid).radius_m, 0.1);
  EXPECT_FALSE(trunk[1].rgba.has_value());
  const std::vector<BodyVisual>& forearm = body->links[1].visuals;
  ASSERT_EQ(forearm.size(), 2U);
  EXPECT_EQ(std::get<CylinderSolid>(forearm[0].solid).length_m, 0.25);
  EXPECT_EQ(forearm[0].rgba, (std::array{1.0, 0.0, 0.0, 0.5}));
  EXPECT_EQ(std::get<MeshSolid>(forearm[1].solid).file, "package://arm/meshes/hand.stl");
  EXPECT_EQ(std::get<MeshSolid>(forearm[1].solid).scale, (Vector3{0.001, 0.001, 0.001}));
  ASSERT_EQ(body->joints.size(), 1U);
  const BodyJoint& elbow = body->joints.front();
  EXPECT_EQ(elbow.kind, BodyJoint::Kind::turning);
  EXPECT_EQ(elbow.parent_from_child.translation, (Vector3{0.1, 0.2, 0.3}));
  EXPECT_EQ(elbow.axis, (Vector3{0.0, 0.0, 1.0}));
  EXPECT_EQ(elbow.lowest, -0.5);
  EXPECT_EQ(elbow.highest, 2.5);
}

std::string robot(const std::string& inside) {
  return "<robot name=\"r\">\n" + inside + "</robot>\n";
}

std::string seen(const std::string& geometry) {
  return robot("<link name=\"a\"><visual><geometry>" + geometry + "</geometry></visual></link>");
}

TEST(Urdf, says_in_one_line_what_is_wrong_and_where) {
  const std::string two = "<link name=\"a\"/><link name=\"b\"/>";
  const auto joint = [&](const std::string& attributes, const std::string& inside) {
    return robot(two + "<joint " + attributes + ">" + inside + "</joint>");
  };
  const std::string ends = "<parent link=\"a\"/><child link=\"b\"/>";
  const std::vector<std::pair<std::string, std::string>> all = {
      {"", "is no XML"},
      {"<sdf/>", "begins with <sdf>, not with <robot>"},
      {"<!DOCTYPE robot [<!ENTITY a \"b\">]><robot/>", "has a document type"},
      {"<robot name=\"r\"><link name=\"a\"></robot>", "is no XML"},
      {robot(""), "there is no link"},
      {robot("<link/>"), ":2: <link> needs name"},
      {robot("<link name=\"a&#10;b\"/>"), "several lines"},
      {robot(two), "several links hang from no joint"},
      {joint("name=\"j\" type=\"hinge\"", ends), "'hinge' is no type of a joint"},
      {joint("name=\"j\" type=\"fixed\"", "<parent link=\"a\"/><child link=\"c\"/>"), "there is no link 'c'"},
      {joint("name=\"j\" type=\"fixed\"", "<parent link=\"a\"/>"), "there is no link ''"},
      {joint("name=\"j\" type=\"revolute\"", ends + "<axis xyz=\"0 0 0\"/>"), "its axis has no direction"},
      {joint("name=\"j\" type=\"revolute\"", ends + "<axis xyz=\"0 0\"/>"), "xyz: must be 3 numbers"},
      {joint("name=\"j\" type=\"revolute\"", ends + "<origin rpy=\"0 0 nan\"/>"), "rpy: must be 3 numbers"},
      {seen("<box size=\"1 1 0\"/>"), "the sides of a box must be more than 0 m"},
      {seen("<box size=\"1 1 1 1\"/>"), "size: must be 3 numbers"},
      {seen("<cylinder radius=\"1\"/>"), "<cylinder> needs length"},
      {seen("<sphere radius=\"-1\"/>"), "radius: must be more than 0 m"},
      {seen("<mesh/>"), "<mesh> needs filename"},
      {seen("<cone radius=\"1\"/>"), "not a <cone>"}};
  for (const auto& [text, error] : all) {
    const Result<Body> body = body_from_urdf(text, "r.urdf");
    ASSERT_FALSE(body.has_value()) << text;
    EXPECT_NE(body.error().message.find(error), std::string::npos) << text << ": " << body.error().message;
    EXPECT_TRUE(body.error().message.starts_with("r.urdf:")) << body.error().message;
    EXPECT_EQ(body.error().message.find('\n'), std::string::npos);
  }
}

TEST(Urdf, asks_for_no_axis_of_a_fixed_joint_and_takes_no_limits_of_a_continuous_one) {
  const std::string links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>";
  const std::string fixed =
      "<joint name=\"i\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/>"
      "<axis xyz=\"0 0 0\"/></joint>";
  const std::string wheel =
      "<joint name=\"j\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/>"
      "<axis xyz=\"0 0 1\"/><limit lower=\"0\" upper=\"0\"/></joint>";
  const Result<Body> body = body_from_urdf(robot(links + fixed + wheel), "r.urdf");
  ASSERT_TRUE(body.has_value()) << body.error().message;
  const std::vector<Pose> poses = link_poses(*body, std::vector<double>{0.0, 1.0});
  EXPECT_NEAR(poses[2].rotation.z, std::sin(0.5), 1e-12);
}

TEST(Urdf, skips_elements_in_places_where_they_mean_nothing) {
  const std::string color = "<color rgba=\"1 0 0 1\"/>";
  const Result<Body> body =
      body_from_urdf(robot("<material name=\"m\"><x>" + color +
                           "</x></material><color/><visual><geometry/></visual><link name=\"a\"/>"),
                     "r.urdf");
  ASSERT_TRUE(body.has_value()) << body.error().message;
  EXPECT_TRUE(body->links[0].visuals.empty());
}

TEST(Urdf, is_bounded) {
  std::string links;
  for (int k = 0; k < 513; ++k) links += "<link name=\"l" + std::to_string(k) + "\"/>";
  std::string deep;
  for (int k = 0; k < 100; ++k) deep += "<a>";
  for (const std::string& text : {robot(links), robot(deep), std::string((std::size_t{4} << 20U) + 1, ' '),
                                  robot("<link name=\"" + std::string(300, 'x') + "\"/>")}) {
    EXPECT_FALSE(body_from_urdf(text, "r.urdf").has_value());
  }
}

TEST(Urdf, reads_a_file_and_names_it) {
  const support::TemporaryFolder folder;
  const Result<Body> missing = read_urdf(folder.file("none.urdf"));
  ASSERT_FALSE(missing.has_value());
  EXPECT_NE(missing.error().message.find("none.urdf"), std::string::npos);
}

}  // namespace
}  // namespace dermis::bytes::formats
