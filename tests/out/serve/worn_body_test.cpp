// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/worn_body.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "out/serve/small_suit.hpp"
#include "out/serve/suit/models_in_use.hpp"
#include "out/serve/suit/suit_json.hpp"
#include "out/serve/topics/contacts_in_suit.hpp"
#include "out/serve/topics/suit_transforms.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using support::TemporaryFolder;
using support::write_bytes;

const std::atomic<bool> kNever = false;

/// A forearm that turns about z, 1 m before its trunk.
BodyParts arm() {
  Body body{"arm", {{"trunk", {BodyVisual{{}, SphereSolid{0.1}, {}}}}, {"forearm"}}, {}};
  body.joints.push_back({"elbow", BodyJoint::Kind::turning, 0, 1, {{1.0, 0.0, 0.0}, {}}, {0.0, 0.0, 1.0}, -3.0, 3.0});
  return {*make_body(std::move(body)), {}};
}

const std::vector<std::string> kElbow = {"elbow"};
const std::vector<double> kBent = {0.5 * std::numbers::pi};

/// Two arrays: one on the trunk, one on the forearm.
ServedSuit worn_suit() {
  ServedSuit suit = small_suit({"chest", "arm"}, kNever);
  suit.body = std::make_shared<WornBody>(std::make_shared<BodyParts>(arm()),
                                         std::vector<WornBody::Carried>{{0, {}}, {1, {{0.5, 0.0, 0.0}, {}}}});
  return suit;
}

TEST(WornBody, a_joint_moves_the_arrays_that_hang_from_it) {
  const ServedSuit suit = worn_suit();
  EXPECT_EQ(suit.body->move_of(1), Pose{});
  EXPECT_EQ(suit.body->suit_from_array(1).translation, (Vector3{1.5, 0.0, 0.0}));
  ASSERT_TRUE(suit.body->set_joints(kElbow, kBent));
  EXPECT_EQ(suit.body->move_of(0), Pose{}) << "the trunk stands";
  EXPECT_NEAR(suit.body->suit_from_array(1).translation.x, 1.0, 1e-6);
  EXPECT_NEAR(suit.body->suit_from_array(1).translation.y, 0.5, 1e-6);
  const Vector3 place = moved(suit.body->move_of(1), {1.5, 0.0, 0.2});
  EXPECT_NEAR(place.y, 0.5, 1e-6);
  EXPECT_NEAR(place.z, 0.2, 1e-12);
  EXPECT_EQ(suit.body->at_rest()->suit_from_array(1).translation, (Vector3{1.5, 0.0, 0.0}));
  EXPECT_EQ(suit.body->version(), 1U);
}

TEST(WornBody, joints_that_are_wrong_move_nothing) {
  const ServedSuit suit = worn_suit();
  struct Wrong {
    std::vector<std::string> names;
    std::vector<double> positions;
  };
  for (const Wrong& wrong : {Wrong{{"elbow"}, {}}, Wrong{{"knee"}, {1.0}}, Wrong{{"elbow", "knee"}, {1.0, 1.0}},
                             Wrong{{"elbow"}, {std::nan("")}}}) {
    const Status set = suit.body->set_joints(wrong.names, wrong.positions);
    ASSERT_FALSE(set.has_value()) << wrong.names.back();
    EXPECT_EQ(set.error().message.find('\n'), std::string::npos);
  }
  EXPECT_EQ(suit.body->suit_from_links(), suit.body->rest());
  EXPECT_EQ(suit.body->version(), 0U);
}

