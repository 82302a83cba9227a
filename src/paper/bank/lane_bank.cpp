// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/lane_bank.hpp"

#include <algorithm>
#include <cmath>

#include "paper/bank/bank_workers.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/bank/lane_bank.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "paper/bank/adam-inl.hpp"
#include "touch/network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using touch::network::HWY_NAMESPACE::activate;
using touch::network::HWY_NAMESPACE::slope_from_output;

using GroupTag = hn::CappedTag<float, kGroup>;
using GroupVector = hn::Vec<GroupTag>;
// Vectors to a group, and units of a tile of a product: 16 of the 32 registers of AVX-512, 8 of the 16 elsewhere.
constexpr std::size_t kGroupLanes = hn::MaxLanes(GroupTag());
constexpr std::size_t kTileUnits = kGroupLanes == kGroup ? 4 : 2;

HWY_INLINE GroupVector load(const float* place) {
  return hn::Load(GroupTag(), place);
}
HWY_INLINE void store(GroupVector value, float* place) {
  hn::Store(value, GroupTag(), place);
}

/// sums[i][j] += sum over `steps` of a[i * a_row + step * a_step] b[j * b_row + step * b_step], lane by lane.
template <std::size_t Rows, std::size_t Columns>
HWY_INLINE void accumulate(const float* a, std::size_t a_row, std::size_t a_step, const float* b, std::size_t b_row,
                           std::size_t b_step, std::size_t steps, GroupVector (&sums)[Rows][Columns]) {
  for (std::size_t step = 0; step < steps; ++step, a += a_step, b += b_step) {
    GroupVector right[Columns];
    for (std::size_t j = 0; j < Columns; ++j) right[j] = load(b + j * b_row);
    for (std::size_t i = 0; i < Rows; ++i) {
      const auto left = load(a + i * a_row);
      for (std::size_t j = 0; j < Columns; ++j) sums[i][j] = hn::MulAdd(left, right[j], sums[i][j]);
    }
  }
}

/// Calls tile(item) with as many items at a time as Size, then one by one.
template <std::size_t Size, class Tile>
HWY_INLINE void for_each_tile(std::size_t items, const Tile& tile) {
  std::size_t item = 0;
  for (; item + Size <= items; item += Size) tile(std::integral_constant<std::size_t, Size>(), item);
  for (; item < items; ++item) tile(std::integral_constant<std::size_t, 1>(), item);
}

/// Eq. (4) for one layer and Patterns patterns.
template <std::size_t Patterns>
void forward_layer(const NetworkShape& shape, std::size_t layer, const float* parameters, const float* below,
                   float* above) {
  const std::size_t fan_in = shape.fan_in(layer);
  const std::size_t units = shape.layers[layer].units;
  const float* weights = parameters + shape.weights(layer) * kGroup;
  const float* thresholds = parameters + shape.thresholds(layer) * kGroup;
  for_each_tile<kTileUnits>(units, [&](auto tile_units, std::size_t unit) {
    GroupVector sums[tile_units()][Patterns];
    for (std::size_t u = 0; u < tile_units(); ++u) {
      for (std::size_t p = 0; p < Patterns; ++p) sums[u][p] = load(thresholds + (unit + u) * kGroup);
    }
    accumulate(weights + unit * fan_in * kGroup, fan_in * kGroup, kGroup, below, fan_in * kGroup, kGroup, fan_in, sums);
    for (std::size_t u = 0; u < tile_units(); ++u) {
      for (std::size_t p = 0; p < Patterns; ++p) store(sums[u][p], above + (p * units + unit + u) * kGroup);
    }
  });
  for (std::size_t i = 0; i < Patterns * units; ++i) {
    store(activate(GroupTag(), shape.layers[layer].activation, load(above + i * kGroup)), above + i * kGroup);
  }
}

/// Eq. (4) for all layers. The lanes of the vector that starts with lane `lane` of the group.
template <std::size_t Patterns>
void forward(const NetworkShape& shape, const float* parameters, const float* inputs, std::size_t lane,
             LaneSpace& space) {
  const float* below = inputs + lane;
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    float* above = space.level(layer + 1) + lane;
    forward_layer<Patterns>(shape, layer, parameters + lane, below, above);
    below = above;
  }
}

