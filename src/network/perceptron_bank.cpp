// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/network/perceptron_bank.hpp"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "network/perceptron_bank.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::network::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct BankView {
  const PerceptronShape& shape;
  std::size_t networks;
  const float* parameters;
  const float* inputs;
  float* outputs;
};

/// Outputs of the networks first ... first + lanes(d) - 1.
template <class D>
void evaluate_lanes(D d, const BankView& bank, std::size_t first) {
  const PerceptronShape& shape = bank.shape;
  const auto load = [&](std::size_t parameter) {
    return hn::LoadU(d, bank.parameters + parameter * bank.networks + first);
  };
  const auto load_input = [&](std::size_t input) { return hn::LoadU(d, bank.inputs + input * bank.networks + first); };
  auto y = load(shape.output_bias());
  for (std::size_t input = 0; input < shape.inputs; ++input) {
    y = hn::MulAdd(load(shape.direct_weight(input)), load_input(input), y);
  }
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    auto sum = load(shape.bias(unit));
    for (std::size_t input = 0; input < shape.inputs; ++input) {
      sum = hn::MulAdd(load(shape.weight(unit, input)), load_input(input), sum);
    }
    y = hn::MulAdd(load(shape.output_weight(unit)), log_sigmoid(d, sum), y);
  }
  hn::StoreU(y, d, bank.outputs + first);
}

void evaluate_bank(const PerceptronShape& shape, std::size_t networks, const float* parameters, const float* inputs,
                   float* outputs) {
  const BankView bank{shape, networks, parameters, inputs, outputs};
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t first = 0;
  for (; first + lanes <= bank.networks; first += lanes) evaluate_lanes(d, bank, first);
  for (; first < bank.networks; ++first) evaluate_lanes(hn::CappedTag<float, 1>(), bank, first);
}

}  // namespace dermis::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::network {

HWY_EXPORT(evaluate_bank);

PerceptronBank::PerceptronBank(const PerceptronShape& shape, std::size_t networks, std::span<const float> parameters)
    : shape_(shape), networks_(networks), parameters_(parameters.begin(), parameters.end()) {
  assert(parameters.size() == shape.parameter_count() * networks);
}

void PerceptronBank::evaluate(std::span<const float> inputs, std::span<float> outputs) const noexcept {
  assert(inputs.size() == shape_.inputs * networks_ && outputs.size() == networks_);
  HWY_DYNAMIC_DISPATCH(evaluate_bank)(shape_, networks_, parameters_.data(), inputs.data(), outputs.data());
}

}  // namespace dermis::network
#endif
