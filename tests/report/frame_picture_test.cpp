// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/report/frame_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dermis/report/heat_map.hpp"

namespace dermis::report {
namespace {

FramePicture picture_of(std::size_t rows, std::size_t cols) {
  FramePicture picture;
  picture.title = "chest";
  picture.subtitle = "1.5 s";
  picture.rows = rows;
  picture.cols = cols;
  picture.values.assign(rows * cols, 0.0);
  picture.high = 5.0;
  picture.unit = "N";
  return picture;
}

Contact contact_at(double x, double y) {
  Contact contact;
  contact.phase = ContactPhase::held;
  contact.position = {x, y};
  contact.force_n = 12.34;
  contact.area_m2 = 4e-4;
  contact.major_axis_m = 0.01;
  contact.minor_axis_m = 0.005;
  return contact;
}

std::size_t pixels_with(const Pixels& pixels, Colour colour) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels.rgb.size(); i += 3) {
    const bool is_it =
        pixels.rgb[i] == colour.red && pixels.rgb[i + 1] == colour.green && pixels.rgb[i + 2] == colour.blue;
    count += is_it ? 1 : 0;
  }
  return count;
}

TEST(FramePicture, a_taxel_has_the_colour_of_its_value_on_the_scale) {
  FramePicture picture = picture_of(4, 4);
  picture.values[5] = 2.5;
  const Colour half = sequential_colour(0.5);
  const std::size_t scale = pixels_with(frame_pixels(picture_of(4, 4)), half);
  const std::size_t with_taxel = pixels_with(frame_pixels(picture), half);
  EXPECT_GT(with_taxel, scale + 36100);  // of 190 x 190 pixels
  EXPECT_LT(with_taxel, scale + 40001);
  EXPECT_NE(frame_drawing(picture).elements.find(to_hex(half)), std::string::npos);
}

TEST(FramePicture, of_one_array_has_one_size) {
  FramePicture picture = picture_of(16, 10);
  const Pixels empty = frame_pixels(picture);
  picture.title = "a longer name, (1/2)";
  picture.contacts = {contact_at(0.05, 0.07)};
  picture.values[3] = 1e30;
  const Pixels full = frame_pixels(picture);
  EXPECT_EQ(full.width, empty.width);
  EXPECT_EQ(full.height, empty.height);
  EXPECT_EQ(full.rgb.size(), 3 * full.width * full.height);
}

TEST(FramePicture, contacts_carry_their_forces) {
  FramePicture picture = picture_of(16, 16);
  picture.contacts = {contact_at(0.05, 0.07)};
  EXPECT_NE(frame_drawing(picture).elements.find(">12.3 N<"), std::string::npos);
  const Colour white{255, 255, 255};
  EXPECT_GT(pixels_with(frame_pixels(picture), white), pixels_with(frame_pixels(picture_of(16, 16)), white));
  picture.contacts[0].phase = ContactPhase::release;
  EXPECT_EQ(frame_drawing(picture).elements.find("12.3 N"), std::string::npos);
}

TEST(FramePicture, any_values_and_shapes_are_drawn) {
  for (const auto& [rows, cols] : {std::pair<std::size_t, std::size_t>{1, 1}, {1, 300}, {300, 1}, {64, 160}}) {
    FramePicture picture = picture_of(rows, cols);
    picture.title = "\xc3\xbc<&\"'";
    picture.values[0] = std::numeric_limits<double>::quiet_NaN();
    picture.values.back() = -std::numeric_limits<double>::infinity();
    picture.contacts = {contact_at(0.0, 0.0), contact_at(-1.0, 7.0)};
    picture.contacts[0].minor_axis_m = 0.0;
    const std::string elements = frame_drawing(picture).elements;
    EXPECT_EQ(elements.find("nan"), std::string::npos);
    EXPECT_EQ(elements.find("inf"), std::string::npos);
    EXPECT_GT(frame_pixels(picture).rgb.size(), 0U);
  }
}

}  // namespace
}  // namespace dermis::report
