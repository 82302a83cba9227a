// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/recalibration.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "calibration/labels/label_check.hpp"
#include "calibration/labels/labels.hpp"
#include "calibration/labels/reading_check.hpp"
#include "calibration/recalibration/known_presses.hpp"
#include "dermis/pipeline/pipeline.hpp"

namespace dermis::calibration {
namespace {

Result<KnownPresses> gather(const pipeline::Model& model, std::span<const RawFrame> frames,
                            std::span<const Load> loads) {
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  pipeline->drift().set_options({.track = true});
  const LoadsOfFrames of_frames(loads, frames.size());
  KnownPresses presses(model.array);
  ForceFrame force;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    pipeline->process(frames[frame], force);
    presses.add(force, of_frames[frame]);
  }
  presses.finish();
  return presses;
}

/// Tables take no gain: they are scaled themselves.
void scale(const std::vector<double>& log_factors, fusion::ForceNetworks& networks) {
  std::vector<float> factors;
  for (const double log_factor : log_factors) factors.push_back(static_cast<float>(std::exp(log_factor)));
  for (std::size_t taxel = 0; taxel < factors.size(); ++taxel) {
    networks.gain[taxel] *= factors[taxel];
    networks.heaviest_newtons[taxel] *= factors[taxel];
  }
  fusion::ForceTables& tables = networks.tables;
  for (std::size_t k = 0; k < tables.newtons.size(); ++k) {
    tables.newtons[k] *= factors[tables.taxels[k / tables.knots]];
  }
}

}  // namespace

Result<Recalibration> recalibrate(const pipeline::Model& model, std::span<const RawFrame> frames,
                                  std::span<const Load> loads) {
  if (Status checked = check_loads(model.array, frames.size(), loads); !checked) return checked.error();
  if (Status checked = check_readings(model.array, frames, loads); !checked) return checked.error();
  if (const auto turn = check_labels(model.array, frames, loads, {}).turn) return bad_input(*turn);
  const Result<KnownPresses> gathered = gather(model, frames, loads);
  if (!gathered) return gathered.error();
  const std::vector<KnownPress>& presses = gathered->presses();
  if (presses.empty()) return bad_input("no load above zero has a force: a known weight is needed");
  if (presses.size() > kMostPresses) {
    return bad_input(
        fmt::format("{} presses are enough for a calibration, which learns more from them", presses.size()));
  }
  Recalibration recalibration;
  recalibration.model = model;
  recalibration.change = change_of(presses, model.networks.taxel_count());
  recalibration.presses = presses.size();
  recalibration.left_out = gathered->left_out();
  recalibration.taxels = pressed_taxels(presses);
  scale(recalibration.change.taxels, recalibration.model.networks);
  recalibration.model.provenance["recalibration"] = describe(recalibration);
  return recalibration;
}

std::string describe(const Recalibration& recalibration) {
  const GainChange& change = recalibration.change;
  const double read = std::expm1(-change.sheet);  // of the force, too much
  std::string text = fmt::format(
      "the sheet read {:.1f} % {} (\u00b1 {:.1f} %): from {}", 100.0 * std::abs(read),
      read > 0.0 ? "too much" : "too little", 100.0 * change.sheet_sigma,
      recalibration.presses == 1 ? "one press"
                                 : fmt::format("{} presses on {} taxels", recalibration.presses, recalibration.taxels));
  if (change.spread > 0.0) text += fmt::format("; its taxels differed by {:.0f} %", 100.0 * change.spread);
  if (recalibration.left_out > 0) text += fmt::format("; {} presses without a force left out", recalibration.left_out);
  return text;
}

}  // namespace dermis::calibration
