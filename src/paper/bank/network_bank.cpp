// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/network_bank.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "paper/bank/lane_bank.hpp"
#include "paper/bank/panel_bank.hpp"

namespace dermis::paper {

namespace {

/// Small networks lie side by side in the lanes of vectors, large ones each in panels of its own. Measured on N-N-N-1
/// and 256-N-1 networks (Zen 4, AVX-512), a training step in lanes takes a share of the time in panels. It is 0.3 for
/// 8-8-8-1, 0.6 for 16-16-16-1, 0.9 for 32-32-32-1 and 256-8-1 (2,145 and 2,065 parameters), and 1.1 for 48-48-48-1.
/// Evaluating gains more. Empty lanes cost as much as full ones. With 8 of 16 lanes filled the two are equal at 350 to
/// 600 parameters, with 2 of 16 at 45.
bool belongs_in_lanes(const NetworkShape& shape, std::size_t networks) {
  constexpr double kMostParameters = 2200.0;
  const double filled = static_cast<double>(networks) / static_cast<double>(round_up(networks, kGroup));
  return static_cast<double>(shape.parameter_count()) <= kMostParameters * filled * filled;
}

std::unique_ptr<BankStorage> make_storage(const NetworkShape& shape, std::size_t networks, std::size_t whole) {
  assert(shape.validate() && networks <= whole);
  if (belongs_in_lanes(shape, whole)) return std::make_unique<LaneBank>(shape, networks);
  return std::make_unique<PanelBank>(shape, networks);
}

}  // namespace

NetworkBank::NetworkBank(NetworkShape shape, std::size_t networks)
    : NetworkBank(std::move(shape), networks, networks) {}
NetworkBank::NetworkBank(NetworkShape shape, std::size_t networks, std::size_t whole)
    : shape_(std::move(shape)), networks_(networks), storage_(make_storage(shape_, networks, whole)) {}
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

void NetworkBank::moment(AdamMoment which, std::size_t network, std::span<float> values) const {
  assert(network < networks_ && values.size() == shape_.parameter_count());
  storage_->moment(which, network, values);
}

void NetworkBank::set_moment(AdamMoment which, std::size_t network, std::span<const float> values) {
  assert(network < networks_ && values.size() == shape_.parameter_count());
  storage_->set_moment(which, network, values);
}

void NetworkBank::set_adam_steps(std::size_t steps) {
  storage_->set_adam_steps(steps);
}

std::size_t NetworkBank::training_bytes(const NetworkShape& shape, std::size_t networks, std::size_t whole,
                                        std::size_t batch) {
  return belongs_in_lanes(shape, whole) ? LaneBank::training_bytes(shape, networks, batch)
                                        : PanelBank::training_bytes(shape, networks, batch);
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

}  // namespace dermis::paper
