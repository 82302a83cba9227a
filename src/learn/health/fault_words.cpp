// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/fault_words.hpp"

#include <fmt/core.h>

namespace dermis::learn::health {
namespace {

using touch::compensation::LineFault;
using touch::compensation::LineFaultEffect;

/// The fault, and the parts to look at.
std::pair<std::string, std::string> diagnosis(const LineFault& fault, const ArrayDescription& array) {
  const std::string place = place_name(fault, array);
  switch (traits_of(fault.kind).effect) {
    case LineFaultEffect::silent:
      if (fault.grounded) return {"is shorted to 0 V", "look for a bridge between " + place + " and ground"};
      return {fault.ground_evidence < 0.0 ? "is open" : "is open or shorted to 0 V",
              "check the wire or crimp of " + place};
    case LineFaultEffect::supplied:
      return {"is shorted to the supply", "look for a bridge between " + place + " and the supply"};
    case LineFaultEffect::shorted: return {"are shorted together", "look for a bridge between " + place};
    case LineFaultEffect::stuck:
      return {"is stuck: its reading does not change", "check the electronics that read " + place};
    case LineFaultEffect::crossed:
      return {fmt::format("is shorted: row {} and column {} touch", fault.place / array.cols, fault.place % array.cols),
              "look for a bridge between the two"};
    case LineFaultEffect::impossible:
      return {"reads more than the circuit can give", "check the electronics that read " + place};
    case LineFaultEffect::dead:
      return {"is dead: it reads less than an unloaded taxel", "check the contact of " + place + " with its lines"};
    case LineFaultEffect::drifting: break;
  }
  return {
      fmt::format("has risen from {:.0f} to about {:.0f} ohm", array.readout.drive_ohm[fault.place], fault.drive_ohm),
      "check the contact between the " + place + " and its line for corrosion"};
}

std::string dead_taxels(const touch::pipeline::Model& model) {
  std::string names;
  for (std::size_t taxel = 0; taxel < model.networks.taxel_count(); ++taxel) {
    if (model.networks.dead[taxel] != 0) names += (names.empty() ? "" : " ") + model.array.taxel_name(taxel);
  }
  return names;
}

}  // namespace

std::string describe(const FaultHistory& history, const ArrayDescription& array) {
  const LineFault& fault = history.fault;
  const auto [what, mend] = diagnosis(fault, array);
  const std::size_t masked = masked_taxel_count(fault, array);
  std::string text = what;
  if (history.times > 1) text += fmt::format(" {} times", history.times);
  text += history.until ? fmt::format(" from frame {} to {}: {}", fault.frame, *history.until - 1, mend)
                        : fmt::format(" since frame {}: {}", fault.frame, mend);
  if (history.until || history.times > 1) return text + "; it comes and goes, as a loose contact does";
  if (masked == 0) return text + ", or calibrate again; until then heavy loads on the line read too little";
  return text + fmt::format("; {} masked, the rest is still good",
                            masked == 1 ? "the taxel is" : fmt::format("its {} taxels are", masked));
}

Condition condition_of(const touch::pipeline::Model& model, std::span<const LineFault> faults,
                       const AgeingEvidence& ageing) {
  Condition condition;
  for (const LineFault& fault : faults) {
    condition.details.emplace_back(place_name(fault, model.array), describe(FaultHistory{fault}, model.array));
  }
  const std::string dead = dead_taxels(model);
  if (!dead.empty()) condition.details.emplace_back("dead since calibration", dead);
  if (ageing.gain_spread) condition.details.emplace_back("gains", describe(ageing));
  condition.message = dead.empty() ? "healthy" : "dead taxels";
  if (ageing.has_aged()) {
    condition.message = fmt::format("recalibrate: gains have changed by about {:.0f} %", 100.0 * *ageing.gain_spread);
  }
  if (!faults.empty()) condition.message = fmt::format("{} fault{}", faults.size(), faults.size() == 1 ? "" : "s");
  return condition;
}

}  // namespace dermis::learn::health
