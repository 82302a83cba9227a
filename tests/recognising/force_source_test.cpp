// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/force_source.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "support/force_mat.hpp"

namespace dermis::recognising {
namespace {

using support::error_of;
using support::kPressed;
using support::kShape;
using support::later;
using support::MatFiles;
using support::pressed;

constexpr std::size_t kTaxels = kShape.rows * kShape.cols;
using std::chrono::milliseconds;

/// Loads of the pressed taxels of two arrays in each frame.
std::vector<std::pair<float, float>> pairs_of(ForceSource& source) {
  std::vector<std::pair<float, float>> pairs;
  while (source.next().value()) {
    EXPECT_EQ(source.loads().size(), 2 * kTaxels);
    pairs.emplace_back(source.loads()[kPressed], source.loads()[kTaxels + kPressed]);
  }
  return pairs;
}

learn::recognition::Layout layout(Quantity quantity) {
  learn::recognition::Layout layout;
  layout.quantity = quantity;
  return layout;
}

TEST(CheckLoads, wants_forces_for_classes_of_forces_and_readings_for_those_of_readings) {
  EXPECT_TRUE(check_loads(layout(Quantity::force), "c", "model"));
  EXPECT_TRUE(check_loads(layout(Quantity::counts), "c", ""));
  const Status without = check_loads(layout(Quantity::force), "c", "");
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().message, "model: the classes of c were learned from forces; name the model of the array");
  const Status with = check_loads(layout(Quantity::counts), "c", "model");
  ASSERT_FALSE(with);
  EXPECT_NE(with.error().message.find("leave it out"), std::string::npos);
}

TEST(ForceSource, gives_the_frames_of_one_array) {
  const MatFiles mat;
  Result<ForceSource> source =
      ForceSource::open({.from = mat.write("frames.csv", pressed({3.0F})), .model = mat.model()});
  ASSERT_TRUE(source && source->next().value());
  EXPECT_NEAR(source->loads()[kPressed], 3.0F, 1e-4F);
  EXPECT_EQ(source->time(), std::chrono::seconds(1));
  const auto layout = source->layout();
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->arrays, (std::vector<learn::recognition::SensedArray>{{"mat", 3, 4, 0, 4.0, 10.0}}));
  EXPECT_EQ(layout->readings, kTaxels);
  EXPECT_TRUE(layout->has_forces());
  EXPECT_FALSE(*source->next());
  EXPECT_TRUE(source->describe_troubles().empty());
}

TEST(ForceSource, takes_all_arrays_of_a_recording_side_by_side_at_the_times_of_the_first) {
  const MatFiles mat;
  const std::string recording =
      mat.write_two("two.mcap", pressed({1.0F, 2.0F, 3.0F}), later(pressed({5.0F, 6.0F}), milliseconds(5)));
  Result<ForceSource> source = ForceSource::open({.from = recording});
  ASSERT_TRUE(source) << error_of(source);
  EXPECT_EQ(pairs_of(*source), (std::vector<std::pair<float, float>>{{1.0F, 0.0F}, {2.0F, 5.0F}, {3.0F, 6.0F}}));
  const auto layout = source->layout();
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->arrays,
            (std::vector<learn::recognition::SensedArray>{{"left", 3, 4, 0}, {"right", 3, 4, kTaxels}}));
  EXPECT_EQ(layout->readings, 2 * kTaxels);
  EXPECT_FALSE(layout->has_forces());
}

TEST(ForceSource, takes_of_several_arrays_those_that_are_asked_for) {
  const MatFiles mat;
  const std::string recording = mat.write_two("two.mcap", pressed({1.0F}), pressed({5.0F}));
  Result<ForceSource> turned = ForceSource::open({.from = recording, .arrays = {"right", "left"}});
  ASSERT_TRUE(turned) << error_of(turned);
  EXPECT_EQ(pairs_of(*turned), (std::vector<std::pair<float, float>>{{5.0F, 1.0F}}));
  Result<ForceSource> one = ForceSource::open({.from = recording + "#right"});
  ASSERT_TRUE(one && one->next().value());
  EXPECT_EQ(one->loads().size(), kTaxels);
  EXPECT_EQ(one->loads()[kPressed], 5.0F);
  EXPECT_NE(error_of(ForceSource::open({.from = recording, .arrays = {"left", "top"}})).find("has no array 'top'"),
            std::string::npos);
  EXPECT_NE(error_of(ForceSource::open({.from = recording, .arrays = {"skin"}})).find("name one"), std::string::npos);
}

