// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/perceptron_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/gradient_check.hpp"
#include "support/simd_targets.hpp"

namespace dermis::touch::network {
namespace {

constexpr PerceptronShape kShapes[] = {{1, 0, 0}, {2, 4, 2}, {3, 3, 2}};

struct Term {
  std::vector<double> x;
  double factor = 0.0;
};

struct Datum {
  std::vector<Term> terms;
  double target = 0.0;
  double weight = 0.0;
};

std::vector<double> normal_values(std::size_t count, double deviation, Random& random) {
  std::vector<double> values(count);
  for (double& value : values) value = deviation * random.normal();
  return values;
}

/// `most_terms` 1: one each; more: none to that many.
std::vector<Datum> some_data(std::size_t count, std::size_t inputs, std::size_t most_terms, Random& random) {
  std::vector<Datum> data(count);
  for (Datum& datum : data) {
    datum.terms.resize(most_terms == 1 ? 1 : random.below(most_terms + 1));
    for (Term& term : datum.terms) term = {normal_values(inputs, 1.0, random), 1.0 + 0.2 * random.normal()};
    datum.target = random.normal();
    datum.weight = 0.5 + random.uniform();
  }
  return data;
}

PerceptronSamples samples_of(const std::vector<Datum>& data, std::size_t inputs, Estimate estimate) {
  std::vector<std::size_t> terms;
  for (const Datum& datum : data) terms.push_back(datum.terms.size());
  PerceptronSamples samples(inputs, estimate, terms);
  for (std::size_t k = 0; k < data.size(); ++k) {
    samples.set_target(k, data[k].target, data[k].weight);
    for (std::size_t i = 0; i < data[k].terms.size(); ++i) {
      samples.set_input(k, i, data[k].terms[i].x);
      samples.set_factor(k, i, data[k].terms[i].factor);
    }
  }
  return samples;
}

double residual_of(const Datum& datum, const PerceptronShape& shape, const std::vector<double>& parameters,
                   Estimate estimate) {
  double sum = 0.0;
  for (const Term& term : datum.terms) {
    const double y = output(shape, parameters, term.x);
    sum += estimate == Estimate::output ? y : term.factor * std::exp(y);
  }
  return datum.weight * (sum - datum.target);
}

void expect_residuals_of_the_perceptron(Estimate estimate, std::size_t most_terms) {
  for (const PerceptronShape& shape : kShapes) {
    for (std::size_t count = 1; count <= 20; ++count) {
      SCOPED_TRACE(testing::Message() << shape.inputs << "-" << shape.hidden << "-1, seed and samples " << count);
      Random random(count);
      const std::vector<Datum> data = some_data(count, shape.inputs, most_terms, random);
      const PerceptronSamples samples = samples_of(data, shape.inputs, estimate);
      const std::vector<double> parameters = normal_values(shape.parameter_count(), 0.7, random);
      std::vector<double> residuals(count);
      samples.residuals(shape, parameters, residuals, {});
      double square = 0.0;
      for (std::size_t k = 0; k < count; ++k) {
        const double expected = residual_of(data[k], shape, parameters, estimate);
        EXPECT_NEAR(residuals[k], expected, 1e-13 * (10.0 + std::abs(expected)));
        square += expected * expected;
      }
      EXPECT_NEAR(samples.error(shape, parameters), 0.5 * square, 1e-12 * (1.0 + square));
    }
  }
}

TEST(PerceptronSamples, residuals_are_those_of_the_perceptron) {
  support::for_each_simd_target([] {
    expect_residuals_of_the_perceptron(Estimate::output, 1);
    expect_residuals_of_the_perceptron(Estimate::sum_of_exponentials, 9);
  });
}

TEST(PerceptronSamples, derivatives_are_those_of_the_residuals) {
  support::for_each_simd_target([] {
    for (const PerceptronShape& shape : kShapes) {
      for (const Estimate estimate : {Estimate::output, Estimate::sum_of_exponentials}) {
        Random random(3);
        const std::size_t most_terms = estimate == Estimate::output ? 1 : 5;
        const PerceptronSamples samples =
            samples_of(some_data(21, shape.inputs, most_terms, random), shape.inputs, estimate);
        const auto function = [&](std::span<const double> parameters, std::span<double> residuals,
                                  std::span<double> jacobian) {
          samples.residuals(shape, parameters, residuals, jacobian);
        };
        const std::vector<double> point = normal_values(shape.parameter_count(), 0.7, random);
        EXPECT_LT(support::jacobian_deviation(function, samples.count(), point), 1e-7);
      }
    }
  });
}

TEST(PerceptronSamples, normal_equations_are_those_of_the_derivatives) {
  support::for_each_simd_target([] {
    for (const PerceptronShape& shape : kShapes) {
      Random random(4);
      const std::size_t n = shape.parameter_count();
      const PerceptronSamples samples =
          samples_of(some_data(29, shape.inputs, 6, random), shape.inputs, Estimate::sum_of_exponentials);
      const std::vector<double> point = normal_values(n, 0.7, random);
      std::vector<double> residuals(samples.count());
      std::vector<double> jacobian(samples.count() * n);
      samples.residuals(shape, point, residuals, jacobian);
      std::vector<double> gradient(n);
      std::vector<double> normal(n * n);
      samples.linearise(shape, point, gradient, normal);
      for (std::size_t p = 0; p < n; ++p) {
        double expected = 0.0;
        for (std::size_t k = 0; k < residuals.size(); ++k) expected += jacobian[k * n + p] * residuals[k];
        EXPECT_NEAR(gradient[p], expected, 1e-12 * (1.0 + std::abs(expected)));
        for (std::size_t q = 0; q <= p; ++q) {
          double product = 0.0;
          for (std::size_t k = 0; k < residuals.size(); ++k) product += jacobian[k * n + p] * jacobian[k * n + q];
          EXPECT_NEAR(normal[p * n + q], product, 1e-12 * (1.0 + std::abs(product)));
        }
      }
    }
  });
}

TEST(PerceptronSamples, a_residual_has_the_same_bits_beside_other_samples) {
  support::for_each_simd_target([] {
    constexpr PerceptronShape kShape{3, 3, 2};
    Random random(5);
    std::vector<Datum> data = some_data(40, kShape.inputs, 12, random);
    const std::vector<double> parameters = normal_values(kShape.parameter_count(), 0.7, random);
    std::vector<double> together(data.size());
    samples_of(data, kShape.inputs, Estimate::sum_of_exponentials).residuals(kShape, parameters, together, {});
    for (std::size_t k = 0; k < data.size(); ++k) {
      double alone = 0.0;
      samples_of({data[k]}, kShape.inputs, Estimate::sum_of_exponentials)
          .residuals(kShape, parameters, std::span(&alone, 1), {});
      EXPECT_EQ(alone, together[k]) << k;
    }
  });
}

TEST(PerceptronSamples, a_factor_that_is_set_again_counts) {
  constexpr PerceptronShape kShape{1, 0, 0};
  PerceptronSamples samples(1, Estimate::sum_of_exponentials, std::vector<std::size_t>{1});
  samples.set_target(0, 0.0, 1.0);
  const std::vector<double> parameters(kShape.parameter_count());  // exp(0) = 1
  for (const double factor : {0.5, 3.0}) {
    samples.set_factor(0, 0, factor);
    EXPECT_EQ(samples.error(kShape, parameters), 0.5 * factor * factor);
  }
}

TEST(PerceptronSamples, an_error_without_bounds_is_no_number_that_a_fit_accepts) {
  support::for_each_simd_target([] {
    constexpr PerceptronShape kShape{1, 0, 0};
    PerceptronSamples samples(1, Estimate::sum_of_exponentials, std::vector<std::size_t>{1});
    samples.set_target(0, 1.0, 1.0);
    samples.set_factor(0, 0, 1.0);
    for (const double level : {1e6, std::numeric_limits<double>::infinity(), std::nan("")}) {
      std::vector<double> parameters(kShape.parameter_count());
      parameters[kShape.output_bias()] = level;
      EXPECT_FALSE(std::isfinite(samples.error(kShape, parameters))) << level;
    }
  });
}

}  // namespace
}  // namespace dermis::touch::network
