// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/pipeline/tare_judge.hpp"

#include <cmath>
#include <utility>

#include "dermis/touch/frames/number_text.hpp"

namespace dermis::touch::pipeline {
std::string describe(const Tare& tare, const ArrayDescription& array) {
  if (tare.state == Tare::State::refused) return describe(tare.load, array) + ": take it off and tare again";
  if (tare.state != Tare::State::taken || tare.load.newtons < kLeastStandingNewtons) return "";
  return "the tare takes " + significant_digits(tare.load.newtons, 2) + " N on " + place_name(tare.load, array) +
         " as zero";
}

TareJudge::TareJudge(const UnloadedLaw& unloaded) : unloaded_(unloaded) {
  const std::size_t taxels = unloaded_.offset_siemens.size();
  tare_.load.bears.resize(taxels);
  pressed_.siemens.resize(taxels);
  pressed_.sigma_siemens.resize(taxels);
  pressed_.taxels.resize(taxels, TaxelStatus::ok);
  pressed_.taxel_celsius.reserve(taxels);
}

void TareJudge::begin(TareOver over) noexcept {
  over_ = over;
  tare_.state = Tare::State::taking;
  ++tare_.number;
}

void TareJudge::undo(compensation::OffsetDrift& drift) noexcept {
  drift.undo_tare();
  tare_.state = Tare::State::none;
}

void TareJudge::end(compensation::OffsetDrift& drift, const ConductanceFrame& conductance, fusion::ForceFusion& fusion,
                    ForceFrame& scratch) noexcept {
  const compensation::TareStep& step = drift.tare_step();
  const TareOver over = std::exchange(over_, TareOver::drift);
  press(step, conductance);
  fusion.process(pressed_, scratch);
  tare_.state = Tare::State::taken;
  const bool is_under_load = take_load(scratch, step, true) >= kLeastStandingNewtons;
  if (!is_under_load) take_load(scratch, step, false);
  if (!is_under_load || over == TareOver::any_load) return;
  drift.undo_tare();
  tare_.state = Tare::State::refused;
}

void TareJudge::press(const compensation::TareStep& step, const ConductanceFrame& conductance) noexcept {
  pressed_.temperature_celsius = conductance.temperature_celsius;
  pressed_.taxel_celsius = conductance.taxel_celsius;
  for (std::size_t taxel = 0; taxel < pressed_.siemens.size(); ++taxel) {
    pressed_.siemens[taxel] =
        unloaded_.at(taxel, unloaded_.temperature.offset(conductance.celsius(taxel))) + step.siemens[taxel];
  }
}

double TareJudge::take_load(const ForceFrame& force, const compensation::TareStep& step, bool beyond_drift) noexcept {
  tare_.load.newtons = 0.0;
  for (std::size_t taxel = 0; taxel < force.newtons.size(); ++taxel) {
    const bool counts = beyond_drift ? step.is_beyond_drift[taxel] != 0 : step.siemens[taxel] > 0.0;
    const bool bears = counts && std::isfinite(force.newtons[taxel]);
    tare_.load.bears[taxel] = bears ? 1 : 0;
    if (bears) tare_.load.newtons += static_cast<double>(force.newtons[taxel]);
  }
  return tare_.load.newtons;
}

}  // namespace dermis::touch::pipeline
