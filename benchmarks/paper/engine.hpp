// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "problems.hpp"

namespace dermis::benchmarks {

/// How far the results of an engine are from the reference.
struct Check {
  std::string what;  ///< What was compared, and in which unit.
  double deviation = 0.0;
  double tolerance = 0.0;

  [[nodiscard]] bool passed() const { return deviation <= tolerance; }
};

/// One engine at one work, ready to be timed. It was checked when it was made.
struct Run {
  std::function<void()> step;  ///< What is timed.
  Check check;
  std::string note;                                       ///< The form chosen, where there were several; what it is.
  std::function<double()> limit_seconds{};                ///< A limit computed from measured rates, instead of `step`.
  std::vector<std::pair<std::string, double>> figures{};  ///< Of the row, besides the times.
};

/// The training rules of the bank.
enum class Rule { gradient_descent, adam };

/// A library, our own, or the machine: which works it does, and how. It gives no Run for a work that it cannot do.
class Engine {
 public:
  Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  virtual ~Engine() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string version() const = 0;
  /// Called before each measurement; parallel_for() heeds the Placement.
  virtual void use_threads(int) {}

  virtual std::optional<Run> peaks_epoch(const PeaksProblem&) { return std::nullopt; }
  virtual std::optional<Run> levenberg_marquardt_step(const PeaksProblem&) { return std::nullopt; }
  virtual std::optional<Run> taxel_mlp(const TaxelProblem&) { return std::nullopt; }
  virtual std::optional<Run> bank_frame(const BankProblem&) { return std::nullopt; }
  virtual std::optional<Run> bank_batch(const BankProblem&) { return std::nullopt; }
  virtual std::optional<Run> bank_training(const BankProblem&, Rule) { return std::nullopt; }
};

[[nodiscard]] std::unique_ptr<Engine> dermis_engine();
[[nodiscard]] std::unique_ptr<Engine> machine_limit();
// The peers that CMakeLists.txt finds.
[[nodiscard]] std::unique_ptr<Engine> libtorch_engine();
[[nodiscard]] std::unique_ptr<Engine> fann_engine();
// In a library of their own, with all else hidden: Eigen, compiled for this machine, must not mix with that of dermis.
[[nodiscard, gnu::visibility("default")]] std::unique_ptr<Engine> eigen_engine();
[[nodiscard, gnu::visibility("default")]] std::unique_ptr<Engine> openblas_engine();

}  // namespace dermis::benchmarks
