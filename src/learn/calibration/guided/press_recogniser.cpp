// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/press_recogniser.hpp"

#include <algorithm>
#include <utility>

namespace dermis::learn::calibration {
namespace {

constexpr double kReleasedShare = 0.15;  // of the excess of the press
constexpr double kLostShare = 0.5;
constexpr double kPressedShare = 0.5;        // of the excess of the taxel that feels most; crosstalk stays below
constexpr double kTogetherShare = 0.25;      // the same of two with the same weight
constexpr double kWrongTouchSeconds = 0.15;  // while a weight is put on

}  // namespace

PressRecogniser::PressRecogniser(TouchSense sense, Nanos hold_time) : sense_(std::move(sense)), hold_(hold_time) {}

void PressRecogniser::expect(std::vector<std::size_t> taxels) {
  rest();
  hint_ = GuideHint::press;
  asked_ = std::move(taxels);
  readings_.clear();
  relative_.assign(asked_.size(), 1.0);
  for (const std::size_t taxel : asked_) readings_.push_back({0.0, sense_.noise(taxel)});
}

void PressRecogniser::rest() {
  hold_.clear();
  hint_ = GuideHint::none;
  touch_ = {};
  wrong_seconds_ = 0.0;
}

PressRecogniser::Event PressRecogniser::feed(const RawFrame& raw, std::span<const double> ratio, double seconds) {
  sense_.fade(ratio);
  touch_ = feel(ratio);
  for (std::size_t k = 0; k < asked_.size(); ++k) {
    readings_[k].excess = sense_.excess(ratio, asked_[k]);
    relative_[k] = sense_.relative(ratio, asked_[k]);
  }
  if (!touch_.strongest) sense_.follow(ratio, seconds);
  if (hint_ == GuideHint::release) return wait_for_release(ratio);
  hold_.has_begun() ? follow_hold(raw, ratio) : wait_for_press(raw, ratio, seconds);
  return hold_.is_done() ? Event::held : Event::none;
}

PressRecogniser::Touch PressRecogniser::feel(std::span<const double> ratio) const {
  Touch touch;
  touch.strongest = sense_.strongest(ratio, [](std::size_t) { return true; });
  if (!touch.strongest) return touch;
  const double most = sense_.excess(ratio, *touch.strongest);
  const double share = asked_.size() > 1 ? kTogetherShare : kPressedShare;
  for (const std::size_t taxel : asked_) {
    const bool is_pressed = sense_.excess(ratio, taxel) > std::max(share * most, sense_.threshold(taxel));
    is_pressed ? void(++touch.pressed) : void(touch.missing = taxel);
  }
  touch.foreign = sense_.strongest(ratio, [&](std::size_t taxel) { return !is_asked(taxel); });
  if (touch.foreign && sense_.excess(ratio, *touch.foreign) <= kPressedShare * most) touch.foreign.reset();
  return touch;
}

bool PressRecogniser::is_asked(std::size_t taxel) const {
  return std::find(asked_.begin(), asked_.end(), taxel) != asked_.end();
}

bool PressRecogniser::is_as_asked() const {
  return touch_.pressed == asked_.size() && !touch_.foreign;
}

/// The mistake where something else is pressed than was asked for.
GuideHint PressRecogniser::mistake() const {
  if (!touch_.foreign) return GuideHint::one_of_two;
  return touch_.missing ? GuideHint::other_taxel : GuideHint::several;
}

void PressRecogniser::wait_for_press(const RawFrame& raw, std::span<const double> ratio, double seconds) {
  if (is_as_asked()) {
    hold_.feed(raw, ratio, readings_);
    wrong_seconds_ = 0.0;
    hint_ = GuideHint::hold;
    return;
  }
  wrong_seconds_ = touch_.strongest ? wrong_seconds_ + seconds : 0.0;
  if (wrong_seconds_ > kWrongTouchSeconds) {
    hint_ = mistake();
  } else if (!touch_.strongest && hint_ != GuideHint::too_short) {
    hint_ = GuideHint::press;
  }
}

void PressRecogniser::follow_hold(const RawFrame& raw, std::span<const double> ratio) {
  bool is_any_lost = false;
  for (std::size_t k = 0; k < asked_.size(); ++k) {
    if (!is_lost(k)) continue;
    is_any_lost = true;
    sense_.leave(ratio, asked_[k]);
  }
  if (is_any_lost || !is_as_asked()) {
    hold_.clear();
    hint_ = is_any_lost ? GuideHint::too_short : GuideHint::hold;
    return;
  }
  hold_.feed(raw, ratio, readings_);
  hint_ = hold_.was_unsteady() ? GuideHint::unsteady : GuideHint::hold;
}

bool PressRecogniser::is_lost(std::size_t asked) const {
  return readings_[asked].excess < kLostShare * hold_.mean_excess(asked);
}

PressRecogniser::Event PressRecogniser::wait_for_release(std::span<const double> ratio) {
  if (!is_released()) return Event::none;
  for (const std::size_t taxel : asked_) sense_.leave(ratio, taxel);
  return Event::released;
}

bool PressRecogniser::is_released() const {
  for (std::size_t k = 0; k < asked_.size(); ++k) {
    if (readings_[k].excess >= std::max(kReleasedShare * kept_excess_[k], sense_.threshold(asked_[k]))) return false;
  }
  return true;
}

std::vector<RawFrame> PressRecogniser::keep_hold(std::size_t count) {
  std::vector<RawFrame> frames = hold_.frames(count);
  kept_excess_.clear();
  for (std::size_t k = 0; k < asked_.size(); ++k) kept_excess_.push_back(hold_.mean_excess(k));
  hold_.clear();
  hint_ = GuideHint::release;
  return frames;
}

double PressRecogniser::reading(std::size_t asked) const {
  return relative_[asked];
}

double PressRecogniser::share(Nanos now) const noexcept {
  return hint_ == GuideHint::release ? 1.0 : hold_.share(now);
}

std::optional<std::size_t> PressRecogniser::pressed_taxel() const {
  return touch_.foreign ? touch_.foreign : touch_.strongest;
}

std::optional<std::size_t> PressRecogniser::missing_taxel() const {
  return touch_.pressed > 0 ? touch_.missing : std::nullopt;
}

}  // namespace dermis::learn::calibration
