// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/network/network_bank.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "network/panel_bank.hpp"

namespace dermis::network {

NetworkBank::NetworkBank(NetworkShape shape, std::size_t networks)
    : shape_(std::move(shape)), networks_(networks), storage_(std::make_unique<PanelBank>(shape_, networks)) {}
NetworkBank::~NetworkBank() = default;
NetworkBank::NetworkBank(NetworkBank&&) noexcept = default;
NetworkBank& NetworkBank::operator=(NetworkBank&&) noexcept = default;

void NetworkBank::set_parameters(std::size_t network, std::span<const float> parameters) {
  assert(network < networks_ && parameters.size() == shape_.parameter_count());
  storage_->set_parameters(network, parameters);
}

void NetworkBank::parameters(std::size_t network, std::span<float> parameters) const {
  assert(network < networks_ && parameters.size() == shape_.parameter_count());
  storage_->parameters(network, parameters);
}

void NetworkBank::evaluate(std::span<const float> inputs, std::span<float> outputs) {
  assert(inputs.size() == shape_.inputs && outputs.size() == networks_ * shape_.outputs());
  storage_->evaluate(inputs, outputs);
}

void NetworkBank::evaluate_batch(std::span<const float> inputs, std::span<float> outputs) {
  assert(inputs.size() % shape_.inputs == 0);
  assert(outputs.size() == inputs.size() / shape_.inputs * networks_ * shape_.outputs());
  storage_->evaluate_batch(inputs, outputs);
}

void NetworkBank::train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) {
  assert(batch.batch >= 1 && batch.chosen.size() == networks_ * batch.batch && errors.size() == networks_);
  assert(batch.weights.empty() || batch.weights.size() == batch.chosen.size());
  assert(batch.inputs.size() / shape_.inputs == batch.targets.size() / (networks_ * shape_.outputs()));
  assert(std::all_of(batch.chosen.begin(), batch.chosen.end(),
                     [&](std::size_t row) { return row < batch.inputs.size() / shape_.inputs; }));
  assert(step.rate > 0.0F && step.epsilon > 0.0F);
  storage_->train_step(batch, step, errors);
}

}  // namespace dermis::network
