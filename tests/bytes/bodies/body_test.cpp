// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/body.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

namespace dermis {
namespace {

constexpr double kRightAngle = 0.5 * std::numbers::pi;

/// An arm along x: a shoulder that turns about z, an elbow 1 m further, a slide at the end; written in a wild order.
Body arm() {
  Body body;
  body.name = "arm";
  body.links = {{"hand"}, {"forearm"}, {"trunk"}, {"upper"}};
  BodyJoint slide{"slide", BodyJoint::Kind::sliding, 1, 0, {{0.5, 0.0, 0.0}, {}}, {2.0, 0.0, 0.0}, 0.0, 0.1};
  BodyJoint elbow{"elbow", BodyJoint::Kind::turning, 3, 1, {{1.0, 0.0, 0.0}, {}}, {0.0, 0.0, 5.0}};
  BodyJoint shoulder{"shoulder", BodyJoint::Kind::turning, 2, 3, {{0.0, 0.0, 1.0}, {}}, {0.0, 0.0, 1.0}, -2.0, 2.0};
  body.joints = {slide, elbow, shoulder};
  return body;
}

void expect_near(const Vector3& a, const Vector3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

TEST(Body, is_ordered_from_its_first_link_on) {
  const Result<Body> body = make_body(arm());
  ASSERT_TRUE(body.has_value()) << body.error().message;
  std::vector<std::string> links;
  for (const BodyLink& link : body->links) links.push_back(link.name);
  EXPECT_EQ(links, (std::vector<std::string>{"trunk", "upper", "forearm", "hand"}));
  EXPECT_EQ(body->joints[0].name, "shoulder");
  EXPECT_EQ(body->link("hand"), 3U);
  EXPECT_FALSE(body->link("tail").has_value());
}

TEST(Body, joints_carry_what_hangs_from_them) {
  const Result<Body> body = make_body(arm());
  ASSERT_TRUE(body.has_value());
  const std::vector<Pose> straight = link_poses(*body, std::array{0.0, 0.0, 0.0});
  expect_near(straight[3].translation, {1.5, 0.0, 1.0});
  const std::vector<Pose> bent = link_poses(*body, std::array{kRightAngle, kRightAngle, 0.05});
  expect_near(bent[1].translation, {0.0, 0.0, 1.0});
  expect_near(bent[2].translation, {0.0, 1.0, 1.0});
  expect_near(bent[3].translation, {-0.55, 1.0, 1.0});
  expect_near(turned(bent[3], {1.0, 0.0, 0.0}), {-1.0, 0.0, 0.0});
}

TEST(Body, a_joint_stops_at_its_limits) {
  const Result<Body> body = make_body(arm());
  ASSERT_TRUE(body.has_value());
  expect_near(link_poses(*body, std::array{0.0, 0.0, 7.0})[3].translation, {1.6, 0.0, 1.0});
  expect_near(link_poses(*body, std::array{0.0, 0.0, -7.0})[3].translation, {1.5, 0.0, 1.0});
}

TEST(Body, an_inverse_takes_a_move_back) {
  const Pose move{{1.0, 2.0, 3.0}, rotation_of(0.3, -0.7, 2.0)};
  const Pose none = chained(inverse(move), move);
  expect_near(none.translation, {});
  expect_near(turned(none, {1.0, 2.0, 3.0}), {1.0, 2.0, 3.0});
  expect_near(moved(inverse(move), moved(move, {4.0, 5.0, 6.0})), {4.0, 5.0, 6.0});
}

TEST(Body, turns_about_x_then_y_then_z) {
  const Pose turn{{}, rotation_of(kRightAngle, 0.0, kRightAngle)};
  expect_near(turned(turn, {0.0, 1.0, 0.0}), {0.0, 0.0, 1.0});
  expect_near(turned(turn, {1.0, 0.0, 0.0}), {0.0, 1.0, 0.0});
}

struct Broken {
  const char* why;
  void (*breaks)(Body&);
  const char* error;
};

TEST(Body, says_what_is_wrong_with_it) {
  const std::vector<Broken> all = {
      {"no link", [](Body& body) { body = {}; }, "there is no link"},
      {"two of a name", [](Body& body) { body.links[0].name = "upper"; }, "link 'upper': is there twice"},
      {"two joints of a name", [](Body& body) { body.joints[0].name = "elbow"; }, "joint 'elbow': is there twice"},
      {"two parents", [](Body& body) { body.joints[0].child = 1; }, "link 'forearm': hangs from two joints"},
      {"two firsts", [](Body& body) { body.joints.pop_back(); }, "several links hang from no joint"},
      {"a loop beside a first",
       [](Body& body) {
         body.joints[2].parent = 0;
         body.links.push_back({"ghost"});
       },
       "several"},
      {"a loop",
       [](Body& body) {
         body.joints.push_back(body.joints[0]);
         body.joints.back().name = "back";
         body.joints.back().child = 2;
       },
       "the joints go round"},
      {"no axis", [](Body& body) { body.joints[0].axis = {}; }, "joint 'slide': its axis has no direction"},
      {"limits", [](Body& body) { body.joints[0].lowest = 1.0; }, "joint 'slide': its limits are the wrong way round"}};
  for (const Broken& broken : all) {
    Body body = arm();
    broken.breaks(body);
    const Result<Body> made = make_body(std::move(body));
    ASSERT_FALSE(made.has_value()) << broken.why;
    EXPECT_NE(made.error().message.find(broken.error), std::string::npos) << broken.why << ": " << made.error().message;
  }
}

}  // namespace
}  // namespace dermis
