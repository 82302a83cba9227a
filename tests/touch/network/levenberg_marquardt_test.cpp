// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/network/perceptron.hpp"
#include "support/dense_solve.hpp"
#include "support/places.hpp"

namespace dermis::touch::network {
namespace {

/// residual = design p - target, design [rows, cols].
struct LinearProblem {
  std::size_t rows;
  std::size_t cols;
  std::vector<double> design;
  std::vector<double> target;

  LinearProblem(std::size_t row_count, std::size_t col_count, std::uint64_t seed)
      : rows(row_count), cols(col_count), design(rows * cols), target(rows) {
    Random random(seed);
    for (double& value : design) value = random.normal();
    for (double& value : target) value = 3.0 * random.normal();
  }

  [[nodiscard]] ResidualFunction residual() const {
    return [this](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
      for (std::size_t i = 0; i < rows; ++i) {
        r[i] = -target[i];
        for (std::size_t k = 0; k < cols; ++k) r[i] += design[i * cols + k] * p[k];
      }
      std::copy(design.begin(), design.begin() + static_cast<std::ptrdiff_t>(jacobian.size()), jacobian.begin());
    };
  }

  /// The minimum, from the normal equations; the row `left_out` (>= rows for none) takes no part.
  [[nodiscard]] std::vector<double> minimum(std::size_t left_out) const {
    std::vector<double> normal(cols * cols, 0.0);
    std::vector<double> right(cols, 0.0);
    for (std::size_t i = 0; i < rows; ++i) {
      if (i == left_out) continue;
      for (std::size_t k = 0; k < cols; ++k) {
        right[k] += design[i * cols + k] * target[i];
        for (std::size_t l = 0; l < cols; ++l) normal[k * cols + l] += design[i * cols + k] * design[i * cols + l];
      }
    }
    return support::solve(normal, right, cols);
  }

  [[nodiscard]] double residual_at(const std::vector<double>& p, std::size_t row) const {
    double r = -target[row];
    for (std::size_t k = 0; k < cols; ++k) r += design[row * cols + k] * p[k];
    return r;
  }
};

double half_square(const ResidualFunction& residual, std::size_t count, const std::vector<double>& parameters) {
  std::vector<double> r(count);
  residual(parameters, r, {});
  double sum = 0.0;
  for (const double value : r) sum += 0.5 * value * value;
  return sum;
}

void rosenbrock(std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
  r[0] = 10.0 * (p[1] - p[0] * p[0]);
  r[1] = 1.0 - p[0];
  if (jacobian.empty()) return;
  jacobian[0] = -20.0 * p[0];
  jacobian[1] = 10.0;
  jacobian[2] = -1.0;
  jacobian[3] = 0.0;
}

TEST(LevenbergMarquardt, solves_linear_least_squares_in_a_few_steps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const LinearProblem problem(30, 4, seed);
    std::vector<double> parameters(4, 0.0);
    const auto report = minimise(problem.residual(), 30, parameters);
    EXPECT_TRUE(report.converged());
    EXPECT_LE(report.iterations, 6);
    const auto expected = problem.minimum(30);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(parameters[k], expected[k], 1e-6);
    EXPECT_NEAR(report.final_error, half_square(problem.residual(), 30, expected), 1e-10);
  }
}

TEST(LevenbergMarquardt, finds_the_end_of_the_rosenbrock_valley) {
  std::vector<double> parameters = {-1.2, 1.0};
  const auto report = minimise(rosenbrock, 2, parameters);
  EXPECT_NEAR(report.initial_error, 0.5 * (4.4 * 4.4 + 2.2 * 2.2), 1e-12);
  EXPECT_TRUE(report.converged());
  EXPECT_LT(report.final_error, 1e-16);
  EXPECT_NEAR(parameters[0], 1.0, 1e-8);
  EXPECT_NEAR(parameters[1], 1.0, 1e-8);
}

TEST(LevenbergMarquardt, is_never_worse_than_the_start_and_reports_what_it_left) {
  // Sums of sines have many minima, and a step can land anywhere.
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    std::vector<double> frequency(12);
    for (double& value : frequency) value = random.uniform(0.5, 8.0);
    const ResidualFunction residual = [&](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
      for (std::size_t i = 0; i < r.size(); ++i) {
        const double a = frequency[i];
        const double b = frequency[r.size() - 1 - i];
        r[i] = std::sin(a * p[0]) * std::exp(0.2 * p[1]) + std::cos(b * p[1]);
        if (jacobian.empty()) continue;
        jacobian[2 * i] = a * std::cos(a * p[0]) * std::exp(0.2 * p[1]);
        jacobian[2 * i + 1] = 0.2 * std::sin(a * p[0]) * std::exp(0.2 * p[1]) - b * std::sin(b * p[1]);
      }
    };
    const std::vector<double> start = {random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0)};
    const double start_error = half_square(residual, 12, start);
    double last_error = start_error;
    for (const int steps : {1, 2, 3, 5, 10, 200}) {
      std::vector<double> parameters = start;
      const auto report = minimise(residual, 12, parameters, {.max_iterations = steps});
      EXPECT_LE(report.iterations, steps);
      EXPECT_DOUBLE_EQ(report.initial_error, start_error);
      EXPECT_NEAR(report.final_error, half_square(residual, 12, parameters), 1e-12 * start_error);
      EXPECT_LE(report.final_error, last_error) << steps << " steps";
      last_error = report.final_error;
    }
  }
}

