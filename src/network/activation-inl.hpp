// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_NETWORK_ACTIVATION_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_NETWORK_ACTIVATION_INL_HPP
#undef DERMIS_NETWORK_ACTIVATION_INL_HPP
#else
#define DERMIS_NETWORK_ACTIVATION_INL_HPP
#endif

#include "dermis/network/activation.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::network::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// 2^x for |x| <= 126, relative error 2e-7: a minimax polynomial between -1/2 and 1/2.
template <class D>
HWY_INLINE hn::Vec<D> power_of_two(D d, hn::Vec<D> x) {
  const hn::RebindToSigned<D> di;
  // 1.5 * 2^23: its sum with x holds the nearest integer in the low bits.
  const auto shift = hn::Set(d, 12582912.0F);
  const auto shifted = hn::Add(x, shift);
  const auto rest = hn::Sub(x, hn::Sub(shifted, shift));
  auto power = hn::Set(d, 1.327647245e-3F);
  for (const float coefficient : {9.675540961e-3F, 5.550713092e-2F, 2.402212024e-1F, 6.931469440e-1F, 1.000000119F}) {
    power = hn::MulAdd(power, rest, hn::Set(d, coefficient));
  }
  const auto exponent = hn::ShiftLeft<23>(hn::BitCast(di, shifted));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, power), exponent));
}

/// 1 / (1 + 2^-x), NaN for NaN.
template <class D>
HWY_INLINE hn::Vec<D> sigmoid_of_two(D d, hn::Vec<D> x) {
  const auto bounded = hn::Min(hn::Max(hn::Neg(x), hn::Set(d, -126.0F)), hn::Set(d, 126.0F));
  const auto one = hn::Set(d, 1.0F);
  const auto y = hn::Div(one, hn::Add(one, power_of_two(d, bounded)));
  return hn::IfThenElse(hn::IsNaN(x), x, y);
}

/// f(sum); log-sigmoid and tanh with an absolute error below 3e-7.
template <class D>
HWY_INLINE hn::Vec<D> activate(D d, Activation activation, hn::Vec<D> sum) {
  constexpr float kLog2E = 1.44269504F;
  const auto one = hn::Set(d, 1.0F);
  switch (activation) {
    case Activation::log_sigmoid: return sigmoid_of_two(d, hn::Mul(sum, hn::Set(d, kLog2E)));
    case Activation::tanh: {
      const auto y = sigmoid_of_two(d, hn::Mul(sum, hn::Set(d, 2.0F * kLog2E)));
      return hn::Sub(hn::Add(y, y), one);
    }
    case Activation::relu: return hn::IfThenZeroElse(hn::Lt(sum, hn::Zero(d)), sum);
    case Activation::linear: break;
  }
  return sum;
}

/// f'(sum) as a function of f(sum).
template <class D>
HWY_INLINE hn::Vec<D> slope_from_output(D d, Activation activation, hn::Vec<D> output) {
  const auto one = hn::Set(d, 1.0F);
  switch (activation) {
    case Activation::log_sigmoid: return hn::NegMulAdd(output, output, output);
    case Activation::tanh: return hn::NegMulAdd(output, output, one);
    case Activation::relu: return hn::IfThenElseZero(hn::Gt(output, hn::Zero(d)), one);
    case Activation::linear: break;
  }
  return one;
}

}  // namespace dermis::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
