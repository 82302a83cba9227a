// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cblas.h>

#include <algorithm>
#include <string>

#include "dermis/learn/calibration/parallel.hpp"
#include "eigen_peaks.hpp"
#include "engine.hpp"
#include "forms.hpp"
#include "machine_limits.hpp"

namespace dermis::benchmarks {
namespace {

/// OpenBLAS has matrix products, but no sigmoids: those are ours. Several networks are shared out among the threads,
/// each product then runs on one; letting OpenBLAS split such small products is slower.
class Openblas final : public Engine {
 public:
  [[nodiscard]] std::string name() const override { return "openblas"; }
  [[nodiscard]] std::string version() const override { return openblas_get_config(); }
  void use_threads(int) override { openblas_set_num_threads(1); }

  std::optional<Run> levenberg_marquardt_step(const PeaksProblem& problem) override {
    const auto rank_update = [](const Eigen::MatrixXd& jacobian, Eigen::MatrixXd& normal) {
      const auto n = static_cast<int>(jacobian.cols());
      const auto count = static_cast<int>(jacobian.rows());
      cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, count, 1.0, jacobian.data(), count, 0.0, normal.data(), n);
    };
    return eigen_step(problem, rank_update, "Jacobian by Eigen, dsyrk, Eigen's LDLT");
  }

  std::optional<Run> bank_frame(const BankProblem& problem) override {
    const auto outputs = std::make_shared<std::vector<float>>(problem.networks);
    const auto transposed = std::make_shared<std::vector<float>>(transposed_weights(problem));
    const auto evaluate = [&problem, outputs, transposed](CBLAS_ORDER order) {
      const float* weights = order == CblasRowMajor ? problem.all_parameters.data() : transposed->data();
      learn::calibration::parallel_for(problem.networks, [&](std::size_t network) {
        (*outputs)[network] = evaluate_frame(problem, network, order, weights);
      });
    };
    const Form form = fastest({{"sgemv, weights by rows", [evaluate] { evaluate(CblasRowMajor); }},
                               {"sgemv, weights by columns", [evaluate] { evaluate(CblasColMajor); }}});
    form.body();
    return Run{form.body, check_outputs(problem, 1, *outputs), form.name + ", our sigmoid"};
  }

  std::optional<Run> bank_batch(const BankProblem& problem) override {
    const auto outputs = std::make_shared<std::vector<float>>(problem.batch * problem.networks);
    const auto weights = std::make_shared<std::vector<float>>(transposed_weights(problem));
    const auto evaluate = [&problem, outputs, weights] {
      learn::calibration::parallel_for(problem.networks, [&](std::size_t network) {
        evaluate_batch(problem, network, weights->data(), outputs->data() + network);
      });
    };
    evaluate();
    return Run{evaluate, check_outputs(problem, problem.batch, *outputs), "sgemm, our sigmoid"};
  }

 private:
  /// `weights`: of all networks, by rows [units, fan_in] or by columns.
  static float evaluate_frame(const BankProblem& problem, std::size_t network, CBLAS_ORDER order,
                              const float* weights) {
    const auto n = static_cast<int>(problem.size());
    const float* own_weights = weights + network * problem.shape.parameter_count();
    const float* parameters = problem.parameters(network).data();
    thread_local std::vector<float> below;
    thread_local std::vector<float> above;
    below.assign(problem.frames.begin(), problem.frames.begin() + n);
    for (std::size_t layer = 0; layer < problem.shape.layers.size(); ++layer) {
      const auto units = static_cast<int>(problem.shape.layers[layer].units);
      const float* thresholds = parameters + problem.shape.thresholds(layer);
      above.assign(thresholds, thresholds + units);
      cblas_sgemv(order, CblasNoTrans, units, n, 1.0F, own_weights + problem.shape.weights(layer),
                  order == CblasRowMajor ? n : units, below.data(), 1, 1.0F, above.data(), 1);
      sigmoid_in_place(above);
      below.swap(above);
    }
    return below.front();
  }

  /// The products of batches are fastest where no factor is transposed: weights [fan_in, units].
  static std::vector<float> transposed_weights(const BankProblem& problem) {
    std::vector<float> all(problem.all_parameters.size());
    for (std::size_t network = 0; network < problem.networks; ++network) {
      const std::size_t first = network * problem.shape.parameter_count();
      for (std::size_t layer = 0; layer < problem.shape.layers.size(); ++layer) {
        const std::size_t units = problem.shape.layers[layer].units;
        const std::size_t from = first + problem.shape.weights(layer);
        for (std::size_t unit = 0; unit < units; ++unit) {
          for (std::size_t k = 0; k < problem.size(); ++k) {
            all[from + k * units + unit] = problem.all_parameters[from + unit * problem.size() + k];
          }
        }
      }
    }
    return all;
  }

  /// outputs: one a sample, `networks` apart.
  static void evaluate_batch(const BankProblem& problem, std::size_t network, const float* transposed, float* outputs) {
    const auto n = static_cast<int>(problem.size());
    const auto batch = static_cast<int>(problem.batch);
    const std::size_t first = network * problem.shape.parameter_count();
    thread_local std::vector<float> values[2];
    const float* below = problem.frames.data();
    for (std::size_t layer = 0; layer < problem.shape.layers.size(); ++layer) {
      const std::size_t units = problem.shape.layers[layer].units;
      std::vector<float>& above = values[layer % 2];
      above.resize(problem.batch * units);
      const float* thresholds = problem.parameters(network).data() + problem.shape.thresholds(layer);
      for (std::size_t k = 0; k < problem.batch; ++k) std::copy_n(thresholds, units, &above[k * units]);
      cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, batch, static_cast<int>(units), n, 1.0F, below, n,
                  transposed + first + problem.shape.weights(layer), static_cast<int>(units), 1.0F, above.data(),
                  static_cast<int>(units));
      sigmoid_in_place(above);
      below = above.data();
    }
    for (std::size_t k = 0; k < problem.batch; ++k) outputs[k * problem.networks] = below[k];
  }
};

}  // namespace

std::unique_ptr<Engine> openblas_engine() {
  return std::make_unique<Openblas>();
}

}  // namespace dermis::benchmarks
