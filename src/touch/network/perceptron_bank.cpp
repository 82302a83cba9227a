// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/perceptron_bank.hpp"

#include <cassert>

// Parameters stand in tiles [tiles, parameter_count, kTile], which are read from front to back. Rows of all networks
// would lie a power of two apart, and displace each other from the cache.
#ifndef DERMIS_NETWORK_TILE
#define DERMIS_NETWORK_TILE
namespace dermis::touch::network {
inline constexpr std::size_t kTile = 16;  // as many as the widest vectors have lanes
}
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "touch/network/perceptron_bank.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "touch/network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::touch::network::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct BankView {
  PerceptronShape shape;
  std::size_t networks = 0;
  const float* parameters = nullptr;  // in tiles
  const float* inputs = nullptr;
  float* outputs = nullptr;
  float* gradient = nullptr;  // null where nobody asks

  [[nodiscard]] const float* parameters_of(std::size_t network) const {
    return parameters + network / kTile * kTile * shape.parameter_count() + network % kTile;
  }
};

/// Outputs of the networks first ... first + lanes(d) - 1.
template <class D>
HWY_INLINE void evaluate_lanes(D d, const BankView& bank, std::size_t first) {
  const PerceptronShape& shape = bank.shape;
  const float* const parameters = bank.parameters_of(first);
  const auto load = [&](std::size_t parameter) { return hn::LoadU(d, parameters + parameter * kTile); };
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

/// The same with d y / d x_i = s_i + sum_h v_h f'(z_h) w_hi, all in registers.
template <std::size_t Inputs, class D>
HWY_INLINE void evaluate_lanes_with_gradient(D d, const BankView& bank, std::size_t first) {
  const PerceptronShape& shape = bank.shape;
  const float* const parameters = bank.parameters_of(first);
  const auto load = [&](std::size_t parameter) { return hn::LoadU(d, parameters + parameter * kTile); };
  hn::Vec<D> x[Inputs];
  hn::Vec<D> gradient[Inputs];
  auto y = load(shape.output_bias());
  for (std::size_t input = 0; input < Inputs; ++input) {
    x[input] = hn::LoadU(d, bank.inputs + input * bank.networks + first);
    gradient[input] = load(shape.direct_weight(input));
    y = hn::MulAdd(gradient[input], x[input], y);
  }
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    auto sum = load(shape.bias(unit));
    hn::Vec<D> weight[Inputs];
    for (std::size_t input = 0; input < Inputs; ++input) {
      weight[input] = load(shape.weight(unit, input));
      sum = hn::MulAdd(weight[input], x[input], sum);
    }
    const auto activation = log_sigmoid(d, sum);
    const auto output_weight = load(shape.output_weight(unit));
    y = hn::MulAdd(output_weight, activation, y);
    const auto slope = hn::Mul(output_weight, slope_from_output(d, Activation::log_sigmoid, activation));
    for (std::size_t input = 0; input < Inputs; ++input) {
      gradient[input] = hn::MulAdd(slope, weight[input], gradient[input]);
    }
  }
  for (std::size_t input = 0; input < Inputs; ++input) {
    hn::StoreU(gradient[input], d, bank.gradient + input * bank.networks + first);
  }
  hn::StoreU(y, d, bank.outputs + first);
}

template <class D>
HWY_INLINE void evaluate_some(D d, const BankView& bank, std::size_t first) {
  if (bank.gradient == nullptr) return evaluate_lanes(d, bank, first);
  switch (bank.shape.inputs) {
    case 1: return evaluate_lanes_with_gradient<1>(d, bank, first);
    case 2: return evaluate_lanes_with_gradient<2>(d, bank, first);
    default: return evaluate_lanes_with_gradient<3>(d, bank, first);
  }
}

void evaluate_bank(const PerceptronShape& shape, std::size_t networks, const float* parameters, const float* inputs,
                   float* outputs, float* gradient) {
  const BankView bank{shape, networks, parameters, inputs, outputs, gradient};
  const hn::CappedTag<float, kTile> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t first = 0;
  for (; first + lanes <= bank.networks; first += lanes) evaluate_some(d, bank, first);
  for (; first < bank.networks; ++first) evaluate_some(hn::CappedTag<float, 1>(), bank, first);
}

}  // namespace dermis::touch::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::touch::network {

HWY_EXPORT(evaluate_bank);

PerceptronBank::PerceptronBank(const PerceptronShape& shape, std::size_t networks, std::span<const float> parameters)
    : shape_(shape), networks_(networks) {
  const std::size_t count = shape.parameter_count();
  assert(parameters.size() == count * networks);
  parameters_.resize((networks + kTile - 1) / kTile * kTile * count);
  for (std::size_t parameter = 0; parameter < count; ++parameter) {
    for (std::size_t network = 0; network < networks; ++network) {
      parameters_[(network / kTile * count + parameter) * kTile + network % kTile] =
          parameters[parameter * networks + network];
    }
  }
}

void PerceptronBank::evaluate(std::span<const float> inputs, std::span<float> outputs) const noexcept {
  assert(inputs.size() == shape_.inputs * networks_ && outputs.size() == networks_);
  HWY_DYNAMIC_DISPATCH(evaluate_bank)(shape_, networks_, parameters_.data(), inputs.data(), outputs.data(), nullptr);
}

void PerceptronBank::evaluate(std::span<const float> inputs, std::span<float> outputs,
                              std::span<float> gradient) const noexcept {
  assert(inputs.size() == shape_.inputs * networks_ && outputs.size() == networks_);
  assert(gradient.size() == inputs.size());
  HWY_DYNAMIC_DISPATCH(evaluate_bank)
  (shape_, networks_, parameters_.data(), inputs.data(), outputs.data(), gradient.data());
}

}  // namespace dermis::touch::network
#endif
