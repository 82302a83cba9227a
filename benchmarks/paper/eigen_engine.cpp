// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <Eigen/Dense>
#include <string>

#include "adaptive_rate.hpp"
#include "eigen_peaks.hpp"
#include "engine.hpp"

namespace dermis::benchmarks {
namespace {

/// Taxels of a block that stays in the cache.
constexpr Eigen::Index kBlock = 256;

class EigenEngine final : public Engine {
 public:
  [[nodiscard]] std::string name() const override { return "eigen"; }
  [[nodiscard]] std::string version() const override {
    return "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
           std::to_string(EIGEN_MINOR_VERSION) + " (" + Eigen::SimdInstructionSetsInUse() + ")";
  }

  std::optional<Run> peaks_epoch(const PeaksProblem& problem) override {
    const auto network = std::make_shared<EigenPeaks<float>>(problem);
    const auto mean_square_error = [network, scale = 2.0F / static_cast<float>(problem.count())](
                                       const std::vector<float>& parameters, std::vector<float>& gradient) {
      const float error = network->error_and_gradient(parameters, gradient);
      for (float& slope : gradient) slope *= scale;
      return double{scale * error};
    };
    const AdaptiveRateDescent<float> start(problem.parameters, mean_square_error);
    const auto train = [start, mean_square_error](std::size_t epochs) {
      AdaptiveRateDescent<float> descent = start;
      for (std::size_t epoch = 0; epoch < epochs; ++epoch) descent.epoch(mean_square_error);
      return descent.parameters();
    };
    return Run{[train, epochs = problem.epochs] { train(epochs); }, check_epochs(problem, train(kCheckedEpochs)),
               "samples x units"};
  }

  std::optional<Run> levenberg_marquardt_step(const PeaksProblem& problem) override {
    const auto rank_update = [](const Eigen::MatrixXd& jacobian, Eigen::MatrixXd& normal) {
      normal.setZero();
      normal.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose());
    };
    return eigen_step(problem, rank_update, "Jacobian stored, rankUpdate, LDLT");
  }

  /// The inputs, row-major, are Eigen's column-major [8, taxels] as they stand: no layout change is needed.
  std::optional<Run> taxel_mlp(const TaxelProblem& problem) override {
    const auto outputs = std::make_shared<std::vector<float>>(problem.taxels());
    const auto evaluate = [&problem, outputs, first = Matrix(), second = Matrix()]() mutable {
      const auto columns = static_cast<Eigen::Index>(problem.taxels());
      for (Eigen::Index column = 0; column < columns; column += kBlock) {
        const Eigen::Index count = std::min(kBlock, columns - column);
        const Eigen::Map<const Matrix> inputs(problem.inputs.data() + 8 * column, 8, count);
        first.noalias() = weights(problem, 0) * inputs;
        first.colwise() += thresholds(problem, 0);
        first = first.array().tanh();
        second.noalias() = weights(problem, 1) * first;
        second.colwise() += thresholds(problem, 1);
        second = second.array().tanh();
        Eigen::Map<Eigen::RowVectorXf> output(outputs->data() + column, count);
        output.noalias() = weights(problem, 2) * second;
        output.array() += thresholds(problem, 2)(0);
      }
    };
    std::function<void()> step = evaluate;
    step();
    return Run{step, check_outputs(problem, *outputs), "blocks of 256 taxels"};
  }

 private:
  using Matrix = Eigen::MatrixXf;
  using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  static Eigen::Map<const RowMatrix> weights(const TaxelProblem& problem, std::size_t layer) {
    return {&problem.parameters[problem.shape.weights(layer)],
            static_cast<Eigen::Index>(problem.shape.layers[layer].units),
            static_cast<Eigen::Index>(problem.shape.fan_in(layer))};
  }
  static Eigen::Map<const Eigen::VectorXf> thresholds(const TaxelProblem& problem, std::size_t layer) {
    return {&problem.parameters[problem.shape.thresholds(layer)],
            static_cast<Eigen::Index>(problem.shape.layers[layer].units)};
  }
};

}  // namespace

std::unique_ptr<Engine> eigen_engine() {
  return std::make_unique<EigenEngine>();
}

}  // namespace dermis::benchmarks