TEST(WornBody, contacts_are_where_their_array_is_now) {
  const ServedSuit suit = worn_suit();
  const RawFrame raw;
  const ConductanceFrame conductance;
  const ForceFrame force;
  const ContactReport report;
  const std::vector<SuitContact> contacts = {{1, {}, {{1.6, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {0.0, 0.1, 0.0}}};
  const live::suits::ArrayResult result{1, raw, conductance, force, report, contacts};
  ContactsInSuit in_suit(suit, 1);
  in_suit.take(result);
  EXPECT_EQ(in_suit.contacts().data(), contacts.data()) << "at rest nothing is copied";
  ASSERT_TRUE(suit.body->set_joints(kElbow, kBent));
  in_suit.take(result);
  const SuitContact& now = in_suit.contacts().front();
  EXPECT_NEAR(now.place.position.x, 1.0, 1e-6);
  EXPECT_NEAR(now.place.position.y, 0.6, 1e-6);
  EXPECT_NEAR(now.place.normal.y, 1.0, 1e-6);
  EXPECT_NEAR(now.velocity.x, -0.1, 1e-6);
}

TEST(WornBody, clients_are_told_its_links_and_where_they_are) {
  const ServedSuit suit = worn_suit();
  const ModelsInUse models(suit);
  const nlohmann::json json = nlohmann::json::parse(suit_json(suit, models));
  EXPECT_EQ(json["arrays"][1]["link"], "forearm");
  EXPECT_EQ(json["arrays"][1]["pose"]["rotation"], (std::vector<double>{0.0, 0.0, 0.0, 1.0}));
  const nlohmann::json& body = json["body"];
  EXPECT_EQ(body["name"], "arm");
  EXPECT_EQ(body["joints"], std::vector<std::string>{"elbow"});
  EXPECT_EQ(body["links"][1]["pose"]["position"], (std::vector<double>{1.0, 0.0, 0.0}));
  EXPECT_EQ(body["links"][0]["visuals"][0]["solid"], "sphere");
  EXPECT_EQ(body["links"][0]["visuals"][0]["size"], std::vector<double>{0.1});
  ASSERT_TRUE(suit.body->set_joints(kElbow, kBent));
  const std::vector<bytes::ros_messages::Transform> transforms = suit_transforms(suit);
  ASSERT_EQ(transforms.size(), 4U);
  EXPECT_EQ(transforms[1].child, "arm");
  EXPECT_NEAR(transforms[1].parent_from_child.translation.y, 0.5, 1e-6);
  EXPECT_EQ(transforms[3].child, "body/forearm");
  EXPECT_NEAR(transforms[3].parent_from_child.rotation.z, std::numbers::sqrt2 / 2.0, 1e-6);
}

std::string urdf_with(const std::vector<std::string>& meshes) {
  std::string visuals;
  for (const std::string& mesh : meshes)
    visuals += "<visual><geometry><mesh filename=\"" + mesh + "\"/></geometry></visual>";
  return "<robot name=\"r\"><link name=\"a\">" + visuals + "</link></robot>";
}

TEST(ReadBody, gives_the_meshes_that_lie_in_its_folder) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("robot/meshes"));
  write_bytes(folder.file("secret.stl"), "secret");
  write_bytes(folder.file("robot/meshes/hand.STL"), "hand");
  std::filesystem::create_symlink(folder.file("secret.stl"), folder.file("robot/meshes/link.stl"));
  write_bytes(folder.file("robot/r.urdf"),
              urdf_with({"package://robot/meshes/hand.STL", "meshes/hand.STL", "meshes/hand.STL", "../secret.stl",
                         folder.file("secret.stl"), "meshes/link.stl", "meshes/none.glb", "meshes/hand.dae"}));
  std::vector<std::string> notices;
  const Result<BodyParts> body =
      read_body(folder.file("robot/r.urdf"), 1.0, [&](const std::string& line) { notices.push_back(line); });
  ASSERT_TRUE(body.has_value()) << body.error().message;
  ASSERT_EQ(body->files.size(), 2U);
  EXPECT_EQ(body->files[0].name, "package://robot/meshes/hand.STL");
  EXPECT_EQ(body->files[1].path, "/body/1.stl");
  EXPECT_EQ(body->files[1].bytes, "hand");
  ASSERT_EQ(notices.size(), 5U);
  EXPECT_NE(notices[0].find("../secret.stl is not in the folder of the body; it is not shown"), std::string::npos);
  EXPECT_NE(notices[2].find("is not in the folder"), std::string::npos) << "nor by a symbolic link";
  EXPECT_NE(notices[3].find("is not there"), std::string::npos);
  EXPECT_NE(notices[4].find("is no .stl or .glb"), std::string::npos);
}

TEST(ReadBody, takes_one_mesh_as_a_body) {
  const TemporaryFolder folder;
  write_bytes(folder.file("torso.stl"), "solid");
  const Result<BodyParts> body = read_body(folder.file("torso.stl"), 0.001, {});
  ASSERT_TRUE(body.has_value()) << body.error().message;
  EXPECT_EQ(body->body.name, "torso");
  EXPECT_EQ(std::get<MeshSolid>(body->body.links[0].visuals[0].solid).scale, (Vector3{0.001, 0.001, 0.001}));
  EXPECT_EQ(body->files[0].path, "/body/0.stl");
  write_bytes(folder.file("torso.glb"), "glTF");
  const Result<BodyParts> upright = read_body(folder.file("torso.glb"), 1.0, {});
  ASSERT_TRUE(upright.has_value()) << upright.error().message;
  EXPECT_EQ(turned(upright->body.links[0].visuals[0].link_from_visual, {0.0, 1.0, 0.0}), (Vector3{0.0, 0.0, 1.0}));
}

TEST(ReadBody, refuses_other_files_and_what_is_too_large) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) {
    const Result<BodyParts> body = read_body(folder.file(name), 1.0, {});
    return body ? std::string() : body.error().message;
  };
  EXPECT_NE(refusal("robot.dae").find("a body is a .urdf, .stl or .glb"), std::string::npos);
  EXPECT_NE(refusal("none.glb").find("is not there"), std::string::npos);
  EXPECT_NE(refusal("none.urdf").find("none.urdf"), std::string::npos);
  write_bytes(folder.file("large.stl"), "");
  std::filesystem::resize_file(folder.file("large.stl"), 20'000'001);
  EXPECT_NE(refusal("large.stl").find("more than 20 MB"), std::string::npos);
}

}  // namespace
}  // namespace dermis::out::serve
