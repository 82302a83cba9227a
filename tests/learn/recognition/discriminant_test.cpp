// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/discriminant.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::recognition {
namespace {

struct Sample {
  Matrix points;
  std::vector<std::size_t> classes;
  Matrix strays{};

  [[nodiscard]] Teaching teaching() const { return {points, classes, 3, strays}; }
};

/// Three classes in turns, whose means differ in the first columns.
Sample sample_of(std::size_t count, std::size_t columns, std::uint64_t seed) {
  Random random(seed);
  Sample sample{Matrix(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(columns)), {}};
  for (Eigen::Index row = 0; row < sample.points.rows(); ++row) {
    sample.classes.push_back(static_cast<std::size_t>(row) % 3);
    for (Eigen::Index col = 0; col < sample.points.cols(); ++col) sample.points(row, col) = random.normal();
    sample.points.row(row) += sample.points(row, 0) * Eigen::RowVectorXd::LinSpaced(sample.points.cols(), 0.0, 1.0);
    sample.points(row, static_cast<Eigen::Index>(sample.classes.back())) += 2.0;
  }
  return sample;
}

/// Squared distances to the means by the definition: C = (1 - a) W + a tr(W)/p I, inverted as it stands. The strays are
/// part of W.
Matrix distances_by_definition(const Sample& sample, const Matrix& others, double shrinkage) {
  Matrix means = Matrix::Zero(3, others.cols());
  Vector counts = Vector::Zero(3);
  for (std::size_t i = 0; i < sample.classes.size(); ++i) {
    means.row(static_cast<Eigen::Index>(sample.classes[i])) += sample.points.row(static_cast<Eigen::Index>(i));
    counts(static_cast<Eigen::Index>(sample.classes[i])) += 1.0;
  }
  means = counts.cwiseInverse().asDiagonal() * means;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(others.cols(), others.cols());
  for (std::size_t i = 0; i < sample.classes.size(); ++i) {
    const Vector apart =
        (sample.points.row(static_cast<Eigen::Index>(i)) - means.row(static_cast<Eigen::Index>(sample.classes[i])))
            .transpose();
    covariance += apart * apart.transpose() / (static_cast<double>(sample.classes.size()) - 3.0);
  }
  if (sample.strays.rows() > 0) {
    covariance += sample.strays.transpose() * sample.strays / (static_cast<double>(sample.classes.size()) - 3.0);
  }
  const double variance = covariance.trace() / static_cast<double>(others.cols());
  covariance *= 1.0 - shrinkage;
  covariance.diagonal().array() += shrinkage * variance;
  const Eigen::MatrixXd inverse = covariance.inverse();
  Matrix distances(others.rows(), 3);
  for (Eigen::Index row = 0; row < others.rows(); ++row) {
    for (Eigen::Index label = 0; label < 3; ++label) {
      const Vector apart = (others.row(row) - means.row(label)).transpose();
      distances(row, label) = apart.dot(inverse * apart);
    }
  }
  return distances;
}

/// Distances in the space of the means differ from those in all of it by the same for all classes.
void expect_the_definition(const Sample& sample) {
  const Eigen::Index columns = sample.points.cols();
  const Matrix others = sample_of(7, static_cast<std::size_t>(columns), 2).points;
  const auto path = score_others(sample.teaching(), others);
  for (std::size_t i = 0; i < kShrinkages.size(); ++i) {
    const Matrix expected = distances_by_definition(sample, others, kShrinkages[i]);
    const Discriminant trained = train_discriminant(sample.teaching(), kShrinkages[i]);
    EXPECT_EQ(trained.axes.rows(), 3);
    const Matrix squares = trained.distances(others).cwiseAbs2();
    for (Eigen::Index label = 1; label < 3; ++label) {
      const Vector difference = expected.col(label) - expected.col(0);
      const double scale = difference.norm();
      EXPECT_LT((2.0 * (path[i].col(0) - path[i].col(label)) - difference).norm(), 1e-6 * scale) << kShrinkages[i];
      EXPECT_LT((squares.col(label) - squares.col(0) - difference).norm(), 1e-6 * scale) << kShrinkages[i];
    }
    EXPECT_TRUE((squares.array() <= expected.array() + 1e-6).all()) << kShrinkages[i];
  }
}

TEST(Discriminant, measures_distances_by_its_covariance) {
  expect_the_definition(sample_of(60, 12, 1));
}

TEST(Discriminant, looks_less_where_examples_stray) {
  for (const std::size_t columns : {12U, 60U}) {
    Sample sample = sample_of(30, columns, 1);
    sample.strays = 3.0 * sample_of(20, columns, 5).points;
    expect_the_definition(sample);
  }
}

TEST(Discriminant, does_so_with_more_features_than_examples) {
  expect_the_definition(sample_of(15, 40, 1));
}

TEST(Discriminant, takes_the_whole_space_where_there_are_more_classes_than_features) {
  const Sample sample = sample_of(60, 3, 3);
  const Matrix others = sample_of(7, 3, 4).points;
  const Discriminant trained = train_discriminant(sample.teaching(), 0.1);
  const Matrix expected = distances_by_definition(sample, others, 0.1);
  EXPECT_LT((trained.distances(others).cwiseAbs2() - expected).norm(), 1e-6 * expected.norm());
}

TEST(Discriminant, stays_finite_where_all_examples_of_a_class_are_the_same) {
  Sample sample = sample_of(6, 4, 4);
  for (Eigen::Index row = 3; row < 6; ++row) sample.points.row(row) = sample.points.row(row - 3);
  for (const Matrix& scores : score_others(sample.teaching(), sample.points)) {
    EXPECT_TRUE(scores.allFinite());
  }
  EXPECT_TRUE(train_discriminant(sample.teaching(), 0.003).distances(sample.points).allFinite());
}

}  // namespace
}  // namespace dermis::learn::recognition
