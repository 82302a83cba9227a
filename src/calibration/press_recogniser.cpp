// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/press_recogniser.hpp"

#include <algorithm>
#include <utility>

namespace dermis::calibration {
namespace {

constexpr double kReleasedShare = 0.15;  // of the excess of the press
constexpr double kLostShare = 0.5;
constexpr double kTogetherShare = 0.25;      // of the excess of the taxel that feels more of two with the same weight
constexpr double kOtherTaxelSeconds = 0.15;  // while a weight is put on

}  // namespace

PressRecogniser::PressRecogniser(TouchSense sense, Nanos hold_time) : sense_(std::move(sense)), hold_(hold_time) {}

void PressRecogniser::expect(const TaxelsOfPress& asked, const std::optional<TaxelsOfPress>& last) {
  rest();
  hint_ = GuideHint::press;
  asked_ = asked;
  last_ = last;
}

void PressRecogniser::rest() {
  hold_.clear();
  hint_ = GuideHint::none;
  other_seconds_ = 0.0;
}

PressRecogniser::Event PressRecogniser::feed(const RawFrame& raw, std::span<const double> ratio, double seconds) {
  touch_ = sense_.feel(ratio, asked_.taxel);
  reading_ = sense_.relative(ratio, asked_.taxel);
  if (!touch_.strongest) sense_.follow(ratio, seconds);
  if (hint_ == GuideHint::release) {
    const bool is_off =
        is_released(ratio, asked_.taxel) && (!asked_.together_with || is_released(ratio, *asked_.together_with));
    return is_off ? Event::released : Event::none;
  }
  hold_.has_begun() ? follow_hold(raw, ratio) : wait_for_press(raw, ratio, seconds);
  return hold_.is_done() ? Event::held : Event::none;
}

/// Nothing is not.
bool PressRecogniser::is_foreign(std::optional<std::size_t> taxel) const {
  return taxel && !asked_.has(*taxel);
}

bool PressRecogniser::is_pressed_as_asked(std::span<const double> ratio) const {
  if (!asked_.together_with) return touch_.strongest == asked_.taxel && !touch_.beside;
  if (!touch_.strongest || is_foreign(touch_.strongest) || is_foreign(touch_.beside)) return false;
  const double least = kTogetherShare * sense_.excess(ratio, *touch_.strongest);
  const auto is_felt = [&](std::size_t taxel) {
    return sense_.excess(ratio, taxel) > std::max(least, sense_.threshold(taxel));
  };
  return is_felt(asked_.taxel) && is_felt(*asked_.together_with);
}

void PressRecogniser::wait_for_press(const RawFrame& raw, std::span<const double> ratio, double seconds) {
  if (is_pressed_as_asked(ratio)) {
    hold_.feed(raw, ratio, sense_.excess(ratio, asked_.taxel), sense_.noise(asked_.taxel));
    other_seconds_ = 0.0;
    hint_ = GuideHint::hold;
    return;
  }
  const bool waits_for_second = asked_.together_with && !is_foreign(touch_.strongest) && !is_foreign(touch_.beside);
  const bool is_touched = touch_.strongest && !waits_for_second && !is_memory(ratio);
  other_seconds_ = is_touched ? other_seconds_ + seconds : 0.0;
  if (other_seconds_ > kOtherTaxelSeconds) {
    hint_ = is_foreign(touch_.strongest) ? GuideHint::other_taxel : GuideHint::several;
  } else if (!is_touched && hint_ != GuideHint::too_short) {
    hint_ = GuideHint::press;
  }
}

void PressRecogniser::follow_hold(const RawFrame& raw, std::span<const double> ratio) {
  const double excess = sense_.excess(ratio, asked_.taxel);
  if (!is_pressed_as_asked(ratio) || excess < kLostShare * hold_.mean_excess()) {
    hold_.clear();
    hint_ = touch_.strongest ? GuideHint::hold : GuideHint::too_short;
    return;
  }
  hold_.feed(raw, ratio, excess, sense_.noise(asked_.taxel));
  hint_ = hold_.was_unsteady() ? GuideHint::unsteady : GuideHint::hold;
}

/// Whether the taxel no longer feels the last press, but for what the material remembers.
bool PressRecogniser::is_released(std::span<const double> ratio, std::size_t taxel) const {
  return sense_.excess(ratio, taxel) < std::max(kReleasedShare * kept_excess_, sense_.threshold(taxel));
}

/// What is felt most is what the material remembers of the last press.
bool PressRecogniser::is_memory(std::span<const double> ratio) const {
  return last_ && touch_.strongest && last_->has(*touch_.strongest) && is_released(ratio, *touch_.strongest);
}

std::vector<RawFrame> PressRecogniser::keep_hold(std::size_t count) {
  std::vector<RawFrame> frames = hold_.frames(count);
  kept_excess_ = hold_.mean_excess();
  hold_.clear();
  hint_ = GuideHint::release;
  return frames;
}

double PressRecogniser::share(Nanos now) const noexcept {
  return hint_ == GuideHint::release ? 1.0 : hold_.share(now);
}

std::optional<std::size_t> PressRecogniser::pressed_taxel() const noexcept {
  return hint_ == GuideHint::several ? touch_.beside : touch_.strongest;
}

}  // namespace dermis::calibration
