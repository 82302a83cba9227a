// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The transfer functions in SIMD lanes. Compiled once for every instruction set: include it below
// hwy/foreach_target.h.

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "dermis/touch/network/activation.hpp"
#include "hwy/highway.h"

#if defined(DERMIS_NETWORK_ACTIVATION_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_NETWORK_ACTIVATION_INL_HPP
#undef DERMIS_NETWORK_ACTIVATION_INL_HPP
#else
#define DERMIS_NETWORK_ACTIVATION_INL_HPP
#endif

HWY_BEFORE_NAMESPACE();
namespace dermis::touch::network::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr double kLog2OfE = 1.4426950408889634;

/// The constants of 2^z in each precision. `series`: minimax polynomial of (2^r - 1) / r on [-1/2, 1/2], the lowest
/// power first (Remez). 2^r is then right to 9.2e-8 in float and 2e-17 in double before rounding.
template <typename Real>
struct PowerOfTwo;

template <>
struct PowerOfTwo<float> {
  static constexpr int kMantissaBits = 23;
  static constexpr float kBias = 127.0F;
  static constexpr float kLargest = 126.0F;
  static constexpr float kRounder = 12582912.0F;  // 1.5 * 2^23: adding it leaves the nearest integer in the low bits
  static constexpr float kSeries[] = {0.6931469776111373F, 0.2402224209516051F, 0.05550733723250986F,
                                      0.009671512330553907F, 0.0013264733830804746F};
};

template <>
struct PowerOfTwo<double> {
  static constexpr int kMantissaBits = 52;
  static constexpr double kBias = 1023.0;
  static constexpr double kLargest = 1022.0;
  static constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52
  static constexpr double kSeries[] = {0.6931471805599453,     0.24022650695910097,    0.055504108664821236,
                                       0.009618129107607069,   0.0013333558146531735,  0.00015403530441475568,
                                       1.5252733701068561e-05, 1.3215442727152607e-06, 1.0178121379830621e-07,
                                       7.072561162989455e-09,  4.4455223771342466e-10};
};

/// z within the powers of two that numbers have. NaN stays NaN: x86 gives the second operand then; elsewhere Min and
/// Max may swallow it.
template <class D>
HWY_INLINE hn::Vec<D> bounded_power(D d, hn::Vec<D> z) {
  const auto largest = hn::Set(d, PowerOfTwo<hn::TFromD<D>>::kLargest);
#if HWY_TARGET <= HWY_SSSE3
  return hn::Max(hn::Neg(largest), hn::Min(largest, z));
#else
  const auto not_above = hn::IfThenElse(hn::Gt(z, largest), largest, z);
  return hn::IfThenElse(hn::Lt(z, hn::Neg(largest)), hn::Neg(largest), not_above);
#endif
}

/// (2^r - 1) / r for |r| <= 1/2.
template <class D>
HWY_INLINE hn::Vec<D> power_series(D d, hn::Vec<D> r) {
  constexpr auto& kSeries = PowerOfTwo<hn::TFromD<D>>::kSeries;
  constexpr std::size_t kTerms = std::size(kSeries);
  auto sum = hn::Set(d, kSeries[kTerms - 1]);
  for (std::size_t k = kTerms - 1; k-- > 0;) sum = hn::MulAdd(sum, r, hn::Set(d, kSeries[k]));
  return sum;
}

/// 2^z = scale * 2^rest, |rest| <= 1/2, within the powers of two that numbers have. `rest` is NaN where z is.
template <class D>
struct SplitPower {
  hn::Vec<D> scale;
  hn::Vec<D> rest;
};

template <class D>
HWY_INLINE SplitPower<D> split_power(D d, hn::Vec<D> z) {
  using Real = hn::TFromD<D>;
  const hn::RebindToSigned<D> di;
  const auto rounder = hn::Set(d, PowerOfTwo<Real>::kRounder + PowerOfTwo<Real>::kBias);
  const auto bounded = bounded_power(d, z);
  const auto rounded = hn::Add(bounded, rounder);
  const auto rest = hn::Sub(bounded, hn::Sub(rounded, rounder));
  return {hn::BitCast(d, hn::ShiftLeft<PowerOfTwo<Real>::kMantissaBits>(hn::BitCast(di, rounded))), rest};
}

