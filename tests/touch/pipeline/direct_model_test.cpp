// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/direct_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::touch::pipeline {
namespace {

ArrayDescription array_of(Quantity quantity) {
  ArrayDescription array;
  array.rows = 1;
  array.cols = 5;
  array.taxel_area_m2 = 2e-4;
  array.readout.circuit = Circuit::none;
  array.readout.quantity = quantity;
  array.readout.adc_bits = 24;
  array.readout.adc_noise_counts = 0.25;
  return array;
}

ForceFrame forces_of(const Model& model, const std::vector<float>& readings) {
  Result<Pipeline> pipeline = Pipeline::create(model);
  ForceFrame force;
  EXPECT_TRUE(pipeline) << pipeline.error().message;
  if (!pipeline) return force;
  RawFrame raw;
  raw.counts = readings;
  raw.temperature_celsius = 60.0;  // whoever calibrated the readings answers for it
  pipeline->process(raw, force);
  return force;
}

TEST(DirectModel, gives_the_forces_that_the_readings_are) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> readings = {0.01F, 12.5F, 300.0F, -0.5F, none};
  for (const auto& [quantity, newtons] : {std::pair(Quantity::force, 1.0F), std::pair(Quantity::pressure, 0.2F)}) {
    const ForceFrame force = forces_of(direct_model(array_of(quantity)), readings);
    for (std::size_t taxel = 0; taxel < 3; ++taxel) {
      const float expected = newtons * readings[taxel];
      EXPECT_NEAR(force.newtons[taxel], expected, 3e-6F * expected);
      EXPECT_NEAR(force.sigma_newtons[taxel], newtons * 0.25F, 1e-3F * newtons);
      EXPECT_EQ(force.taxels[taxel], TaxelStatus::ok);
    }
    EXPECT_EQ(force.newtons[3], 0.0F) << "nothing pulls";
    EXPECT_TRUE(std::isnan(force.newtons[4]));
    EXPECT_EQ(force.taxels[4], TaxelStatus::invalid);
  }
}

TEST(DirectModel, is_what_an_array_toml_of_forces_is_read_as) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(bytes::files::write_array(folder.file("a.toml"), array_of(Quantity::pressure)));
  const Result<Model> model = bytes::models::read_model(folder.file("a.toml"));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_NEAR(forces_of(*model, {1, 2, 3, 4, 5}).newtons[4], 1.0F, 1e-5F);
  ASSERT_TRUE(bytes::models::write_model(folder.file("m.safetensors"), *model));
  const Result<Model> again = bytes::models::read_model(folder.file("m.safetensors"));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->array.readout.quantity, Quantity::pressure);
  EXPECT_NEAR(forces_of(*again, {1, 2, 3, 4, 5}).newtons[4], 1.0F, 1e-5F);

  ArrayDescription counts = array_of(Quantity::counts);
  ASSERT_TRUE(bytes::files::write_array(folder.file("b.toml"), counts));
  const Result<Model> none = bytes::models::read_model(folder.file("b.toml"));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message,
            folder.file("b.toml") + ": describes an array, and is no model; a calibration makes one");
}

TEST(DirectModel, of_a_thousand_frames_without_change_has_no_fault) {
  Result<Pipeline> pipeline = Pipeline::create(direct_model(array_of(Quantity::pressure)));
  ASSERT_TRUE(pipeline);
  RawFrame raw;
  ForceFrame force;
  for (int k = 0; k < 1000; ++k) {
    raw.time = k * std::chrono::milliseconds(20);
    raw.counts = {0, 0, k > 500 ? 80.0F : 0.0F, 0, 0};
    pipeline->process(raw, force);
    ASSERT_EQ(force.status, FrameStatus::ok) << k;
  }
}

}  // namespace
}  // namespace dermis::touch::pipeline