/// gradient[unit][k] += sum over the patterns of delta_pu x_pk, and likewise of the thresholds.
void add_gradient(const NetworkShape& shape, std::size_t layer, const float* below, const float* deltas,
                  float* gradient) {
  const std::size_t fan_in = shape.fan_in(layer);
  const std::size_t units = shape.layers[layer].units;
  float* weights = gradient + shape.weights(layer) * kGroup;
  float* thresholds = gradient + shape.thresholds(layer) * kGroup;
  for_each_tile<kTileUnits>(units, [&](auto tile_units, std::size_t unit) {
    for_each_tile<4>(fan_in, [&](auto tile_inputs, std::size_t k) {
      GroupVector sums[tile_units()][tile_inputs()];
      const auto place = [&](std::size_t u, std::size_t i) { return weights + ((unit + u) * fan_in + k + i) * kGroup; };
      for (std::size_t u = 0; u < tile_units(); ++u) {
        for (std::size_t i = 0; i < tile_inputs(); ++i) sums[u][i] = load(place(u, i));
      }
      accumulate(deltas + unit * kGroup, kGroup, units * kGroup, below + k * kGroup, kGroup, fan_in * kGroup,
                 kTilePatterns, sums);
      for (std::size_t u = 0; u < tile_units(); ++u) {
        for (std::size_t i = 0; i < tile_inputs(); ++i) store(sums[u][i], place(u, i));
      }
    });
  });
  for (std::size_t unit = 0; unit < units; ++unit) {
    auto sum = load(thresholds + unit * kGroup);
    for (std::size_t p = 0; p < kTilePatterns; ++p) sum = hn::Add(sum, load(deltas + (p * units + unit) * kGroup));
    store(sum, thresholds + unit * kGroup);
  }
}

/// Turns what the layer below put out into its deltas: f'(o_pk) times the sum over the units of w_uk delta_pu.
void propagate(const NetworkShape& shape, std::size_t layer, const float* parameters, const float* deltas,
               float* below) {
  const std::size_t fan_in = shape.fan_in(layer);
  const std::size_t units = shape.layers[layer].units;
  const float* weights = parameters + shape.weights(layer) * kGroup;
  for_each_tile<kTileUnits>(fan_in, [&](auto tile_inputs, std::size_t k) {
    GroupVector sums[tile_inputs()][kTilePatterns];
    for (auto& row : sums) {
      for (auto& sum : row) sum = hn::Zero(GroupTag());
    }
    accumulate(weights + k * kGroup, kGroup, fan_in * kGroup, deltas, units * kGroup, kGroup, units, sums);
    for (std::size_t i = 0; i < tile_inputs(); ++i) {
      for (std::size_t p = 0; p < kTilePatterns; ++p) {
        float* place = below + (p * fan_in + k + i) * kGroup;
        const auto slope = slope_from_output(GroupTag(), shape.layers[layer - 1].activation, load(place));
        store(hn::Mul(sums[i][p], slope), place);
      }
    }
  });
}

/// Adds the error of the patterns; what the network puts out becomes the deltas of its last layer.
void take_error(const Layer& layer, const float* targets, const float* weights, float* outputs, float* errors) {
  const GroupTag d;
  auto error = load(errors);
  for (std::size_t p = 0; p < kTilePatterns; ++p) {
    const auto weight = load(weights + p * kGroup);
    for (std::size_t k = 0; k < layer.units; ++k) {
      float* place = outputs + (p * layer.units + k) * kGroup;
      const auto output = load(place);
      const auto difference = hn::Sub(output, load(targets + (p * layer.units + k) * kGroup));
      const auto scaled = hn::Mul(weight, difference);
      error = hn::MulAdd(hn::Mul(hn::Set(d, 0.5F), scaled), difference, error);
      store(hn::Mul(scaled, slope_from_output(d, layer.activation, output)), place);
    }
  }
  store(error, errors);
}

void evaluate_one(const NetworkShape& shape, const float* parameters, const float* inputs, LaneSpace& space) {
  for (std::size_t lane = 0; lane < kGroup; lane += kGroupLanes) forward<1>(shape, parameters, inputs, lane, space);
}

void evaluate_tile(const NetworkShape& shape, const float* parameters, const float* inputs, LaneSpace& space) {
  for (std::size_t lane = 0; lane < kGroup; lane += kGroupLanes) {
    forward<kTilePatterns>(shape, parameters, inputs, lane, space);
  }
}

/// Adds errors and gradients of the patterns that the space holds.
void add_patterns(const NetworkShape& shape, const float* parameters, LaneSpace& space, float* errors) {
  for (std::size_t lane = 0; lane < kGroup; lane += kGroupLanes) {
    forward<kTilePatterns>(shape, parameters, space.level(0), lane, space);
    std::size_t layer = shape.layers.size();
    take_error(shape.layers.back(), space.targets() + lane, space.weights() + lane, space.level(layer) + lane,
               errors + lane);
    while (layer-- > 0) {
      float* below = space.level(layer) + lane;
      const float* deltas = space.level(layer + 1) + lane;
      add_gradient(shape, layer, below, deltas, space.gradient.data() + lane);
      if (layer > 0) propagate(shape, layer, parameters + lane, deltas, below);
    }
  }
}