TEST(ForceSource, gives_newtons_of_several_arrays_by_the_models_of_a_suit) {
  const MatFiles mat;
  const std::string recording = mat.write_two("two.mcap", pressed({1.0F, 2.0F}), pressed({5.0F, 6.0F}));
  Result<ForceSource> source = ForceSource::open({.from = recording, .model = mat.suit()});
  ASSERT_TRUE(source) << error_of(source);
  const auto layout = source->layout();
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->arrays, (std::vector<learn::recognition::SensedArray>{{"right", 3, 4, 0, 4.0, 10.0},
                                                                          {"left", 3, 4, kTaxels, 4.0, 10.0}}));
  EXPECT_TRUE(layout->has_forces());
  const auto pairs = pairs_of(*source);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_NEAR(pairs[1].first, 6.0F, 1e-4F);
  EXPECT_NEAR(pairs[1].second, 2.0F, 1e-4F);
}

TEST(ForceSource, of_several_arrays_wants_a_suit_that_has_them) {
  const MatFiles mat;
  const std::string recording = mat.write_two("two.mcap", pressed({1.0F}), pressed({5.0F}));
  const std::string of_one = error_of(ForceSource::open({.from = recording, .model = mat.model()}));
  EXPECT_EQ(of_one.find("model: " + recording + " holds several arrays; name one, as '" + recording +
                        "#left', or give the suit"),
            0U)
      << of_one;
  EXPECT_EQ(error_of(ForceSource::open({.from = recording, .model = mat.suit(), .arrays = {"left", "top"}})),
            mat.suit() + ": has no array 'top'");
}

TEST(ForceSource, is_tared_where_all_arrays_are) {
  const MatFiles mat;
  std::vector<float> left(150, 40.0F);
  left.back() = 47.0F;
  const std::vector<float> right(150, 30.0F);
  const std::string recording = mat.write_two("two.mcap", pressed(left), later(pressed(right), milliseconds(200)));
  Result<ForceSource> source = ForceSource::open({.from = recording, .tare = true});
  ASSERT_TRUE(source) << error_of(source);
  std::size_t tare_frames = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    ASSERT_TRUE(source->next().value());
    EXPECT_EQ(source->is_tare(), tare_frames == i && i < 120) << i;
    tare_frames += source->is_tare() ? 1 : 0;
  }
  EXPECT_EQ(tare_frames, 120U);
  EXPECT_EQ(source->loads()[kPressed], 7.0F);
  EXPECT_EQ(source->loads()[kTaxels + kPressed], 0.0F);
}

TEST(ForceSource, says_where_an_array_was_silent) {
  const MatFiles mat;
  const std::string recording = mat.write_two("two.mcap", pressed(std::vector<float>(100, 1.0F)), pressed({5.0F}));
  Result<ForceSource> source = ForceSource::open({.from = recording});
  ASSERT_TRUE(source) << error_of(source);
  const auto pairs = pairs_of(*source);
  ASSERT_EQ(pairs.size(), 100U);
  EXPECT_EQ(pairs[50].second, 5.0F);
  EXPECT_EQ(pairs[51].second, 0.0F);
  EXPECT_EQ(source->describe_troubles(),
            (std::vector<std::string>{
                recording + ": 49 frames have none of 'right' in the half second before; it has no load there"}));
}

TEST(ForceSource, has_further_readings_beside_its_frames) {
  const MatFiles mat;
  const std::string frames = mat.write("frames.csv", pressed({1.0F, 2.0F}));
  support::write_bytes(mat.file("joints.csv"), "time_s,elbow,wrist\n0.995,7,\n1.01,8,9\n");
  Result<ForceSource> source = ForceSource::open({.from = frames, .extra = mat.file("joints.csv")});
  ASSERT_TRUE(source) << error_of(source);
  EXPECT_EQ(source->extra_names(), (std::vector<std::string>{"elbow", "wrist"}));
  EXPECT_EQ(source->layout()->extras, 2U);
  ASSERT_TRUE(source->next().value());
  EXPECT_EQ(source->extras()[0], 7.0F);
  EXPECT_TRUE(std::isnan(source->extras()[1]));
  ASSERT_TRUE(source->next().value());
  EXPECT_EQ(std::vector<float>(source->extras().begin(), source->extras().end()), (std::vector<float>{8.0F, 9.0F}));
  ASSERT_EQ(source->describe_troubles().size(), 1U);
  EXPECT_NE(source->describe_troubles()[0].find("joints.csv: 1 of 2 frames of frames.csv"), std::string::npos);
  const std::string device = "sim:idle?rate=10";
  EXPECT_EQ(error_of(ForceSource::open({.from = device, .extra = mat.file("joints.csv")})),
            "extra: '" + device + "' is a device; record it first");
}

}  // namespace
}  // namespace dermis::recognising
