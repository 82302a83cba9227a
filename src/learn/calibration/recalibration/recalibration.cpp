// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/recalibration.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/labels/label_check.hpp"
#include "learn/calibration/labels/labels.hpp"
#include "learn/calibration/labels/reading_check.hpp"
#include "learn/calibration/recalibration/known_presses.hpp"
#include "learn/calibration/recalibration/unloaded_change.hpp"
#include "learn/calibration/sheet/felt_loads.hpp"

namespace dermis::learn::calibration {
namespace {

struct Gathered {
  KnownPresses presses;
  double unloaded = 0.0;  ///< UnloadedChange::change()
};

/// Presses are as sure as calibration made them: what an earlier recalibration left is looked for anew.
Result<Gathered> gather(touch::pipeline::Model model, std::span<const RawFrame> frames, std::span<const Load> loads,
                        const ArrayDescription& array) {
  model.networks.gain_errors = {};
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  pipeline->drift().set_options({.track = true});
  const LoadsOfFrames of_frames(loads, frames.size());
  KnownPresses presses(array);
  UnloadedChange unloaded(model.networks.unloaded);
  ForceFrame force;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    pipeline->process(frames[frame], force);
    presses.add(force, of_frames[frame]);
    const auto is_pressed = [](const Load& load) { return load.value > 0.0; };
    if (std::ranges::none_of(of_frames[frame], is_pressed)) unloaded.add(*pipeline);
  }
  presses.finish();
  return Gathered{std::move(presses), unloaded.change()};
}

/// Tables take no gain: they are scaled themselves.
void scale(const std::vector<double>& log_factors, touch::fusion::ForceNetworks& networks) {
  std::vector<float> factors;
  for (const double log_factor : log_factors) factors.push_back(static_cast<float>(std::exp(log_factor)));
  for (std::size_t taxel = 0; taxel < factors.size(); ++taxel) {
    networks.gain[taxel] *= factors[taxel];
    networks.heaviest_newtons[taxel] *= factors[taxel];
  }
  touch::fusion::ForceTables& tables = networks.tables;
  for (std::size_t k = 0; k < tables.newtons.size(); ++k) {
    tables.newtons[k] *= factors[tables.taxels[k / tables.knots]];
  }
}

void scale(double unloaded_change, UnloadedLaw& unloaded) {
  for (double& siemens : unloaded.offset_siemens) siemens *= 1.0 + unloaded_change;
  for (double& per_celsius : unloaded.per_celsius) per_celsius *= 1.0 + unloaded_change;
}

/// Too few presses tell nothing of taxels that differ: then they differ as before.
GainErrors joined(const GainErrors& before, GainChange change) {
  if (change.spread > 0.0 || before.sigma.empty()) return change.left;
  GainErrors joined = before;
  for (std::size_t taxel = 0; taxel < joined.sigma.size(); ++taxel) {
    joined.sigma[taxel] = std::hypot(joined.sigma[taxel], change.left.sigma[taxel]);
  }
  return joined;
}

std::string spread_text(const GainChange& change) {
  const char* who = "taxels";
  if (change.row_share > 0.0 || change.column_share > 0.0) {
    who = change.column_share == 0.0 ? "rows" : (change.row_share == 0.0 ? "columns" : "rows and columns");
  }
  std::vector<float> sigma = change.left.sigma;
  return fmt::format("; its {} differed by {:.0f} %: forces are \u00b1 {:.1f} % for that", who, 100.0 * change.spread,
                     100.0 * static_cast<double>(upper_median(std::move(sigma))));
}

}  // namespace

Result<Recalibration> recalibrate(const touch::pipeline::Model& model, std::span<const RawFrame> frames,
                                  std::span<const Load> loads) {
  if (Status checked = check_loads(model.array, frames.size(), loads); !checked) return checked.error();
  if (Status checked = check_readings(model.array, frames, loads); !checked) return checked.error();
  if (const auto turn = check_labels(model.array, frames, loads, {}).turn) return bad_input(*turn);
  const Result<Gathered> gathered = gather(model, frames, felt_totals(model.array, loads), model.array);
  if (!gathered) return gathered.error();
  const std::vector<KnownPress>& presses = gathered->presses.presses();
  if (presses.empty()) return bad_input("no load above zero has a force: a known weight is needed");
  if (presses.size() > kMostPresses) {
    return bad_input(
        fmt::format("{} presses are enough for a calibration, which learns more from them", presses.size()));
  }
  Recalibration recalibration;
  recalibration.model = model;
  recalibration.change = change_of(presses, {model.array.rows, model.array.cols});
  recalibration.presses = presses.size();
  recalibration.left_out = gathered->presses.left_out();
  recalibration.taxels = pressed_taxels(presses);
  scale(recalibration.change.taxels, recalibration.model.networks);
  recalibration.unloaded = gathered->unloaded;
  scale(recalibration.unloaded, recalibration.model.networks.unloaded);
  recalibration.model.networks.gain_errors = joined(model.networks.gain_errors, recalibration.change);
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
  if (change.spread > 0.0) text += spread_text(change);
  if (recalibration.unloaded != 0.0) {
    text += fmt::format("; unloaded it conducts {:+.0f} %, which is its zero now", 100.0 * recalibration.unloaded);
  }
  if (recalibration.left_out > 0) text += fmt::format("; {} presses without a force left out", recalibration.left_out);
  return text;
}

}  // namespace dermis::learn::calibration
