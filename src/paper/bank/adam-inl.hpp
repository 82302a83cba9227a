// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_ADAM_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_ADAM_INL_HPP
#undef DERMIS_PAPER_ADAM_INL_HPP
#else
#define DERMIS_PAPER_ADAM_INL_HPP
#endif

#include "hwy/highway.h"
#include "paper/bank/adam_scales.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Algorithm 1 of Kingma and Ba (2015) for a vector of parameters; `rate` and `second_scale` are AdamScales.
template <class D>
class AdamStep {
 public:
  AdamStep(D d, hn::Vec<D> rate, hn::Vec<D> second_scale, const BankStep& step)
      : rate_(rate),
        second_scale_(second_scale),
        first_rest_(hn::Set(d, 1.0F - step.first_decay)),
        second_rest_(hn::Set(d, 1.0F - step.second_decay)),
        epsilon_(hn::Set(d, step.epsilon)) {}

  HWY_INLINE void move(hn::Vec<D> gradient, float* HWY_RESTRICT value, float* HWY_RESTRICT first_moment,
                       float* HWY_RESTRICT second_moment) const {
    const D d;
    auto first = hn::Load(d, first_moment);
    auto second = hn::Load(d, second_moment);
    first = hn::MulAdd(first_rest_, hn::Sub(gradient, first), first);
    second = hn::MulAdd(second_rest_, hn::MulSub(gradient, gradient, second), second);
    hn::Store(first, d, first_moment);
    hn::Store(second, d, second_moment);
    const auto deviation = hn::Add(hn::Sqrt(hn::Mul(second, second_scale_)), epsilon_);
    hn::Store(hn::Sub(hn::Load(d, value), hn::Div(hn::Mul(rate_, first), deviation)), d, value);
  }

 private:
  hn::Vec<D> rate_;
  hn::Vec<D> second_scale_;
  hn::Vec<D> first_rest_;
  hn::Vec<D> second_rest_;
  hn::Vec<D> epsilon_;
};

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
