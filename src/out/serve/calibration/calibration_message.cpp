// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/calibration/calibration_message.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace dermis::out::serve {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

bytes::ros_messages::CalibrationState::Stage stage_of(learn::calibration::GuideStage stage) {
  using learn::calibration::GuideStage;
  using Stage = bytes::ros_messages::CalibrationState::Stage;
  switch (stage) {
    case GuideStage::none: return Stage::none;
    case GuideStage::unloaded: return Stage::unloaded;
    case GuideStage::pressing: return Stage::pressing;
    case GuideStage::fitting: return Stage::fitting;
    case GuideStage::done: return Stage::done;
    case GuideStage::failed: return Stage::failed;
  }
  return Stage::none;
}

bytes::ros_messages::CalibrationState::Hint hint_of(learn::calibration::GuideHint hint) {
  using learn::calibration::GuideHint;
  using Hint = bytes::ros_messages::CalibrationState::Hint;
  switch (hint) {
    case GuideHint::none: return Hint::none;
    case GuideHint::press: return Hint::press;
    case GuideHint::hold: return Hint::hold;
    case GuideHint::release: return Hint::release;
    case GuideHint::other_taxel: return Hint::other_taxel;
    case GuideHint::unsteady: return Hint::unsteady;
    case GuideHint::too_short: return Hint::too_short;
    case GuideHint::several: return Hint::several;
    case GuideHint::one_of_two: return Hint::one_of_two;
  }
  return Hint::none;
}

std::optional<std::uint32_t> taxel_of(std::optional<std::size_t> taxel) {
  return taxel ? std::optional(static_cast<std::uint32_t>(*taxel)) : std::nullopt;
}

}  // namespace

bytes::ros_messages::CalibrationState calibration_message(CalibrationProgress progress) {
  bytes::ros_messages::CalibrationState state;
  learn::calibration::GuideState& guide = progress.state;
  state.array = std::move(progress.array);
  state.stage = stage_of(guide.stage);
  state.message = std::move(guide.message);
  state.taxel = static_cast<std::uint32_t>(guide.taxel);
  state.weight_n = guide.weight_n;
  state.reading = guide.reading;
  state.hold_share = guide.hold_share;
  state.presses_done = static_cast<std::uint32_t>(guide.presses_done);
  state.presses_total = static_cast<std::uint32_t>(guide.presses_total);
  state.median_relative_error = guide.median_relative_error.value_or(kUnknown);
  state.taxel_presses = std::move(guide.taxel_presses);
  state.hint = hint_of(guide.hint);
  state.pressed_taxel = taxel_of(guide.pressed_taxel);
  state.unpressed_relative_error = guide.unpressed_relative_error.value_or(kUnknown);
  state.together_with = taxel_of(guide.together_with);
  state.together_reading = guide.together_reading.value_or(kUnknown);
  state.missing_taxel = taxel_of(guide.missing_taxel);
  return state;
}

}  // namespace dermis::out::serve
