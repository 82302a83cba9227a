// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/operation.hpp"

#include <gtest/gtest.h>

#include "dermis/bytes/models/model_file.hpp"
#include "support/force_mat.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::live::forces {
namespace {

using support::error_of;
using support::kPressed;
using support::kShape;
using support::MatFiles;
using support::pressed;

TEST(Operation, computes_the_forces_of_a_source_by_its_model) {
  const MatFiles mat;
  const auto operation = open_operation(mat.model(), mat.write("frames.csv", pressed({2.5F})));
  ASSERT_TRUE(operation) << operation.error().message;
  EXPECT_EQ((*operation)->model.array.name, "mat");
  RawFrame raw;
  ForceFrame force;
  ASSERT_TRUE((*operation)->frames->next(raw).value());
  (*operation)->pipeline.process(raw, force);
  EXPECT_NEAR(force.newtons[kPressed], 2.5F, 1e-4F);
  EXPECT_FALSE((*operation)->frames->next(raw).value());
}

TEST(Operation, simulates_the_array_of_the_model_where_the_source_is_a_simulation) {
  const MatFiles mat;
  const Result<ModelAtWork> work = ModelAtWork::create(support::hand_made_model(3, 4));
  ASSERT_TRUE(work);
  ASSERT_TRUE(bytes::models::write_model(mat.file("model.safetensors"), work->model));
  const auto operation = open_operation(mat.file("model.safetensors"), "sim:idle?frames=1");
  ASSERT_TRUE(operation) << operation.error().message;
  EXPECT_EQ((*operation)->frames->shape(), kShape);
}

TEST(Operation, names_the_model_that_is_missing_and_the_frames_that_do_not_fit) {
  const MatFiles mat;
  const std::string frames = mat.write("frames.csv", pressed({1.0F}, {2, 4}), {2, 4});
  EXPECT_NE(error_of(open_operation(mat.file("none.toml"), frames)).find("none.toml"), std::string::npos);
  EXPECT_NE(error_of(open_operation(mat.model(), frames)).find("frames.csv"), std::string::npos);
}

}  // namespace
}  // namespace dermis::live::forces
