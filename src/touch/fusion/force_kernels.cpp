// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/fusion/force_kernels.hpp"

#include <cstddef>
#include <limits>

#include "dermis/touch/fusion/force_fusion.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "touch/fusion/force_kernels.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::touch::fusion::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// work(d, first) for the taxels first ... first + lanes(d) - 1, until all are done.
template <typename Work>
void for_all_lanes(std::size_t taxels, Work work) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t first = 0;
  for (; first + lanes <= taxels; first += lanes) work(d, first);
  for (; first < taxels; ++first) work(hn::CappedTag<float, 1>(), first);
}

void compute_inputs(const ExcessConductance excess, float* inputs) {
  constexpr float kLeastShare = 1e-20F;  // of the reference: keeps ln(e) finite
  const std::size_t taxels = excess.siemens.size();
  for_all_lanes(taxels, [&](auto d, std::size_t first) {
    const auto load = [&](std::span<const float> values) { return hn::LoadU(d, values.data() + first); };
    const auto siemens = load(excess.siemens);
    const auto is_zero = hn::Eq(siemens, hn::Zero(d));
    const auto asked = hn::IfThenElse(is_zero, load(excess.sigma_siemens), hn::Abs(siemens));
    const auto calibrated = hn::Min(asked, load(excess.heaviest_siemens));
    const auto share = hn::Max(hn::Div(calibrated, load(excess.reference_siemens)), hn::Set(d, kLeastShare));
    hn::StoreU(hn::Log(d, share), d, inputs + first);
    hn::StoreU(hn::Sub(share, hn::Set(d, 1.0F)), d, inputs + taxels + first);
  });
}

// Relative error of the exponent below the lightest calibrated load: docs/reasons/derivations-forces.md, "Beyond the
// calibrated loads".
constexpr float kExponentSigmaBelow = 0.1F;

/// Square of the relative error at a force between its knots.
template <class D>
hn::Vec<D> material_variance(D d, const ForceSources& sources, hn::Vec<D> log_newtons, std::size_t first) {
  const auto knot =
      hn::Mul(hn::Sub(log_newtons, hn::Set(d, sources.log_first_knot)), hn::Set(d, sources.knots_per_log));
  const auto place = hn::Clamp(knot, hn::Zero(d), hn::Set(d, static_cast<float>(kSigmaKnots - 1)));
  const float* rises = sources.variance_rises.data() + first;
  auto variance = hn::LoadU(d, rises);
  for (std::size_t k = 1; k < kSigmaKnots; ++k) {
    const auto beyond = hn::Max(hn::Sub(place, hn::Set(d, static_cast<float>(k - 1))), hn::Zero(d));
    rises += sources.log_gain.size();
    variance = hn::MulAdd(hn::Min(beyond, hn::Set(d, 1.0F)), hn::LoadU(d, rises), variance);
  }
  return variance;
}

