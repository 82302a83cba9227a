// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/suit.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

SuitArray array_named(const std::string& name) {
  return {.name = name, .from = "sim:multitouch", .model = "m.safetensors"};
}

/// What validate() says after one change to a valid suit of two arrays.
template <typename Change>
std::string message_after(const Change& change) {
  SuitDescription suit{.arrays = {array_named("chest"), array_named("arm_left2")}};
  change(suit);
  const Status status = suit.validate();
  if (status) return "valid";
  EXPECT_EQ(status.error().kind, ErrorKind::bad_input);
  return status.error().message;
}

TEST(SuitDescription, is_valid_with_every_field_in_range) {
  EXPECT_EQ(message_after([](SuitDescription&) {}), "valid");
}

TEST(SuitDescription, names_the_array_and_the_field_that_is_wrong) {
  using Suit = SuitDescription;
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays.clear(); }), "array: must be 1 to 256 arrays");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays.resize(257); }), "array: must be 1 to 256 arrays");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[1].name = ""; }),
            "array '': name: must be a letter, then up to 63 letters, digits or '_'");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[1].name = "a/b"; }),
            "array 'a/b': name: must be a letter, then up to 63 letters, digits or '_'");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[1].name = "2nd"; }),
            "array '2nd': name: must be a letter, then up to 63 letters, digits or '_'");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[1].name = std::string(65, 'a'); }),
            "array '" + std::string(65, 'a') + "': name: must be a letter, then up to 63 letters, digits or '_'");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[1].name = "suit"; }),
            "array 'suit': name: 'suit' is the name of the whole; take another");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[1].name = "chest"; }),
            "array 'chest': name: is taken by another array");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[0].from = ""; }),
            "array 'chest': from: must be a device, a simulation or a file of frames");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[0].model = ""; }),
            "array 'chest': model: must be the path of a model file");
  EXPECT_EQ(message_after([](Suit& suit) {
              suit.arrays[0].shape = CylinderShape{CylinderShape::Axis::y, -1.0};
            }),
            "array 'chest': shape.radius_m: must be more than 0 m");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[0].base_from_array.rotation.w = 0.5; }),
            "array 'chest': base_from_array.rotation: must be a quaternion of length 1");
  EXPECT_EQ(message_after([](Suit& suit) { suit.arrays[0].link = "torso"; }),
            "array 'chest': link: needs the body of the suit");
  EXPECT_EQ(message_after([](Suit& suit) { suit.body_scale = 0.0; }), "body_scale: must be more than 0");
}

}  // namespace
}  // namespace dermis
