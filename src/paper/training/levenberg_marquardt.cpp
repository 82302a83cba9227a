// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/training/levenberg_marquardt.hpp"

#include <cassert>
#include <span>

namespace dermis::paper {
namespace {

class NetworkProblem : public touch::network::LeastSquaresProblem {
 public:
  NetworkProblem(FeedForward<double>& network, const PackedSamples<double>& samples)
      : network_(network), samples_(samples) {}

  double error(std::span<const double> point) override { return network_.error(point, samples_); }

  void linearise(std::span<const double> point, std::span<double> gradient, std::span<double> normal) override {
    network_.normal_equations(point, samples_, gradient, normal);
  }

 private:
  FeedForward<double>& network_;
  const PackedSamples<double>& samples_;
};

}  // namespace

touch::network::LevenbergMarquardtReport minimise(FeedForward<double>& network, const PackedSamples<double>& samples,
                                                  std::vector<double>& parameters,
                                                  const touch::network::LevenbergMarquardtOptions& options) {
  assert(parameters.size() == network.shape().parameter_count());
  NetworkProblem problem(network, samples);
  return touch::network::minimise(problem, parameters, options);
}

}  // namespace dermis::paper
