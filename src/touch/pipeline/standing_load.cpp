// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/standing_load.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dermis/touch/compensation/offset_drift.hpp"
#include "dermis/touch/frames/number_text.hpp"

namespace dermis::touch::pipeline {
namespace {

constexpr std::chrono::seconds kLongEnough{5};
constexpr double kTouchedSigmas = 5.0;

struct TaxelBox {
  std::size_t first_row, last_row, first_col, last_col;
  [[nodiscard]] std::size_t area() const { return (last_row - first_row + 1) * (last_col - first_col + 1); }
};

TaxelBox box_of(const std::vector<std::uint8_t>& taxels, const ArrayDescription& array) {
  TaxelBox box{array.rows, 0, array.cols, 0};
  for (std::size_t taxel = 0; taxel < taxels.size(); ++taxel) {
    if (taxels[taxel] == 0) continue;
    box.first_row = std::min(box.first_row, taxel / array.cols);
    box.last_row = std::max(box.last_row, taxel / array.cols);
    box.first_col = std::min(box.first_col, taxel % array.cols);
    box.last_col = std::max(box.last_col, taxel % array.cols);
  }
  return box;
}

std::size_t taxels_of(const StandingLoad& load) {
  return static_cast<std::size_t>(std::count(load.bears.begin(), load.bears.end(), std::uint8_t{1}));
}

/// "reads 1.2 N".
std::string reads(const StandingLoad& load) {
  return (taxels_of(load) == 1 ? "reads " : "read ") + significant_digits(load.newtons, 2) + " N";
}

}  // namespace

std::string place_name(const StandingLoad& load, const ArrayDescription& array) {
  const std::size_t taxels = taxels_of(load);
  if (taxels == 0) return "no taxel";
  const TaxelBox box = box_of(load.bears, array);
  std::string first = taxel_name(box.first_row, box.first_col);
  if (taxels == 1) return first;
  const std::string last = taxel_name(box.last_row, box.last_col);
  if (taxels == box.area()) return first + " to " + last;
  return std::to_string(taxels) + " taxels between " + first + " and " + last;
}

std::string describe(const StandingLoad& load, const ArrayDescription& array) {
  return place_name(load, array) + " " + reads(load);
}

std::string describe_never_released(const StandingLoad& load, const ArrayDescription& array) {
  return place_name(load, array) + (taxels_of(load) == 1 ? " was" : " were") + " never released and " + reads(load) +
         ": take off what lies there, or tare if the array was put on";
}

StandingLoadWatch::StandingLoadWatch(const Model& model)
    : unloaded_(model.networks.unloaded), bears_(model.array.taxel_count(), 1), newtons_(model.array.taxel_count()) {}

void StandingLoadWatch::add(const ConductanceFrame& conductance, const ForceFrame& force) {
  if (has(conductance.status, FrameStatus::rejected | FrameStatus::not_converged)) return;
  if (frames_++ == 0) first_ = force.time;
  last_ = force.time;
  for (std::size_t taxel = 0; taxel < bears_.size(); ++taxel) {
    const double at_rest = std::max(unloaded_.at(taxel, unloaded_.temperature.offset(conductance.celsius(taxel))), 0.0);
    const double most =
        (1.0 + compensation::kMostDriftOfUnloaded) * at_rest + kTouchedSigmas * conductance.sigma_siemens[taxel];
    const bool is_loaded = conductance.siemens[taxel] > most && std::isfinite(force.newtons[taxel]);
    if (!is_loaded) bears_[taxel] = 0;
    if (is_loaded) newtons_[taxel] += static_cast<double>(force.newtons[taxel]);
  }
}

bool StandingLoadWatch::is_any_loaded() const noexcept {
  return std::find(bears_.begin(), bears_.end(), std::uint8_t{1}) != bears_.end();
}

void StandingLoadWatch::begin_anew() {
  frames_ = 0;
  std::fill(bears_.begin(), bears_.end(), std::uint8_t{1});
  std::fill(newtons_.begin(), newtons_.end(), 0.0);
}

std::optional<StandingLoad> StandingLoadWatch::load() const {
  if (frames_ == 0 || last_ - first_ < kLongEnough) return std::nullopt;
  double newtons = 0.0;
  for (std::size_t taxel = 0; taxel < bears_.size(); ++taxel) {
    if (bears_[taxel] != 0) newtons += newtons_[taxel] / static_cast<double>(frames_);
  }
  if (newtons < kLeastStandingNewtons) return std::nullopt;
  return StandingLoad{newtons, bears_};
}

}  // namespace dermis::touch::pipeline