void move_group(const LaneParameters& parameters, const BankStep& step, std::span<const float> gradient) {
  const GroupTag d;
  for (std::size_t lane = 0; lane < kGroup; lane += kGroupLanes) {
    const auto rate = load(parameters.rate + lane);
    if (step.rule == BankStep::Rule::gradient_descent) {
      for (std::size_t i = lane; i < gradient.size(); i += kGroup) {
        store(hn::NegMulAdd(rate, load(&gradient[i]), load(parameters.values + i)), parameters.values + i);
      }
      continue;
    }
    const AdamStep<GroupTag> adam{d, rate, load(parameters.second_scale + lane), step};
    for (std::size_t i = lane; i < gradient.size(); i += kGroup) {
      adam.move(load(&gradient[i]), parameters.values + i, parameters.first_moments + i, parameters.second_moments + i);
    }
  }
}

}  // namespace
}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::paper {

HWY_EXPORT(evaluate_one);
HWY_EXPORT(evaluate_tile);
HWY_EXPORT(add_patterns);
HWY_EXPORT(move_group);

namespace {

/// Patterns of evaluate_batch() between two readings of all parameters.
constexpr std::size_t kPackedPatterns = 64;

}  // namespace

LaneSpace::LaneSpace(const NetworkShape& shape) : gradient(shape.parameter_count() * kGroup) {
  std::size_t size = 0;
  const auto reserve = [&](std::size_t values) {
    starts_.push_back(size);
    size += kTilePatterns * values * kGroup;
  };
  reserve(shape.inputs);
  for (const Layer& layer : shape.layers) reserve(layer.units);
  reserve(shape.outputs());
  reserve(1);
  values_.resize(size);
}

LaneBank::LaneBank(const NetworkShape& shape, std::size_t networks)
    : shape_(shape),
      networks_(networks),
      groups_((networks + kGroup - 1) / kGroup),
      group_size_(shape.parameter_count() * kGroup),
      values_(groups_ * group_size_),
      adam_steps_(groups_ * kGroup) {}

std::size_t LaneBank::training_bytes(const NetworkShape& shape, std::size_t networks, std::size_t batch) {
  const std::size_t values = (networks + kGroup - 1) / kGroup * kGroup * shape.parameter_count();
  return 3 * values * sizeof(float) + worker_count(values * batch) * LaneSpace(shape).bytes();
}

void LaneBank::set_parameters(std::size_t network, std::span<const float> parameters) {
  const std::size_t first = network / kGroup * group_size_ + network % kGroup;
  for (std::size_t i = 0; i < parameters.size(); ++i) values_[first + i * kGroup] = parameters[i];
  adam_steps_[network] = 0;
  if (first_moments_.empty()) return;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    first_moments_[first + i * kGroup] = 0.0F;
    second_moments_[first + i * kGroup] = 0.0F;
  }
}

void LaneBank::parameters(std::size_t network, std::span<float> parameters) const {
  const std::size_t first = network / kGroup * group_size_ + network % kGroup;
  for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i] = values_[first + i * kGroup];
}

void LaneBank::moment(AdamMoment which, std::size_t network, std::span<float> values) const {
  const HugeVector<float>& moments = which == AdamMoment::first ? first_moments_ : second_moments_;
  const std::size_t first = network / kGroup * group_size_ + network % kGroup;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = moments.empty() ? 0.0F : moments[first + i * kGroup];
}

void LaneBank::set_moment(AdamMoment which, std::size_t network, std::span<const float> values) {
  reserve_moments();
  HugeVector<float>& moments = which == AdamMoment::first ? first_moments_ : second_moments_;
  const std::size_t first = network / kGroup * group_size_ + network % kGroup;
  for (std::size_t i = 0; i < values.size(); ++i) moments[first + i * kGroup] = values[i];
}

void LaneBank::set_adam_steps(std::size_t steps) {
  std::fill(adam_steps_.begin(), adam_steps_.end(), steps);
}

void LaneBank::reserve_moments() {
  first_moments_.resize(values_.size());
  second_moments_.resize(values_.size());
}

void LaneBank::reserve_spaces(std::size_t workers) {
  while (spaces_.size() < workers) spaces_.emplace_back(shape_);
}

void LaneBank::evaluate(std::span<const float> inputs, std::span<float> outputs) {
  evaluate_batch(inputs, outputs);
}

void LaneBank::evaluate_batch(std::span<const float> inputs, std::span<float> outputs) {
  const std::size_t count = inputs.size() / shape_.inputs;
  const std::size_t workers = worker_count(values_.size() * count);
  reserve_spaces(workers);
  for (std::size_t first = 0; first < count; first += kPackedPatterns) {
    const std::size_t packed = std::min(kPackedPatterns, count - first);
    inputs_.resize(std::max(inputs_.size(), packed * shape_.inputs * kGroup));
    for (std::size_t i = 0; i < packed * shape_.inputs; ++i) {
      std::fill_n(&inputs_[i * kGroup], kGroup, inputs[first * shape_.inputs + i]);
    }
    share_among_workers(groups_, workers, [&](std::size_t group, std::size_t worker) {
      evaluate_group(group, first, packed, spaces_[worker], outputs);
    });
  }
}

