// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/panel_bank.hpp"

#include <algorithm>

#include "paper/bank/bank_workers.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/bank/panel_bank.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "paper/bank/panel_backward-inl.hpp"
#include "paper/bank/panel_evaluate-inl.hpp"
#include "paper/bank/panel_forward-inl.hpp"
#include "paper/bank/panel_rules-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace {

void evaluate_frame(const PanelLayout& layout, const float* parameters, const float* inputs, float* space,
                    float* outputs) {
  evaluate_network(layout, parameters, inputs, space, outputs);
}

/// One step on the patterns that the space holds; the error before it.
float train_patterns(const PanelLayout& layout, const PanelParameters& parameters, const BankStep& step,
                     const AdamScales& scales, std::size_t patterns, PatternSpace& space) {
  forward(layout, parameters.values, space.level(0), space.stride(0), space.rows(), space);
  const std::size_t top = layout.layers().size();
  const float error = take_error(layout.layers().back(), {space.level(top), space.stride(top)}, space, patterns);
  if (step.rule == BankStep::Rule::adam) {
    backward(layout, parameters.values, AdamRule(parameters, step, scales), space, patterns);
  } else {
    backward(layout, parameters.values, DescentRule(parameters, step.rate), space, patterns);
  }
  return error;
}

}  // namespace
}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::paper {

HWY_EXPORT(evaluate_frame);
HWY_EXPORT(forward);
HWY_EXPORT(train_patterns);

namespace {

/// Patterns of evaluate_batch() between two readings of all weights.
constexpr std::size_t kPackedPatterns = 1024;

}  // namespace

PanelBank::PanelBank(const NetworkShape& shape, std::size_t networks)
    : layout_(shape), networks_(networks), values_(networks * layout_.size()), adam_steps_(networks) {}

std::size_t PanelBank::training_bytes(const NetworkShape& shape, std::size_t networks, std::size_t batch) {
  const PanelLayout layout(shape);
  const std::size_t values = networks * layout.size();
  return 3 * values * sizeof(float) + worker_count(values * batch) * PatternSpace(layout, batch).bytes();
}

PanelParameters PanelBank::of(std::size_t network) {
  const std::size_t first = network * layout_.size();
  const bool has_moments = !first_moments_.empty();
  return {values_.data() + first, has_moments ? first_moments_.data() + first : nullptr,
          has_moments ? second_moments_.data() + first : nullptr};
}

void PanelBank::set_parameters(std::size_t network, std::span<const float> parameters) {
  const PanelParameters own = of(network);
  for (float* values : {own.values, own.first_moments, own.second_moments}) {
    if (values != nullptr) std::fill_n(values, layout_.size(), 0.0F);
  }
  adam_steps_[network] = 0;
  layout_.for_each_parameter([&](std::size_t index, std::size_t place) { own.values[place] = parameters[index]; });
}

void PanelBank::parameters(std::size_t network, std::span<float> parameters) const {
  const float* own = values_.data() + network * layout_.size();
  layout_.for_each_parameter([&](std::size_t index, std::size_t place) { parameters[index] = own[place]; });
}

void PanelBank::moment(AdamMoment which, std::size_t network, std::span<float> values) const {
  const HugeVector<float>& moments = which == AdamMoment::first ? first_moments_ : second_moments_;
  if (moments.empty()) return std::fill(values.begin(), values.end(), 0.0F);
  const float* own = moments.data() + network * layout_.size();
  layout_.for_each_parameter([&](std::size_t index, std::size_t place) { values[index] = own[place]; });
}

void PanelBank::set_moment(AdamMoment which, std::size_t network, std::span<const float> values) {
  reserve_moments();
  float* own = which == AdamMoment::first ? of(network).first_moments : of(network).second_moments;
  layout_.for_each_parameter([&](std::size_t index, std::size_t place) { own[place] = values[index]; });
}

void PanelBank::set_adam_steps(std::size_t steps) {
  std::fill(adam_steps_.begin(), adam_steps_.end(), steps);
}

void PanelBank::reserve_moments() {
  first_moments_.resize(values_.size());
  second_moments_.resize(values_.size());
}

void PanelBank::evaluate(std::span<const float> inputs, std::span<float> outputs) {
  const std::size_t workers = worker_count(values_.size());
  frame_.prepare(layout_, inputs, workers);
  share_among_workers(networks_, workers, [&](std::size_t item, std::size_t worker) {
    const std::size_t network = frame_.network(item, networks_);
    HWY_DYNAMIC_DISPATCH(evaluate_frame)
    (layout_, of(network).values, frame_.inputs(), frame_.rows(worker), outputs.data() + network * layout_.outputs());
  });
}

void PanelBank::reserve(std::vector<PatternSpace>& spaces, std::size_t workers, std::size_t patterns) const {
  if (spaces.size() >= workers && spaces.front().weights.size() == patterns) return;
  spaces.assign(workers, PatternSpace(layout_, patterns));
}

void PanelBank::evaluate_batch(std::span<const float> inputs, std::span<float> outputs) {
  const std::size_t count = inputs.size() / layout_.inputs();
  const std::size_t workers = worker_count(values_.size() * count);
  const std::size_t stride = row_stride(layout_.inputs());
  reserve(block_spaces_, workers, kBlock);
  for (std::size_t first = 0; first < count; first += kPackedPatterns) {
    const std::size_t packed = std::min(kPackedPatterns, count - first);
    packed_.resize(std::max(packed_.size(), round_up(packed, kLanes) * stride));
    for (std::size_t p = 0; p < packed; ++p) {
      pack_row(inputs.subspan((first + p) * layout_.inputs(), layout_.inputs()),
               std::span(packed_).subspan(p * stride, stride));
    }
    share_among_workers(networks_, workers, [&](std::size_t network, std::size_t worker) {
      PatternSpace& own = block_spaces_[worker];
      for (std::size_t block = 0; block < packed; block += kBlock) {
        const std::size_t rows = std::min(kBlock, packed - block);
        HWY_DYNAMIC_DISPATCH(forward)
        (layout_, of(network).values, packed_.data() + block * stride, stride, round_up(rows, 8), own);
        const std::size_t top = layout_.layers().size();
        for (std::size_t p = 0; p < rows; ++p) {
          std::copy_n(own.level(top) + p * own.stride(top), layout_.outputs(),
                      &outputs[((first + block + p) * networks_ + network) * layout_.outputs()]);
        }
      }
    });
  }
}

void PanelBank::train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) {
  const std::size_t workers = worker_count(values_.size() * batch.batch);
  reserve(batch_spaces_, workers, batch.batch);
  if (step.rule == BankStep::Rule::adam) reserve_moments();
  share_among_workers(networks_, workers, [&](std::size_t network, std::size_t worker) {
    errors[network] = train_network(batch, step, network, batch_spaces_[worker]);
  });
}

float PanelBank::train_network(const BankBatch& batch, const BankStep& step, std::size_t network, PatternSpace& space) {
  const std::size_t outputs = layout_.outputs();
  for (std::size_t p = 0; p < batch.batch; ++p) {
    const std::size_t row = batch.chosen[network * batch.batch + p];
    pack_row(batch.inputs.subspan(row * layout_.inputs(), layout_.inputs()),
             {space.level(0) + p * space.stride(0), space.stride(0)});
    std::copy_n(&batch.targets[(row * networks_ + network) * outputs], outputs, &space.targets[p * outputs]);
    const float weight = batch.weights.empty() ? 1.0F : batch.weights[network * batch.batch + p];
    space.weights[p] = weight / static_cast<float>(batch.batch);
  }
  const bool is_adam = step.rule == BankStep::Rule::adam;
  const AdamScales scales = is_adam ? adam_scales(step, ++adam_steps_[network]) : AdamScales{step.rate};
  return HWY_DYNAMIC_DISPATCH(train_patterns)(layout_, of(network), step, scales, batch.batch, space);
}

}  // namespace dermis::paper
#endif
