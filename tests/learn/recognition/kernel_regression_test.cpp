// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/kernel_regression.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dermis::learn::recognition {
namespace {

/// Points on a line, in turns of two classes.
Teaching line(Eigen::Index count) {
  Teaching teaching{Matrix(count, 1), {}, 2};
  for (Eigen::Index i = 0; i < count; ++i) {
    teaching.examples(i, 0) = static_cast<double>(i);
    teaching.classes.push_back(static_cast<std::size_t>(i % 2));
  }
  return teaching;
}

TEST(KernelRegression, likeness_falls_with_the_square_of_the_distance) {
  const Teaching teaching = line(3);
  const Matrix values = likeness(teaching.examples, teaching.examples, 0.5);
  EXPECT_NEAR(values(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(values(0, 1), std::exp(-0.5), 1e-12);
  EXPECT_NEAR(values(0, 2), std::exp(-2.0), 1e-12);
}

TEST(KernelRegression, of_examples_far_apart_gives_each_its_class_less_the_penalty) {
  const KernelRegression kernels = train_kernels(line(2), 100.0, 0.25);
  EXPECT_NEAR(kernels.influences(0, 0), 0.5 / 1.25, 1e-9);
  EXPECT_NEAR(kernels.influences(0, 1), -0.5 / 1.25, 1e-9);
  EXPECT_NEAR(kernels.influences(1, 1), 0.5 / 1.25, 1e-9);
}

TEST(KernelRegression, takes_an_example_of_a_rare_class_for_as_many_as_it_stands_for) {
  Teaching teaching = line(4);
  teaching.classes = {0, 0, 0, 1};  // weights 2/3, 2/3, 2/3 and 2
  const KernelRegression kernels = train_kernels(teaching, 100.0, 1.0);
  EXPECT_NEAR(kernels.influences(0, 0), 0.5 / (1.0 + 1.5), 1e-9);
  EXPECT_NEAR(kernels.influences(3, 1), 0.5 / (1.0 + 0.5), 1e-9);
}

TEST(KernelRegression, of_more_examples_than_centres_has_the_least_penalised_squares) {
  Teaching teaching = line(2);
  const Matrix places = teaching.examples;
  teaching.examples = places.replicate(3, 1);
  teaching.classes = {0, 1, 0, 1, 0, 1};
  // Three examples at each of two centres far apart: 3 (a - 1/2) + penalty a = 0.
  const Matrix influences = influences_of(equations_of(teaching, places, 100.0), 0.6);
  EXPECT_NEAR(influences(0, 0), 1.5 / 3.6, 1e-6);
  EXPECT_NEAR(influences(0, 1), -1.5 / 3.6, 1e-6);
}

TEST(KernelRegression, has_as_many_centres_of_each_class_as_its_share) {
  Teaching teaching = line(4 * static_cast<Eigen::Index>(kMostCentres));
  for (std::size_t i = 0; i < teaching.classes.size(); ++i) teaching.classes[i] = i % 4 == 3 ? 1 : 0;
  const Matrix centres = centres_of(teaching);
  ASSERT_EQ(centres.rows(), static_cast<Eigen::Index>(kMostCentres));
  std::size_t rare = 0;
  for (Eigen::Index i = 0; i < centres.rows(); ++i) rare += static_cast<std::size_t>(centres(i, 0)) % 4 == 3 ? 1 : 0;
  EXPECT_EQ(rare, kMostCentres / 4);
}

}  // namespace
}  // namespace dermis::learn::recognition