void LaneBank::evaluate_group(std::size_t group, std::size_t first, std::size_t count, LaneSpace& space,
                              std::span<float> outputs) {
  const float* parameters = values_.data() + group * group_size_;
  const std::size_t networks = std::min(kGroup, networks_ - group * kGroup);
  for (std::size_t pattern = 0; pattern < count;) {
    const float* inputs = inputs_.data() + pattern * shape_.inputs * kGroup;
    const std::size_t tile = pattern + kTilePatterns <= count ? kTilePatterns : 1;
    if (tile == 1) {
      HWY_DYNAMIC_DISPATCH(evaluate_one)(shape_, parameters, inputs, space);
    } else {
      HWY_DYNAMIC_DISPATCH(evaluate_tile)(shape_, parameters, inputs, space);
    }
    const float* own = space.level(shape_.layers.size());
    for (std::size_t p = 0; p < tile; ++p) {
      float* to = &outputs[((first + pattern + p) * networks_ + group * kGroup) * shape_.outputs()];
      for (std::size_t k = 0; k < shape_.outputs(); ++k, own += kGroup) {
        for (std::size_t lane = 0; lane < networks; ++lane) to[lane * shape_.outputs() + k] = own[lane];
      }
    }
    pattern += tile;
  }
}

LaneParameters LaneBank::of(std::size_t group) {
  const std::size_t first = group * group_size_;
  const bool has_moments = !first_moments_.empty();
  return {values_.data() + first,
          has_moments ? first_moments_.data() + first : nullptr,
          has_moments ? second_moments_.data() + first : nullptr,
          {},
          {}};
}

LaneParameters LaneBank::step_of(std::size_t group, const BankStep& step) {
  LaneParameters own = of(group);
  for (std::size_t lane = 0; lane < kGroup; ++lane) {
    const bool is_adam = step.rule == BankStep::Rule::adam;
    const AdamScales scales = is_adam ? adam_scales(step, ++adam_steps_[group * kGroup + lane]) : AdamScales{step.rate};
    own.rate[lane] = scales.rate;
    own.second_scale[lane] = scales.second_scale;
  }
  return own;
}

void LaneBank::gather(const BankBatch& batch, std::size_t group, std::size_t first, LaneSpace& space) const {
  const std::size_t inputs = shape_.inputs;
  const std::size_t outputs = shape_.outputs();
  for (std::size_t p = 0; p < kTilePatterns; ++p) {
    for (std::size_t lane = 0; lane < kGroup; ++lane) {
      const std::size_t network = group * kGroup + lane;
      float* weight = space.weights() + p * kGroup + lane;
      *weight = 0.0F;
      if (network >= networks_ || first + p >= batch.batch) continue;
      const std::size_t place = network * batch.batch + first + p;
      const std::size_t row = batch.chosen[place];
      *weight = (batch.weights.empty() ? 1.0F : batch.weights[place]) / static_cast<float>(batch.batch);
      const float* from = &batch.inputs[row * inputs];
      float* to = space.level(0) + p * inputs * kGroup + lane;
      for (std::size_t k = 0; k < inputs; ++k) to[k * kGroup] = from[k];
      from = &batch.targets[(row * networks_ + network) * outputs];
      to = space.targets() + p * outputs * kGroup + lane;
      for (std::size_t k = 0; k < outputs; ++k) to[k * kGroup] = from[k];
    }
  }
}

void LaneBank::train_group(const BankBatch& batch, const BankStep& step, std::size_t group, LaneSpace& space,
                           std::span<float> errors) {
  alignas(64) float sums[kGroup] = {};
  std::fill(space.gradient.begin(), space.gradient.end(), 0.0F);
  for (std::size_t first = 0; first < batch.batch; first += kTilePatterns) {
    gather(batch, group, first, space);
    HWY_DYNAMIC_DISPATCH(add_patterns)(shape_, values_.data() + group * group_size_, space, sums);
  }
  HWY_DYNAMIC_DISPATCH(move_group)(step_of(group, step), step, space.gradient);
  std::copy_n(sums, std::min(kGroup, networks_ - group * kGroup), &errors[group * kGroup]);
}

void LaneBank::train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) {
  const std::size_t workers = worker_count(values_.size() * batch.batch);
  reserve_spaces(workers);
  if (step.rule == BankStep::Rule::adam) reserve_moments();
  share_among_workers(groups_, workers, [&](std::size_t group, std::size_t worker) {
    train_group(batch, step, group, spaces_[worker], errors);
  });
}

}  // namespace dermis::paper
#endif
