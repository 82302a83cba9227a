// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/half_network_bank.hpp"

#include <cassert>
#include <cmath>
#include <string>

#include "paper/bank/bank_workers.hpp"
#include "paper/bank/frame_space.hpp"
#include "paper/bank/huge_vector.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/bank/half_network_bank.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "paper/bank/panel_evaluate-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void round_to_half(std::span<const float> values, hwy::float16_t* halves) {
  const FullTag d;
  for (std::size_t i = 0; i < values.size(); i += kVectorLanes) {
    const hn::Rebind<hwy::float16_t, FullTag> d_half;
    hn::StoreU(hn::DemoteTo(d_half, hn::LoadU(d, values.data() + i)), d_half, halves + i);
  }
}

void evaluate_half_frame(const PanelLayout& layout, const hwy::float16_t* parameters, const float* inputs, float* space,
                         float* outputs) {
  evaluate_network(layout, parameters, inputs, space, outputs);
}

}  // namespace
}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::paper {

HWY_EXPORT(round_to_half);
HWY_EXPORT(evaluate_half_frame);

class HalfPanels {
 public:
  HalfPanels(const NetworkShape& shape, std::size_t networks)
      : layout_(shape), networks_(networks), values_(networks * layout_.size()) {}

  void set_parameters(std::size_t network, std::span<const float> parameters) {
    std::vector<float> panels(layout_.size());
    layout_.for_each_parameter([&](std::size_t index, std::size_t place) { panels[place] = parameters[index]; });
    HWY_DYNAMIC_DISPATCH(round_to_half)(panels, of(network));
  }

  void evaluate(std::span<const float> inputs, std::span<float> outputs) {
    const std::size_t workers = worker_count(values_.size());
    frame_.prepare(layout_, inputs, workers);
    share_among_workers(networks_, workers, [&](std::size_t item, std::size_t worker) {
      const std::size_t network = frame_.network(item, networks_);
      HWY_DYNAMIC_DISPATCH(evaluate_half_frame)
      (layout_, of(network), frame_.inputs(), frame_.rows(worker), outputs.data() + network * layout_.outputs());
    });
  }

 private:
  hwy::float16_t* of(std::size_t network) { return values_.data() + network * layout_.size(); }

  PanelLayout layout_;
  std::size_t networks_;
  HugeVector<hwy::float16_t> values_;  ///< [networks, layout.size]
  FrameSpace frame_;
};

HalfNetworkBank::HalfNetworkBank(const NetworkBank& bank)
    : shape_(bank.shape()), networks_(bank.network_count()), panels_(std::make_unique<HalfPanels>(shape_, networks_)) {}
HalfNetworkBank::~HalfNetworkBank() = default;
HalfNetworkBank::HalfNetworkBank(HalfNetworkBank&&) noexcept = default;
HalfNetworkBank& HalfNetworkBank::operator=(HalfNetworkBank&&) noexcept = default;

Result<HalfNetworkBank> HalfNetworkBank::from(const NetworkBank& bank) {
  constexpr float kLargestHalf = 65'504.0F;
  HalfNetworkBank half(bank);
  std::vector<float> parameters(bank.shape().parameter_count());
  for (std::size_t network = 0; network < bank.network_count(); ++network) {
    bank.parameters(network, parameters);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (std::abs(parameters[i]) <= kLargestHalf) continue;
      return failed("network " + std::to_string(network) + ", parameter " + std::to_string(i) + ": " +
                    std::to_string(parameters[i]) + " does not fit 16 bits; evaluate this bank in single precision");
    }
    half.panels_->set_parameters(network, parameters);
  }
  return half;
}

void HalfNetworkBank::evaluate(std::span<const float> inputs, std::span<float> outputs) {
  assert(inputs.size() == shape_.inputs && outputs.size() == networks_ * shape_.outputs());
  panels_->evaluate(inputs, outputs);
}

}  // namespace dermis::paper
#endif
