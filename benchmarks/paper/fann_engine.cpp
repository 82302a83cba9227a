// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <floatfann.h>

#include <algorithm>
#include <cmath>

#include "engine.hpp"
#include "reference.hpp"

namespace dermis::benchmarks {
namespace {

using paper::NetworkShape;
using touch::network::Activation;

struct Destroy {
  void operator()(fann* network) const { fann_destroy(network); }
  void operator()(fann_train_data* data) const { fann_destroy_train(data); }
};
using Network = std::unique_ptr<fann, Destroy>;
using Data = std::unique_ptr<fann_train_data, Destroy>;

/// FANN's sigmoid is 1 / (1 + exp(-2 s x)) and its symmetric one tanh(s x), s the steepness.
void set_activation(fann* network, Activation activation, int layer) {
  if (activation == Activation::linear) {
    fann_set_activation_function_layer(network, FANN_LINEAR, layer);
    fann_set_activation_steepness_layer(network, 1.0F, layer);
  } else if (activation == Activation::tanh) {
    fann_set_activation_function_layer(network, FANN_SIGMOID_SYMMETRIC, layer);
    fann_set_activation_steepness_layer(network, 1.0F, layer);
  } else {
    fann_set_activation_function_layer(network, FANN_SIGMOID, layer);
    fann_set_activation_steepness_layer(network, 0.5F, layer);
  }
}

/// FANN keeps the connections of a neuron together, that to the bias last.
void set_parameters(fann* network, const NetworkShape& shape, std::span<const float> parameters) {
  float* connection = network->weights;
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    const std::size_t fan_in = shape.fan_in(layer);
    for (std::size_t unit = 0; unit < shape.layers[layer].units; ++unit) {
      connection = std::copy_n(&parameters[shape.weights(layer) + unit * fan_in], fan_in, connection);
      *connection++ = parameters[shape.thresholds(layer) + unit];
    }
  }
}

Network make_network(const NetworkShape& shape, std::span<const float> parameters) {
  std::vector<unsigned> layers{static_cast<unsigned>(shape.inputs)};
  for (const paper::Layer& layer : shape.layers) layers.push_back(static_cast<unsigned>(layer.units));
  Network network(fann_create_standard_array(static_cast<unsigned>(layers.size()), layers.data()));
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    set_activation(network.get(), shape.layers[layer].activation, static_cast<int>(layer) + 1);
  }
  set_parameters(network.get(), shape, parameters);
  return network;
}

class Fann final : public Engine {
 public:
  [[nodiscard]] std::string name() const override { return "fann"; }
  [[nodiscard]] std::string version() const override { return "FANN 2.2.0 (Debian's libfloatfann)"; }

  /// Its own batch rule, which has neither momentum nor an adaptive rate: less work than ours. Its slopes are those of
  /// sigmoids clipped to 0.01 ... 0.99, so only outputs and error can be compared.
  std::optional<Run> peaks_epoch(const PeaksProblem& problem) override {
    const std::shared_ptr<fann> network = make_network(problem.shape, problem.parameters);
    fann_set_training_algorithm(network.get(), FANN_TRAIN_BATCH);
    fann_set_train_error_function(network.get(), FANN_ERRORFUNC_LINEAR);
    fann_set_learning_rate(network.get(), 0.01F);
    const std::shared_ptr<fann_train_data> data = peaks_data(problem);
    const double error = fann_train_epoch(network.get(), data.get());
    const Check check = check_forward(problem, network.get(), error);
    return Run{[network, data, &problem] {
                 set_parameters(network.get(), problem.shape, problem.parameters);
                 for (std::size_t epoch = 0; epoch < problem.epochs; ++epoch)
                   fann_train_epoch(network.get(), data.get());
               },
               check, "its own batch rule"};
  }

  std::optional<Run> taxel_mlp(const TaxelProblem& problem) override {
    const std::shared_ptr<fann> network = make_network(problem.shape, problem.parameters);
    const auto outputs = std::make_shared<std::vector<float>>(problem.taxels());
    const auto inputs = std::make_shared<std::vector<float>>(problem.inputs);  // fann_run asks for non-const
    const auto evaluate = [network, outputs, inputs] {
      for (std::size_t taxel = 0; taxel < outputs->size(); ++taxel) {
        (*outputs)[taxel] = *fann_run(network.get(), &(*inputs)[taxel * 8]);
      }
    };
    evaluate();
    return Run{evaluate, check_outputs(problem, *outputs), "fann_run, one taxel at a time"};
  }

 private:
  static Data peaks_data(const PeaksProblem& problem) {
    Data data(fann_create_train(static_cast<unsigned>(problem.count()), 2, 1));
    for (std::size_t p = 0; p < problem.count(); ++p) {
      std::copy_n(&problem.inputs[2 * p], 2, data->input[p]);
      *data->output[p] = problem.targets[p];
    }
    return data;
  }

  /// The error of the first epoch, and the outputs at the start.
  static Check check_forward(const PeaksProblem& problem, fann* network, double error) {
    set_parameters(network, problem.shape, problem.parameters);
    std::vector<double> outputs;
    for (std::size_t p = 0; p < problem.count(); ++p) {
      float inputs[] = {problem.inputs[2 * p], problem.inputs[2 * p + 1]};
      outputs.push_back(double{*fann_run(network, inputs)});
    }
    const std::vector<double> expected = reference::outputs(problem.shape, reference::as_double(problem.parameters),
                                                            reference::as_double(problem.inputs));
    double square = 0.0;
    for (std::size_t p = 0; p < problem.count(); ++p) square += std::pow(double{problem.targets[p]} - expected[p], 2);
    const double expected_error = square / static_cast<double>(problem.count());
    const double error_deviation = std::fabs(error - expected_error) / expected_error;
    return {"outputs and mean square error", std::fmax(reference::max_deviation(outputs, expected), error_deviation),
            1e-5};
  }
};

}  // namespace

std::unique_ptr<Engine> fann_engine() {
  return std::make_unique<Fann>();
}

}  // namespace dermis::benchmarks
