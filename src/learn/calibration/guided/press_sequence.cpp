// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/press_sequence.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace dermis::learn::calibration {

PressSequence::PressSequence(const CalibrationPlan& plan, std::size_t cols)
    : planned_(spread_presses(plan, cols)), steps_(planned_.size(), Step::open) {}

void PressSequence::keep(std::vector<RawFrame> frames) {
  kept_.push_back(
      std::make_shared<const GuidedPress>(GuidedPress{taxel(), weight_n(), std::move(frames), together_with()}));
  kept_steps_.push_back(step_);
  steps_[step_] = Step::kept;
}

const PressPair* PressSequence::pair() const {
  return step_ < planned_.size() ? nullptr : &pairs_[step_ - planned_.size()];
}

std::optional<std::size_t> PressSequence::together_with() const {
  return pair() ? std::optional(pair()->second) : std::nullopt;
}

std::vector<std::size_t> PressSequence::taxels() const {
  return pair() ? std::vector{pair()->first, pair()->second} : std::vector{taxel()};
}

void PressSequence::ask_for(std::vector<PressPair> pairs) {
  pairs_ = std::move(pairs);
  steps_.resize(planned_.size() + pairs_.size(), Step::open);
}

bool PressSequence::advance() {
  const auto open = std::find(steps_.begin(), steps_.end(), Step::open);
  if (open == steps_.end()) return false;
  step_ = static_cast<std::size_t>(open - steps_.begin());
  return true;
}

void PressSequence::repeat() {
  step_ = kept_steps_.back();
  steps_[step_] = Step::open;
  kept_.pop_back();
  kept_steps_.pop_back();
}

std::size_t PressSequence::count() const {
  return steps_.size() - static_cast<std::size_t>(std::count(steps_.begin(), steps_.end(), Step::skipped));
}

}  // namespace dermis::learn::calibration