/// exp(x), within the powers of two that numbers have. Relative error below (1 + |x|) times that of rounding.
template <class D>
HWY_INLINE hn::Vec<D> exponential(D d, hn::Vec<D> x) {
  using Real = hn::TFromD<D>;
  const auto [scale, rest] = split_power(d, hn::Mul(x, hn::Set(d, static_cast<Real>(kLog2OfE))));
  return hn::Mul(scale, hn::MulAdd(power_series(d, rest), rest, hn::Set(d, Real{1})));
}

/// The factor on the sum of a neuron before log_sigmoid_of_power() and tanh_of_power(). The engine scales weights and
/// thresholds instead, once an epoch.
inline constexpr double kLogSigmoidPower = -kLog2OfE;
inline constexpr double kTanhPower = 2.0 * kLog2OfE;

/// 1 / (1 + 2^z), eq. (3) of the paper with z = -log2(e) x. Absolute error below 1.3e-7 in float, 3e-16 in double.
template <class D>
HWY_INLINE hn::Vec<D> log_sigmoid_of_power(D d, hn::Vec<D> z) {
  const auto one = hn::Set(d, hn::TFromD<D>{1});
  const auto [scale, rest] = split_power(d, z);
  const auto fraction = hn::MulAdd(power_series(d, rest), rest, one);  // 2^rest
  return hn::Div(one, hn::MulAdd(scale, fraction, one));
}

/// (2^z - 1) / (2^z + 1), tanh x with z = 2 log2(e) x. Absolute error below 1.5e-7 in float, 3e-16 in double; the
/// relative error stays small at 0.
template <class D>
HWY_INLINE hn::Vec<D> tanh_of_power(D d, hn::Vec<D> z) {
  using Real = hn::TFromD<D>;
  const auto [scale, rest] = split_power(d, z);
  const auto power_less_1 =
      hn::MulAdd(scale, hn::Mul(power_series(d, rest), rest), hn::Sub(scale, hn::Set(d, Real{1})));
  return hn::Div(power_less_1, hn::Add(power_less_1, hn::Set(d, Real{2})));
}

/// The sigmoid of eq. (3).
template <class D>
HWY_INLINE hn::Vec<D> log_sigmoid(D d, hn::Vec<D> sum) {
  return log_sigmoid_of_power(d, hn::Mul(sum, hn::Set(d, static_cast<hn::TFromD<D>>(kLogSigmoidPower))));
}

template <class D>
HWY_INLINE hn::Vec<D> tanh(D d, hn::Vec<D> sum) {
  return tanh_of_power(d, hn::Mul(sum, hn::Set(d, static_cast<hn::TFromD<D>>(kTanhPower))));
}

/// f(sum).
template <class D>
HWY_INLINE hn::Vec<D> activate(D d, Activation activation, hn::Vec<D> sum) {
  switch (activation) {
    case Activation::log_sigmoid: return log_sigmoid(d, sum);
    case Activation::tanh: return tanh(d, sum);
    case Activation::relu: return hn::IfThenZeroElse(hn::Lt(sum, hn::Zero(d)), sum);
    case Activation::linear: break;
  }
  return sum;
}

/// f'(sum) as a function of f(sum).
template <class D>
HWY_INLINE hn::Vec<D> slope_from_output(D d, Activation activation, hn::Vec<D> output) {
  const auto one = hn::Set(d, hn::TFromD<D>{1});
  switch (activation) {
    case Activation::log_sigmoid: return hn::NegMulAdd(output, output, output);
    case Activation::tanh: return hn::NegMulAdd(output, output, one);
    case Activation::relu: return hn::IfThenElseZero(hn::Gt(output, hn::Zero(d)), one);
    case Activation::linear: break;
  }
  return one;
}

}  // namespace dermis::touch::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DERMIS_NETWORK_ACTIVATION_INL_HPP
