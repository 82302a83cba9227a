// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <Eigen/Cholesky>
#include <cmath>
#include <cstdlib>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/paper/network_bank.hpp"
#include "dermis/paper/training.hpp"
#include "dermis/touch/frames/version.hpp"
#include "engine.hpp"
#include "reference.hpp"

namespace dermis::benchmarks {
namespace {

using paper::BankStep;
using paper::FeedForward;
using paper::NetworkBank;
using paper::PackedSamples;

class Dermis final : public Engine {
 public:
  [[nodiscard]] std::string name() const override { return "dermis"; }
  [[nodiscard]] std::string version() const override { return "dermis " DERMIS_VERSION; }

  std::optional<Run> peaks_epoch(const PeaksProblem& problem) override {
    const auto train = [&problem](std::size_t epochs) {
      paper::TrainingOptions options;
      options.epochs = epochs;
      paper::TrainingState<float> state = paper::start_training(problem.shape, problem.parameters, options);
      const paper::Samples<float> samples{problem.count(), problem.inputs, problem.targets, {}};
      if (!paper::train(state, samples, options)) std::abort();
      return state.parameters;
    };
    return Run{[train, epochs = problem.epochs] { train(epochs); }, check_epochs(problem, train(kCheckedEpochs)),
               "train(), adaptive_rate"};
  }

  std::optional<Run> levenberg_marquardt_step(const PeaksProblem& problem) override {
    const std::vector<double> inputs = reference::as_double(problem.inputs);
    const std::vector<double> targets = reference::as_double(problem.targets);
    const PackedSamples<double> samples(problem.shape, {problem.count(), inputs, targets, {}});
    const auto result = std::make_shared<LevenbergMarquardtStep>();
    const std::vector<double> parameters = reference::as_double(problem.parameters);
    result->step.resize(parameters.size());
    const auto n = static_cast<Eigen::Index>(parameters.size());
    const auto take = [=, network = FeedForward<double>(problem.shape), gradient = parameters,
                       normal = std::vector<double>(parameters.size() * parameters.size())]() mutable {
      network.normal_equations(parameters, samples, gradient, normal);
      Eigen::Map<Eigen::MatrixXd> matrix(normal.data(), n, n);
      matrix.diagonal() *= 1.0 + kDamping;
      Eigen::Map<Eigen::VectorXd> step(result->step.data(), n);
      step = -matrix.ldlt().solve(Eigen::Map<Eigen::VectorXd>(gradient.data(), n));
      std::vector<double> trial = parameters;
      Eigen::Map<Eigen::VectorXd>(trial.data(), n) += step;
      result->trial_error = network.error(trial, samples);
    };
    std::function<void()> step = take;
    step();
    return Run{step, check_step(problem, *result), ""};
  }

  std::optional<Run> taxel_mlp(const TaxelProblem& problem) override {
    const auto network = std::make_shared<FeedForward<float>>(problem.shape);
    const auto outputs = std::make_shared<std::vector<float>>(problem.taxels());
    const auto evaluate = [=, &problem] { network->evaluate(problem.parameters, problem.inputs, *outputs); };
    evaluate();
    return Run{evaluate, check_outputs(problem, *outputs), ""};
  }

  std::optional<Run> bank_frame(const BankProblem& problem) override { return evaluate(problem, 1); }

  std::optional<Run> bank_batch(const BankProblem& problem) override { return evaluate(problem, problem.batch); }

  std::optional<Run> bank_training(const BankProblem& problem, Rule rule) override {
    const std::shared_ptr<NetworkBank> bank = filled_bank(problem);
    BankStep step;
    step.rule = rule == Rule::adam ? BankStep::Rule::adam : BankStep::Rule::gradient_descent;
    step.rate = rule == Rule::adam ? kAdamRate : kDescentRate;
    const auto train = [=, &problem, errors = std::vector<float>(problem.networks)]() mutable {
      bank->train_step({problem.batch, problem.database, problem.targets, problem.chosen, {}}, step, errors);
    };
    std::function<void()> body = train;
    body();
    const Check check = check_training_step(problem, rule, [&](std::size_t network) {
      std::vector<float> parameters(problem.shape.parameter_count());
      bank->parameters(network, parameters);
      return parameters;
    });
    return Run{body, check, ""};
  }

 private:
  static std::shared_ptr<NetworkBank> filled_bank(const BankProblem& problem) {
    auto bank = std::make_shared<NetworkBank>(problem.shape, problem.networks);
    for (std::size_t network = 0; network < problem.networks; ++network) {
      bank->set_parameters(network, problem.parameters(network));
    }
    return bank;
  }

  static Run evaluate(const BankProblem& problem, std::size_t count) {
    const std::shared_ptr<NetworkBank> bank = filled_bank(problem);
    const auto outputs = std::make_shared<std::vector<float>>(count * problem.networks);
    const std::span<const float> frames = std::span(problem.frames).first(count * problem.size());
    const auto evaluate = [=] {
      if (count == 1) {
        bank->evaluate(frames, *outputs);
      } else {
        bank->evaluate_batch(frames, *outputs);
      }
    };
    evaluate();
    return {evaluate, check_outputs(problem, count, *outputs), ""};
  }
};

}  // namespace

std::unique_ptr<Engine> dermis_engine() {
  return std::make_unique<Dermis>();
}

}  // namespace dermis::benchmarks
