// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/predicted_presses.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/cover.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/sheet/cover_fit.hpp"
#include "learn/calibration/sheet/cover_shares.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kPressesPerTask = 16;
constexpr int kMostIdleSteps = 25;      // of the inversion of the idle taxels
constexpr double kTrialSiemens = 1e-3;  // of a pressed taxel
constexpr double kMostSiemens = 1.0;
constexpr double kLeastCorner = 1e-3;  // share across a corner that a cover is taken from

/// The mean of their readings.
std::vector<double> mean_ratio(std::span<const LabelledFrame> frames) {
  std::vector<double> mean(frames.front().frame->ratio.size());
  for (const LabelledFrame& one : frames) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += one.frame->ratio[k] / static_cast<double>(frames.size());
  }
  return mean;
}

/// The conductances that readings tell, each taxel on its own, beside those that the model was solved with.
std::vector<double> told(const touch::compensation::CircuitModel& model, const std::vector<double>& ratio,
                         const std::vector<double>& slopes, std::vector<double> siemens) {
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    const double change = (ratio[k] - model.ratio()[k]) / slopes[k];
    if (std::isfinite(change)) siemens[k] += change;
  }
  return siemens;
}

/// The conductance x of a taxel by its reading, all others as in `siemens`. Any reading is (a + b x) / (1 + c x).
double pressed_siemens(touch::compensation::CircuitModel& model, std::size_t taxel, double ratio,
                       std::vector<double> siemens, std::vector<double>& slopes) {
  siemens[taxel] = 0.0;
  model.solve(siemens);
  const double least = model.ratio()[taxel];
  siemens[taxel] = kTrialSiemens;
  model.solve(siemens);
  model.own_derivatives(slopes);
  const double trial = model.ratio()[taxel];
  const double factor = (trial - least) / (slopes[taxel] * kTrialSiemens);  // 1 + c x
  const double missing = trial * factor - least - ratio * (factor - 1.0);   // (b - c ratio) x
  const double found = kTrialSiemens * (ratio - least) / missing;
  if (!(ratio > least)) return 0.0;
  return missing > 0.0 ? std::min(found, kMostSiemens) : kMostSiemens;
}

}  // namespace

std::optional<PredictedPresses> PredictedPresses::create(const ArrayDescription& array, const LabelledPresses& presses,
                                                         const TaxelCurves& curves) {
  PredictedPresses predicted(array, presses, curves);
  if (predicted.idle_frames_.empty() || predicted.presses_.empty()) return std::nullopt;
  predicted.array_.readout.film = Film{1e6, 1e6};  // whatever it is: each press has its own
  for (std::size_t first = 0; first < predicted.presses_.size(); first += kPressesPerTask) {
    auto model = touch::compensation::CircuitModel::create(predicted.array_);
    if (!model) return std::nullopt;
    predicted.models_.push_back(*std::move(model));
  }
  return predicted;
}

PredictedPresses::PredictedPresses(const ArrayDescription& array, const LabelledPresses& presses,
                                   const TaxelCurves& curves)
    : array_(array), frames_(presses.frames()), near_film_(curves), curves_(curves) {
  for (const LabelledFrame& one : presses.labelled()) {
    if (one.newtons > 0.0) {
      presses_.push_back(one);
    } else {
      idle_frames_.push_back(one);
    }
  }
}

SinglePresses PredictedPresses::under(const Film& film, const std::optional<Cover>& start) {
  array_.readout.film = film;
  cover_ = array_.cover ? array_.cover : start;
  curves_ = near_film_;
  find_idle();
  SinglePresses single = predict();
  curves_ = TaxelCurves(single, near_film_);
  if (!array_.cover) follow_cover(single);
  return cover_ ? predict() : single;
}

/// Idle taxels that the circuit cannot give are its best attempt.
void PredictedPresses::find_idle() {
  touch::compensation::InversionOptions options;
  options.samples_noise = true;
  options.most_steps = kMostIdleSteps;
  const auto inversion = touch::compensation::make_crosstalk_inversion(array_, options);
  idle_.assign(array_.taxel_count(), 0.0);
  idle_presses_.clear();
  if (!inversion) return;
  FilmConductances film(array_.rows, array_.cols);
  film.set(*array_.readout.film, idle_);
  (*inversion)->hold_film(film);
  static_cast<void>((*inversion)->invert(mean_ratio(idle_frames_), idle_));
  touch::compensation::CircuitModel& model = models_.front();
  model.set_film(film);
  model.solve(idle_);
  std::vector<double> slopes(idle_.size());
  model.own_derivatives(slopes);
  for (const LabelledFrame& one : idle_frames_) {
    idle_presses_.push_back({0, 0.0, one.frame->temperature, told(model, one.frame->ratio, slopes, idle_),
                             std::vector<bool>(idle_.size())});
  }
}

SinglePresses PredictedPresses::predict() {
  SinglePresses single;
  single.presses.resize(presses_.size());
  parallel_for(models_.size(), [&](std::size_t task) {
    const std::size_t end = std::min(presses_.size(), (task + 1) * kPressesPerTask);
    for (std::size_t k = task * kPressesPerTask; k < end; ++k) {
      const auto& [frame, taxel, newtons] = presses_[k];
      single.presses[k] = {taxel, newtons, frame->temperature, predict(models_[task], presses_[k]),
                           std::vector<bool>(idle_.size())};
    }
  });
  take_out_unloaded(array_, idle_presses_, single);
  return single;
}

std::vector<double> PredictedPresses::predict(touch::compensation::CircuitModel& model,
                                              const LabelledFrame& press) const {
  const auto& [frame, taxel, newtons] = press;
  ArrayDescription covered = array_;
  covered.cover = cover_;
  const CoverKernel kernel(covered);
  std::vector<double> surface(idle_.size());
  std::vector<double> felt(idle_.size());
  surface[taxel] = newtons;
  kernel.spread<double>(surface, felt);
  FilmConductances film(array_.rows, array_.cols);
  film.set(*array_.readout.film, felt);
  model.set_film(film);
  std::vector<double> siemens = idle_;
  for (std::size_t k = 0; cover_ && curves_.any() && k < siemens.size(); ++k) {
    if (k != taxel && !array_.is_absent(k)) siemens[k] += curves_.siemens(k, felt[k] / kernel.share(0, 0));
  }
  std::vector<double> slopes(idle_.size());
  siemens[taxel] = pressed_siemens(model, taxel, frame->ratio[taxel], siemens, slopes);
  model.solve(siemens);
  model.own_derivatives(slopes);
  return told(model, frame->ratio, slopes, std::move(siemens));
}

void PredictedPresses::follow_cover(const SinglePresses& single) {
  cover_.reset();
  if (!curves_.any()) return;
  const double corner = CoverShares(array_, single, curves_).at(1, 1).share;
  if (corner > kLeastCorner && corner < 1.0) cover_ = Cover{spread_by_corner(corner, array_), {}};
}

}  // namespace dermis::learn::calibration