TEST(LevenbergMarquardt, says_when_it_was_stopped_early) {
  std::vector<double> parameters = {-1.2, 1.0};
  const auto report = minimise(rosenbrock, 2, parameters, {.max_iterations = 3});
  EXPECT_EQ(report.iterations, 3);
  EXPECT_FALSE(report.converged());
}

TEST(LevenbergMarquardt, at_the_minimum_nothing_moves) {
  std::vector<double> parameters = {1.0, 1.0};
  const auto report = minimise(rosenbrock, 2, parameters);
  EXPECT_EQ(parameters, (std::vector<double>{1.0, 1.0}));
  EXPECT_EQ(report.final_error, 0.0);
  EXPECT_TRUE(report.converged());
}

TEST(LevenbergMarquardt, never_accepts_a_point_whose_residual_is_not_finite) {
  for (const double poison : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    int poisoned = 0;
    // ln(p) = -3 from far away: the first undamped step lands below zero, where the residual is poison.
    const ResidualFunction residual = [&](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
      if (p[0] <= 0.0) ++poisoned;
      r[0] = p[0] > 0.0 ? std::log(p[0]) + 3.0 : poison;
      if (!jacobian.empty()) jacobian[0] = 1.0 / p[0];
    };
    std::vector<double> parameters = {50.0};
    const auto report = minimise(residual, 1, parameters);
    EXPECT_GT(poisoned, 0) << "the trap was not sprung";
    EXPECT_TRUE(report.converged());
    EXPECT_NEAR(parameters[0], std::exp(-3.0), 1e-8);
  }
}

TEST(LevenbergMarquardt, a_start_that_is_not_finite_is_not_called_converged) {
  const ResidualFunction residual = [](std::span<const double>, std::span<double> r, std::span<double> jacobian) {
    r[0] = std::numeric_limits<double>::quiet_NaN();
    std::fill(jacobian.begin(), jacobian.end(), 1.0);
  };
  std::vector<double> parameters = {1.0};
  EXPECT_FALSE(minimise(residual, 1, parameters).converged());
  EXPECT_EQ(parameters, std::vector<double>{1.0});
}

TEST(LevenbergMarquardt, parameters_without_influence_stay_finite) {
  // Only a + b can be known, c takes no part at all.
  const ResidualFunction residual = [](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = static_cast<double>(i) + 1.0;
      r[i] = x * (p[0] + p[1]) - 2.0 * x;
      if (jacobian.empty()) continue;
      jacobian[3 * i] = x;
      jacobian[3 * i + 1] = x;
      jacobian[3 * i + 2] = 0.0;
    }
  };
  std::vector<double> parameters = {5.0, -1.0, 0.75};
  const auto report = minimise(residual, 3, parameters);
  EXPECT_TRUE(report.converged());
  EXPECT_NEAR(parameters[0] + parameters[1], 2.0, 1e-7);
  EXPECT_NEAR(parameters[0] - parameters[1], 6.0, 1e-6);  // the smallest step: the difference is left alone
  EXPECT_EQ(parameters[2], 0.75);
}

