// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/frame_picture.hpp"

#include <gif_lib.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "dermis/out/report/heat_map.hpp"

namespace dermis::out::report {
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

/// A PNG file, read by libpng.
struct Pixels {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> rgb;
};

Pixels pixels_of(const FramePicture& picture) {
  const std::string file = frame_png(picture).value();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  Pixels pixels{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr), 0) << image.message;
  return pixels;
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

/// A GIF file, read by giflib.
class Film {
 public:
  explicit Film(std::string bytes) : bytes_(std::move(bytes)) {
    const auto read = [](GifFileType* file, GifByteType* into, int size) {
      auto& left = *static_cast<std::string*>(file->UserData);
      const std::string piece = left.substr(0, static_cast<std::size_t>(size));
      std::copy(piece.begin(), piece.end(), into);
      left.erase(0, piece.size());
      return static_cast<int>(piece.size());
    };
    file_ = DGifOpen(&bytes_, read, nullptr);
    EXPECT_EQ(DGifSlurp(file_), GIF_OK);
  }
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;
  ~Film() { DGifCloseFile(file_, nullptr); }

  [[nodiscard]] const GifFileType& file() const { return *file_; }
  [[nodiscard]] int hundredths(int picture) const {
    GraphicsControlBlock control{};
    EXPECT_EQ(DGifSavedExtensionToGCB(file_, picture, &control), GIF_OK);
    return control.DelayTime;
  }
  [[nodiscard]] Colour at(int picture, int x, int y) const {
    const GifColorType colour = file_->SColorMap->Colors[file_->SavedImages[picture].RasterBits[y * file_->SWidth + x]];
    return {colour.Red, colour.Green, colour.Blue};
  }

 private:
  std::string bytes_;
  GifFileType* file_;
};

TEST(ForceScale, ends_at_one_two_or_five_times_a_power_of_ten_and_at_one_at_least) {
  EXPECT_EQ(force_scale(0.0), 1.0);
  EXPECT_EQ(force_scale(1.0), 1.0);
  EXPECT_EQ(force_scale(1.1), 2.0);
  EXPECT_EQ(force_scale(3.0), 5.0);
  EXPECT_EQ(force_scale(5.1), 10.0);
  EXPECT_EQ(force_scale(120.0), 200.0);
}

TEST(LargestOf, counts_finite_values_alone) {
  EXPECT_EQ(largest_of({}), 0.0);
  EXPECT_EQ(largest_of({NAN, 2.0, INFINITY, 1.0}), 2.0);
}

TEST(FramePicture, a_taxel_has_the_colour_of_its_value_on_the_scale) {
  FramePicture picture = picture_of(4, 4);
  picture.values[5] = 2.5;
  const Colour half = sequential_colour(0.5);
  const std::size_t scale = pixels_with(pixels_of(picture_of(4, 4)), half);
  const std::size_t with_taxel = pixels_with(pixels_of(picture), half);
  EXPECT_GT(with_taxel, scale + 36100);  // of 190 x 190 pixels
  EXPECT_LT(with_taxel, scale + 40001);
  EXPECT_NE(frame_drawing(picture).elements.find(to_hex(half)), std::string::npos);
}

TEST(FramePicture, of_one_array_has_one_size) {
  FramePicture picture = picture_of(16, 10);
  const Pixels empty = pixels_of(picture);
  picture.title = "a longer name, (1/2)";
  picture.contacts = {contact_at(0.05, 0.07)};
  picture.values[3] = 1e30;
  const Pixels full = pixels_of(picture);
  EXPECT_EQ(full.width, empty.width);
  EXPECT_EQ(full.height, empty.height);
}

TEST(FramePicture, texts_are_drawn_whatever_their_bytes) {
  FramePicture picture = picture_of(4, 4);
  const std::size_t paper = pixels_with(pixels_of(picture), {255, 255, 255});
  picture.title = "chest \xff left";
  EXPECT_LT(pixels_with(pixels_of(picture), {255, 255, 255}), paper);
}

TEST(FramePicture, a_film_has_every_picture_for_its_time_and_plays_for_ever) {
  std::vector<FramePicture> pictures(3, picture_of(4, 4));
  for (std::size_t i = 0; i < 3; ++i) pictures[i].values[5] = 2.5 * static_cast<double>(i);
  const std::string bytes = frame_film(pictures, std::chrono::milliseconds(40)).value();
  EXPECT_NE(bytes.find(std::string("\x0bNETSCAPE2.0\x03\x01\0\0\0", 17)), std::string::npos);
  const Film film(bytes);
  const Pixels still = pixels_of(pictures[0]);
  EXPECT_EQ(film.file().SWidth, still.width);
  EXPECT_EQ(film.file().SHeight, still.height);
  ASSERT_EQ(film.file().ImageCount, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(film.hundredths(i), 4);
    const Colour shown = film.at(i, 2 * (44 + 150), 2 * (74 + 150));  // in r1c1
    const Colour value = sequential_colour(0.5 * i);
    EXPECT_NEAR(shown.red, value.red, 3) << i;
    EXPECT_NEAR(shown.green, value.green, 3) << i;
    EXPECT_NEAR(shown.blue, value.blue, 3) << i;
  }
}

TEST(FramePicture, contacts_carry_their_forces) {
  FramePicture picture = picture_of(16, 16);
  picture.contacts = {contact_at(0.05, 0.07)};
  EXPECT_NE(frame_drawing(picture).elements.find(">12.3 N<"), std::string::npos);
  const Colour white{255, 255, 255};
  EXPECT_GT(pixels_with(pixels_of(picture), white), pixels_with(pixels_of(picture_of(16, 16)), white));
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
    EXPECT_GT(pixels_of(picture).rgb.size(), 0U);
  }
}

}  // namespace
}  // namespace dermis::out::report
