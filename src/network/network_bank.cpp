// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/network/network_bank.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "dermis/network/feed_forward.hpp"

namespace dermis::network {

class NetworkBank::State {
 public:
  State(NetworkShape shape, std::size_t networks)
      : networks_(networks), one_(std::move(shape)), parameters_(networks * per_network()), steps_(networks) {}

  const NetworkShape& shape() const { return one_.shape(); }
  std::size_t networks() const { return networks_; }

  std::span<float> of(std::size_t network) {
    return std::span(parameters_).subspan(network * per_network(), per_network());
  }

  void set(std::size_t network, std::span<const float> parameters) {
    std::copy(parameters.begin(), parameters.end(), of(network).begin());
    if (first_moments_.empty()) return;
    std::fill_n(&first_moments_[network * per_network()], per_network(), 0.0F);
    std::fill_n(&second_moments_[network * per_network()], per_network(), 0.0F);
    steps_[network] = 0;
  }

  void evaluate(std::span<const float> inputs, std::span<float> outputs) {
    const std::size_t each = shape().outputs();
    for (std::size_t network = 0; network < networks_; ++network) {
      one_.evaluate(of(network), inputs, outputs.subspan(network * each, each));
    }
  }

  float train(const BankBatch& batch, const BankStep& step, std::size_t network) {
    const std::size_t inputs = shape().inputs;
    const std::size_t outputs = shape().outputs();
    std::vector<float> own_inputs;
    std::vector<float> own_targets;
    for (const std::uint32_t row : batch.chosen.subspan(network * batch.batch, batch.batch)) {
      const auto input = batch.inputs.subspan(row * inputs, inputs);
      const auto target = batch.targets.subspan((row * networks_ + network) * outputs, outputs);
      own_inputs.insert(own_inputs.end(), input.begin(), input.end());
      own_targets.insert(own_targets.end(), target.begin(), target.end());
    }
    const auto weights =
        batch.weights.empty() ? batch.weights : batch.weights.subspan(network * batch.batch, batch.batch);
    const PackedSamples<float> samples(shape(), {batch.batch, own_inputs, own_targets, weights});
    std::vector<float> gradient(per_network());
    const double error = one_.error_and_gradient(of(network), samples, gradient);
    const float scale = 1.0F / static_cast<float>(batch.batch);
    for (float& slope : gradient) slope *= scale;
    move(step, network, gradient);
    return static_cast<float>(error) * scale;
  }

 private:
  std::size_t per_network() const { return one_.shape().parameter_count(); }

  void move(const BankStep& step, std::size_t network, std::span<const float> gradient) {
    const std::span<float> own = of(network);
    if (step.rule == BankStep::Rule::gradient_descent) {
      for (std::size_t i = 0; i < own.size(); ++i) own[i] -= step.rate * gradient[i];
      return;
    }
    first_moments_.resize(parameters_.size());
    second_moments_.resize(parameters_.size());
    const auto count = static_cast<float>(++steps_[network]);
    for (std::size_t i = 0; i < own.size(); ++i) {
      float& first = first_moments_[network * per_network() + i];
      float& second = second_moments_[network * per_network() + i];
      first += (1.0F - step.first_decay) * (gradient[i] - first);
      second += (1.0F - step.second_decay) * (gradient[i] * gradient[i] - second);
      const float unbiased_first = first / (1.0F - std::pow(step.first_decay, count));
      const float unbiased_second = second / (1.0F - std::pow(step.second_decay, count));
      own[i] -= step.rate * unbiased_first / (std::sqrt(unbiased_second) + step.epsilon);
    }
  }

  std::size_t networks_;
  FeedForward<float> one_;
  std::vector<float> parameters_;
  std::vector<float> first_moments_;
  std::vector<float> second_moments_;
  std::vector<std::size_t> steps_;
};

NetworkBank::NetworkBank(NetworkShape shape, std::size_t networks)
    : state_(std::make_unique<State>(std::move(shape), networks)) {}
NetworkBank::~NetworkBank() = default;
NetworkBank::NetworkBank(NetworkBank&&) noexcept = default;
NetworkBank& NetworkBank::operator=(NetworkBank&&) noexcept = default;

const NetworkShape& NetworkBank::shape() const noexcept {
  return state_->shape();
}

std::size_t NetworkBank::network_count() const noexcept {
  return state_->networks();
}

std::size_t NetworkBank::parameter_count() const noexcept {
  return network_count() * shape().parameter_count();
}

void NetworkBank::set_parameters(std::size_t network, std::span<const float> parameters) {
  assert(network < network_count() && parameters.size() == shape().parameter_count());
  state_->set(network, parameters);
}

void NetworkBank::parameters(std::size_t network, std::span<float> parameters) const {
  assert(network < network_count() && parameters.size() == shape().parameter_count());
  const std::span<const float> own = state_->of(network);
  std::copy(own.begin(), own.end(), parameters.begin());
}

void NetworkBank::evaluate(std::span<const float> inputs, std::span<float> outputs) {
  assert(inputs.size() == shape().inputs && outputs.size() == network_count() * shape().outputs());
  state_->evaluate(inputs, outputs);
}

void NetworkBank::evaluate_batch(std::span<const float> inputs, std::span<float> outputs) {
  const std::size_t count = inputs.size() / shape().inputs;
  const std::size_t each = network_count() * shape().outputs();
  assert(inputs.size() == count * shape().inputs && outputs.size() == count * each);
  for (std::size_t p = 0; p < count; ++p) {
    state_->evaluate(inputs.subspan(p * shape().inputs, shape().inputs), outputs.subspan(p * each, each));
  }
}

void NetworkBank::train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) {
  assert(batch.batch >= 1 && batch.chosen.size() == network_count() * batch.batch && errors.size() == network_count());
  assert(batch.weights.empty() || batch.weights.size() == batch.chosen.size());
  for (std::size_t network = 0; network < network_count(); ++network) {
    errors[network] = state_->train(batch, step, network);
  }
}

}  // namespace dermis::network