TEST(LevenbergMarquardt, a_jacobian_of_zeros_leaves_the_start) {
  const ResidualFunction residual = [](std::span<const double>, std::span<double> r, std::span<double> jacobian) {
    r[0] = 2.0;
    std::fill(jacobian.begin(), jacobian.end(), 0.0);
  };
  std::vector<double> parameters = {1.0, 2.0};
  const auto report = minimise(residual, 1, parameters);
  EXPECT_EQ(parameters, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(report.final_error, 2.0);
}

TEST(LevenbergMarquardt, stops_at_the_error_goal) {
  std::vector<double> parameters = {-1.2, 1.0};
  const auto report = minimise(rosenbrock, 2, parameters, {.error_goal = 0.5});
  EXPECT_EQ(report.stop, LevenbergMarquardtStop::error_goal);
  EXPECT_LE(report.final_error, 0.5);
  EXPECT_GT(report.final_error, 1e-6) << "it went on beyond the goal";

  const std::vector<double> left = parameters;
  EXPECT_EQ(minimise(rosenbrock, 2, parameters, {.error_goal = 0.5}).iterations, 0);
  EXPECT_EQ(parameters, left);
}

TEST(LevenbergMarquardt, stops_where_the_gradient_is_small) {
  std::vector<double> parameters = {-1.2, 1.0};
  const auto report = minimise(rosenbrock, 2, parameters, {.gradient_limit = 1e-2});
  EXPECT_EQ(report.stop, LevenbergMarquardtStop::gradient_limit);
  const double r0 = 10.0 * (parameters[1] - parameters[0] * parameters[0]);
  EXPECT_LE(std::abs(-20.0 * parameters[0] * r0 - (1.0 - parameters[0])), 1e-2);
  EXPECT_LE(std::abs(10.0 * r0), 1e-2);
}

TEST(LevenbergMarquardt, the_observer_sees_each_iteration_and_the_parameters_so_far_and_can_stop) {
  std::vector<double> parameters = {-1.2, 1.0};
  int calls = 0;
  LevenbergMarquardtOptions options;
  options.observer = [&](int iteration, double error, double) {
    EXPECT_EQ(iteration, ++calls);
    EXPECT_DOUBLE_EQ(error, half_square(rosenbrock, 2, parameters));
    return iteration < 7;
  };
  const auto report = minimise(rosenbrock, 2, parameters, options);
  EXPECT_EQ(report.stop, LevenbergMarquardtStop::observer);
  EXPECT_FALSE(report.converged());
  EXPECT_EQ(report.iterations, 7);
  EXPECT_EQ(calls, 7);
  EXPECT_DOUBLE_EQ(report.final_error, half_square(rosenbrock, 2, parameters));
}

/// The linear problem by its normal equations, without a Jacobian.
class NormalEquations : public LeastSquaresProblem {
 public:
  explicit NormalEquations(const LinearProblem& linear) : linear_(linear) {}

  double error(std::span<const double> point) override {
    return half_square(linear_.residual(), linear_.rows, {point.begin(), point.end()});
  }

  void linearise(std::span<const double> point, std::span<double> gradient, std::span<double> normal) override {
    const std::size_t cols = linear_.cols;
    const std::vector<double> p(point.begin(), point.end());
    std::fill(gradient.begin(), gradient.end(), 0.0);
    std::fill(normal.begin(), normal.end(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < cols; ++k) std::fill_n(&normal[k * cols], k + 1, 0.0);
    for (std::size_t i = 0; i < linear_.rows; ++i) {
      const double* const row = &linear_.design[i * cols];
      for (std::size_t k = 0; k < cols; ++k) {
        gradient[k] += row[k] * linear_.residual_at(p, i);
        for (std::size_t l = 0; l <= k; ++l) normal[k * cols + l] += row[k] * row[l];
      }
    }
  }

 private:
  const LinearProblem& linear_;
};

TEST(LevenbergMarquardt, a_problem_without_a_jacobian_follows_the_path_of_its_residuals) {
  const LinearProblem linear(20, 4, 7);
  NormalEquations problem(linear);
  std::vector<double> parameters(4, 1.0);
  std::vector<double> expected(4, 1.0);
  const LevenbergMarquardtOptions options{.max_iterations = 3};
  const auto report = minimise(problem, parameters, options);
  EXPECT_DOUBLE_EQ(report.final_error, minimise(linear.residual(), 20, expected, options).final_error);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(parameters[k], expected[k], 1e-12);
}

struct GoldenFit {
  std::vector<double> start;
  double error = 0.0;
  std::vector<std::vector<double>> samples;  // x0, x1, y, prediction
};

GoldenFit read_golden_fit() {
  GoldenFit fit;
  std::ifstream file(support::project_folder() / "tests/touch/network/golden/perceptron_fit.csv");
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string kind;
    std::getline(cells, kind, ',');
    std::vector<double> values;
    for (std::string cell; std::getline(cells, cell, ',');) {
      if (kind.front() != '#') values.push_back(std::stod(cell));
    }
    if (kind == "start") fit.start = values;
    if (kind == "error") fit.error = values.at(0);
    if (kind == "sample") fit.samples.push_back(values);
  }
  return fit;
}

TEST(LevenbergMarquardt, fits_a_perceptron_as_numpy_does) {
  const GoldenFit golden = read_golden_fit();
  ASSERT_EQ(golden.samples.size(), 40U) << "tests/touch/network/golden/perceptron_fit.csv";
  const PerceptronShape shape{2, 3, 0};
  ASSERT_EQ(golden.start.size(), shape.parameter_count());
  const auto inputs = [&](std::size_t i) { return std::span(golden.samples[i]).first(2); };
  const ResidualFunction residual = [&](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      const double y = jacobian.empty()
                           ? output(shape, p, inputs(i))
                           : output_and_gradient(shape, p, inputs(i), jacobian.subspan(i * p.size(), p.size()));
      r[i] = y - golden.samples[i][2];
    }
  };
  std::vector<double> parameters = golden.start;
  const auto report = minimise(residual, 40, parameters, {.max_iterations = 1000, .relative_reduction = 1e-13});
  EXPECT_TRUE(report.converged());
  EXPECT_NEAR(report.final_error / golden.error, 1.0, 1e-8);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_NEAR(output(shape, parameters, inputs(i)), golden.samples[i][3], 1e-5) << "sample " << i;
  }
}