/// By value: stores of vectors may alias what is reached through a reference.
void compute_forces(const ForceSources sources, const FusedForces fused) {
  constexpr float kLargestLog = 88.0F;  // of a float
  const std::size_t taxels = sources.log_gain.size();
  for_all_lanes(taxels, [&](auto d, std::size_t first) {
    const auto load = [&](std::span<const float> values, std::size_t row = 0) {
      return hn::LoadU(d, values.data() + row * taxels + first);
    };
    const auto one = hn::Set(d, 1.0F);
    const auto per_reference = load(sources.excess.per_reference_siemens);
    const auto log_share = load(sources.inputs);
    const auto share = hn::Add(load(sources.inputs, 1), one);
    const auto exponent = hn::MulAdd(load(sources.gradient, 1), share, load(sources.gradient));  // p
    const auto log_newtons =
        hn::Min(hn::Add(load(sources.log_newtons), load(sources.log_gain)), hn::Set(d, kLargestLog));
    const auto excess = load(sources.excess.siemens);
    const auto is_loaded = hn::Gt(excess, hn::Zero(d));
    const auto is_zero = hn::Eq(excess, hn::Zero(d));
    const auto magnitude = hn::Exp(d, log_newtons);
    hn::StoreU(hn::IfThenElseZero(is_loaded, magnitude), d, fused.newtons.data() + first);

    // Where the standard deviation is taken: at e, or at one standard deviation of e where that is more.
    const auto noise_share = hn::Mul(load(sources.excess.sigma_siemens), per_reference);
    const auto reached = hn::Max(hn::IfThenElse(is_loaded, share, noise_share), noise_share);
    const auto log_reached = hn::MulAdd(exponent, hn::Sub(hn::Log(d, reached), log_share), log_newtons);

    const auto per_reached = hn::Div(one, reached);
    const auto per_excess = hn::Mul(per_reached, per_reference);
    const auto chord = hn::Mul(noise_share, per_reached);
    const auto noise = hn::Mul(exponent, chord);
    const auto offset_drift = hn::Mul(hn::Mul(exponent, load(sources.offset_per_celsius)), per_excess);
    auto of_temperature = hn::Zero(d);
    if (sources.temperature_per_celsius > 0.0F) {
      of_temperature = hn::Mul(load(sources.gradient, 2), hn::Set(d, sources.temperature_per_celsius));
    }
    const auto per_celsius = hn::Sub(of_temperature, offset_drift);  // q
    const auto drift = hn::Mul(per_celsius, load(sources.temperature_sigma));
    const auto below = hn::Max(hn::Sub(hn::Set(d, sources.log_first_knot), log_reached), hn::Zero(d));
    const auto law_below = hn::Mul(hn::Set(d, kExponentSigmaBelow), below);
    const auto of_material = hn::Add(material_variance(d, sources, log_reached, first), load(sources.table_variance));
    const auto bent_below =
        hn::Mul(hn::Set(d, 0.5F * sources.bend_below), hn::Mul(below, hn::Min(below, hn::Set(d, 1.0F))));
    const auto of_law = hn::MulAdd(bent_below, bent_below, hn::MulAdd(law_below, law_below, of_material));
    auto variance = hn::Add(of_law, load(sources.gain_variance));
    variance = hn::MulAdd(noise, noise, variance);
    variance = hn::MulAdd(drift, drift, variance);
    const auto at_reached = hn::Exp(d, hn::Min(log_reached, hn::Set(d, kLargestLog)));
    const auto least = hn::Set(d, std::numeric_limits<float>::min());
    hn::StoreU(hn::Max(hn::Mul(at_reached, hn::Sqrt(variance)), least), d, fused.sigma_newtons.data() + first);
    hn::StoreU(hn::Mul(at_reached, noise), d, fused.noise_newtons.data() + first);

    // Noise lifts the mean of a bent law by half its second derivative times the variance, which the sums take away.
    const auto noise_part = hn::Div(noise_share, hn::Max(share, noise_share));
    const auto bend = hn::Mul(hn::Set(d, 0.5F), hn::Mul(exponent, hn::Sub(exponent, one)));
    const auto kept = hn::Max(hn::NegMulAdd(bend, hn::Mul(noise_part, noise_part), one), hn::Zero(d));
    const auto signed_newtons = hn::CopySign(hn::IfThenZeroElse(is_zero, hn::Mul(magnitude, kept)), excess);
    // Within the noise the chord from zero stands for the slope.
    const auto slope = hn::MulAdd(hn::Sub(one, exponent), hn::Mul(chord, chord), exponent);
    const auto per_siemens = hn::Mul(hn::Mul(at_reached, slope), per_excess);
    const auto of_zero = hn::Mul(per_siemens, load(sources.offset_sigma));
    const auto own_variance = hn::MulAdd(hn::Mul(signed_newtons, signed_newtons), of_law, hn::Mul(of_zero, of_zero));
    const auto of_offset = hn::Mul(per_siemens, load(sources.offset_per_celsius));
    hn::StoreU(signed_newtons, d, fused.signed_newtons.data() + first);
    hn::StoreU(own_variance, d, fused.own_variance.data() + first);
    hn::StoreU(per_siemens, d, fused.newtons_per_siemens.data() + first);
    hn::StoreU(hn::MulSub(signed_newtons, of_temperature, of_offset), d, fused.newtons_per_celsius.data() + first);
  });
}

}  // namespace dermis::touch::fusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::touch::fusion {

HWY_EXPORT(compute_inputs);
HWY_EXPORT(compute_forces);

void conductance_inputs(const ExcessConductance& excess, std::span<float> inputs) noexcept {
  HWY_DYNAMIC_DISPATCH(compute_inputs)(excess, inputs.data());
}

void forces(const ForceSources& sources, const FusedForces& fused) noexcept {
  HWY_DYNAMIC_DISPATCH(compute_forces)(sources, fused);
}

}  // namespace dermis::touch::fusion
#endif
