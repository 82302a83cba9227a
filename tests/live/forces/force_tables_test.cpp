// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/force_tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "dermis/touch/pipeline/direct_model.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/force_mat.hpp"

namespace dermis::live::forces {
namespace {

using support::error_of;
using support::force_mat;
using support::MatFiles;
using support::pressed;

std::vector<ForceFrame> forces_of(const touch::pipeline::Model& model, const std::vector<RawFrame>& frames) {
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  EXPECT_TRUE(pipeline);
  std::vector<ForceFrame> forces(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) pipeline->process(frames[i], forces[i]);
  return forces;
}

TEST(ForceTables, are_those_that_are_asked_for_a_line_a_frame_or_a_contact) {
  const MatFiles mat;
  const touch::pipeline::Model model = touch::pipeline::direct_model(force_mat());
  Result<ForceTables> tables = ForceTables::create(
      {mat.file("forces.csv"), mat.file("sigmas.csv"), mat.file("contacts.csv"), mat.file("totals.csv")}, model);
  ASSERT_TRUE(tables) << error_of(tables);
  for (const ForceFrame& force : forces_of(model, pressed({0.0F, 6.5F, 6.5F}))) ASSERT_TRUE(tables->write(force));
  EXPECT_EQ(mat.text_of("forces.csv"), "");
  ASSERT_TRUE(tables->commit());
  const auto lines = [&](const std::string& name) {
    const std::string text = mat.text_of(name);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines("forces.csv"), 4);
  EXPECT_EQ(lines("sigmas.csv"), 4);
  EXPECT_EQ(lines("contacts.csv"), 3);
  EXPECT_EQ(lines("totals.csv"), 4);
  EXPECT_NE(mat.text_of("forces.csv").find("\n1.01,ok,0,0,0,0,0,6."), std::string::npos) << mat.text_of("forces.csv");
}

TEST(ForceTables, that_are_not_asked_for_are_not_written) {
  const MatFiles mat;
  const touch::pipeline::Model model = touch::pipeline::direct_model(force_mat());
  Result<ForceTables> tables = ForceTables::create({"", "", mat.file("contacts.csv")}, model);
  ASSERT_TRUE(tables) << error_of(tables);
  for (const ForceFrame& force : forces_of(model, pressed({6.0F}))) ASSERT_TRUE(tables->write(force));
  ASSERT_TRUE(tables->commit());
  EXPECT_NE(mat.text_of("contacts.csv"), "");
}

TEST(ForceTables, name_the_one_that_cannot_be_written) {
  const MatFiles mat;
  const touch::pipeline::Model model = touch::pipeline::direct_model(force_mat());
  const ForceTablePaths paths{mat.file("forces.csv"), mat.file("nowhere/sigmas.csv"), ""};
  EXPECT_NE(error_of(ForceTables::create(paths, model)).find("nowhere/sigmas.csv"), std::string::npos);
}

}  // namespace
}  // namespace dermis::live::forces