TEST(LeaveOneOut, equals_refits_without_each_datum) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const LinearProblem problem(25, 3, seed);
    double expected = 0.0;
    for (std::size_t i = 0; i < 25; ++i) expected += std::pow(problem.residual_at(problem.minimum(i), i), 2) / 25.0;
    EXPECT_NEAR(leave_one_out_mean_square(problem.residual(), 25, 25, problem.minimum(25)) / expected, 1.0, 1e-9);
  }
}

TEST(FittedResiduals, are_the_residuals_with_the_leverages_of_least_squares) {
  const LinearProblem problem(25, 3, 4);
  const auto minimum = problem.minimum(25);
  const std::vector<FittedResidual> fitted = fitted_residuals(problem.residual(), 25, 25, minimum);
  ASSERT_EQ(fitted.size(), 25U);
  double leverages = 0.0;
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_DOUBLE_EQ(fitted[i].residual, problem.residual_at(minimum, i));
    EXPECT_NEAR(fitted[i].left_out() / problem.residual_at(problem.minimum(i), i), 1.0, 1e-8);
    EXPECT_NEAR(fitted[i].as_new_error() / fitted[i].as_noise(), std::sqrt(1.0 + fitted[i].leverage), 1e-12);
    leverages += fitted[i].leverage;
  }
  EXPECT_NEAR(leverages, 3.0, 1e-8);  // the trace of the hat matrix
}

TEST(FittedResiduals, tell_the_noise_that_was_there_and_the_error_on_new_data) {
  // y = a + b x + c x^2 + noise of 1 on 8 points, 2000 times.
  Random random(6);
  double noise = 0.0;
  double new_error = 0.0;
  double true_new_error = 0.0;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    std::vector<double> y(8);
    for (double& value : y) value = random.normal();
    const ResidualFunction residual = [&](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
      for (std::size_t i = 0; i < 8; ++i) {
        const auto x = static_cast<double>(i);
        r[i] = p[0] + p[1] * x + p[2] * x * x - y[i];
        if (jacobian.empty()) continue;
        jacobian[3 * i] = 1.0;
        jacobian[3 * i + 1] = x;
        jacobian[3 * i + 2] = x * x;
      }
    };
    std::vector<double> parameters(3, 0.0);
    minimise(residual, 8, parameters);
    for (const FittedResidual& datum : fitted_residuals(residual, 8, 8, parameters)) {
      noise += std::pow(datum.as_noise(), 2);
      new_error += std::pow(datum.as_new_error(), 2);
    }
    for (std::size_t i = 0; i < 8; ++i) {
      const auto x = static_cast<double>(i);
      true_new_error += std::pow(parameters[0] + parameters[1] * x + parameters[2] * x * x - random.normal(), 2);
    }
  }
  EXPECT_NEAR(noise / 16000.0, 1.0, 0.03);
  EXPECT_NEAR(new_error / true_new_error, 1.0, 0.04);
}

TEST(LeaveOneOut, rows_of_a_penalty_shape_the_fit_and_are_not_counted) {
  constexpr std::size_t kData = 10;
  constexpr std::size_t kParameters = 6;
  LinearProblem problem(kData + kParameters, kParameters, 3);  // the last rows become a ridge: 2 p_k = 0
  for (std::size_t k = 0; k < kParameters; ++k) {
    problem.target[kData + k] = 0.0;
    for (std::size_t l = 0; l < kParameters; ++l) {
      problem.design[(kData + k) * kParameters + l] = k == l ? 2.0 : 0.0;
    }
  }
  double expected = 0.0;
  for (std::size_t i = 0; i < kData; ++i) {
    expected += std::pow(problem.residual_at(problem.minimum(i), i), 2) / static_cast<double>(kData);
  }
  const auto minimum = problem.minimum(problem.rows);
  EXPECT_NEAR(leave_one_out_mean_square(problem.residual(), kData, problem.rows, minimum) / expected, 1.0, 1e-9);
}

TEST(LeaveOneOut, is_larger_than_the_mean_square_of_the_fit) {
  const LinearProblem problem(12, 5, 9);
  const auto minimum = problem.minimum(12);
  EXPECT_GT(leave_one_out_mean_square(problem.residual(), 12, 12, minimum),
            2.0 * half_square(problem.residual(), 12, minimum) / 12.0);
}

}  // namespace
}  // namespace dermis::touch::network
