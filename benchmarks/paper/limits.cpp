// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cmath>
#include <string>

#include "engine.hpp"
#include "machine_limits.hpp"

namespace dermis::benchmarks {
namespace {

/// The least that the machine needs for a work, from rates that are measured anew in each round.
///
/// Computing works: the sigmoids (or tanhs) at the cost of our vector code over data in the first-level cache, plus the
/// multiply-adds that the mathematics asks for at the peak of the multiply-add units; nothing for loads, stores,
/// layout, dispatch. Reading works: all parameters read once, in order, from huge pages.
class MachineLimit final : public Engine {
 public:
  [[nodiscard]] std::string name() const override { return "limit"; }
  [[nodiscard]] std::string version() const override { return "measured in the same run"; }
  void use_threads(int threads) override { threads_ = threads; }

  /// Each sample and hidden unit: one sigmoid and ten multiply-adds, 3 forward (2 inputs, its output) and 7 backward
  /// (its output's weight, slope, delta, threshold and 2 weights).
  std::optional<Run> peaks_epoch(const PeaksProblem& problem) override {
    const auto units = static_cast<double>(problem.epochs * problem.count() * problem.shape.layers[0].units);
    return computing([this, units] { return units * sigmoids() + 20.0 * units / float_rate(); });
  }

  /// One triangle of J^T J, and the sigmoids of the step and of the trial.
  std::optional<Run> levenberg_marquardt_step(const PeaksProblem& problem) override {
    const auto n = static_cast<double>(problem.shape.parameter_count());
    const auto count = static_cast<double>(problem.count());
    const double units = 2.0 * count * static_cast<double>(problem.shape.layers[0].units);
    return computing([count, n, units] {
      return count * n * (n + 1.0) / operations_per_second<double>(1) + units * seconds_of(Function::double_sigmoid);
    });
  }

  std::optional<Run> taxel_mlp(const TaxelProblem& problem) override {
    const auto taxels = static_cast<double>(problem.taxels());
    return computing([this, taxels] {
      return taxels * (32.0 * seconds_of(Function::float_tanh) + 2.0 * (8 * 16 + 16 * 16 + 16) / float_rate());
    });
  }

  std::optional<Run> bank_frame(const BankProblem& problem) override { return reading(problem.all_parameters.size()); }

  std::optional<Run> bank_batch(const BankProblem& problem) override {
    return bank_computing(problem, problem.operations(problem.batch));
  }

  /// Forward, the gradient of all weights, and the deltas of the two hidden layers (all weights but the first layer's).
  std::optional<Run> bank_training(const BankProblem& problem, Rule) override {
    const auto first_layer = static_cast<double>(problem.size() * problem.size() * problem.networks);
    return bank_computing(
        problem, 3.0 * problem.operations(problem.batch) - 2.0 * first_layer * static_cast<double>(problem.batch));
  }

 private:
  [[nodiscard]] double float_rate() const { return operations_per_second<float>(threads_); }
  [[nodiscard]] double sigmoids() const { return seconds_of(Function::float_sigmoid) / threads_; }

  static Run computing(std::function<double()> seconds) {
    return {{}, {}, "computed from measured rates", std::move(seconds)};
  }

  Run bank_computing(const BankProblem& problem, double operations) {
    const auto units = static_cast<double>((2 * problem.size() + 1) * problem.networks * problem.batch);
    return computing([this, operations, units] { return operations / float_rate() + units * sigmoids(); });
  }

  Run reading(std::size_t floats) {
    const auto memory = std::make_shared<HugePages>(floats);
    const auto read = [this, memory] { total_ = sum(memory->values(), threads_); };
    read();
    const double missing = std::fabs(double{total_} / static_cast<double>(floats) - 1.0);
    return {read, {"sum of what was read", missing, 1e-6}, "all parameters read once, huge pages"};
  }

  int threads_ = 1;
  float total_ = 0.0F;
};

}  // namespace

std::unique_ptr<Engine> machine_limit() {
  return std::make_unique<MachineLimit>();
}

}  // namespace dermis::benchmarks
