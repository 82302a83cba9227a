// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/single_presses.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "dermis/touch/frames/cover.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/inverted_frame.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kMostWork = 2e6;      // frames x taxels
constexpr double kMostSlowWork = 2e5;  // the same of floating lines
constexpr std::size_t kMostIdle = 60;  // frames
constexpr std::size_t kLeastBase = 8;  // frames, for the unloaded conductance of a taxel beside presses
constexpr std::size_t kFar = 4;        // lines from a press
constexpr double kSigmasOfDeviation = 1.4826;

/// The only taxel that a label names; empty: none or several.
std::optional<std::size_t> only_taxel(std::span<const Load> loads, std::size_t cols) {
  std::optional<std::size_t> taxel;
  for (const Load& load : loads) {
    if (!(load.value > 0.0)) continue;
    if (taxel || load.where.taxel_count() != 1) return std::nullopt;
    taxel = load.where.first_row * cols + load.where.first_col;
  }
  return taxel;
}

bool is_far(const ArrayDescription& array, std::size_t a, std::size_t b) {
  const auto apart = [](std::size_t x, std::size_t y) { return x > y ? x - y : y - x; };
  const std::size_t rows = apart(a / array.cols, b / array.cols);
  const std::size_t cols = apart(a % array.cols, b % array.cols);
  return rows > 0 && cols > 0 && (rows >= kFar || cols >= kFar);
}

/// A taxel in a frame.
struct Unpressed {
  double temperature = 0.0;
  double siemens = 0.0;
};

/// A parabola of temperature, or a median where there is none.
class UnloadedCurve {
 public:
  explicit UnloadedCurve(const std::vector<Unpressed>& points) {
    const bool varies = std::any_of(points.begin(), points.end(), [&](const Unpressed& point) {
      return point.temperature != points.front().temperature;
    });
    std::vector<double> values;
    for (const Unpressed& point : points) values.push_back(point.siemens);
    curve_[0] = quantile(std::move(values), 0.5);
    if (!varies || points.size() < kLeastBase) return;
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const auto& [t, siemens] : points) {
      const Eigen::Vector3d basis(1.0, t, t * t);
      matrix += basis * basis.transpose();
      right += siemens * basis;
    }
    curve_ = matrix.ldlt().solve(right);
  }

  [[nodiscard]] double at(double t) const { return curve_[0] + t * (curve_[1] + t * curve_[2]); }

 private:
  Eigen::Vector3d curve_ = Eigen::Vector3d::Zero();
};

}  // namespace

void take_out_unloaded(const ArrayDescription& array, const std::vector<SinglePress>& idle, SinglePresses& single) {
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    std::vector<Unpressed> points;
    for (const SinglePress& press : single.presses) {
      if (is_far(array, taxel, press.taxel)) points.push_back({press.temperature, press.rise[taxel]});
    }
    for (const SinglePress& frame : idle) points.push_back({frame.temperature, frame.rise[taxel]});
    const UnloadedCurve curve(points);
    std::vector<double> deviations;
    for (const auto& [temperature, siemens] : points) deviations.push_back(std::abs(siemens - curve.at(temperature)));
    single.sigma.push_back(kSigmasOfDeviation * quantile(std::move(deviations), 0.5));
    for (SinglePress& press : single.presses) press.rise[taxel] -= curve.at(press.temperature);
  }
}

std::vector<LabelledFrame> LabelledPresses::labelled_frames(const ArrayDescription& array, const CircuitFrames& frames,
                                                            const LoadsOfFrames& loads_of) {
  std::vector<LabelledFrame> labelled;
  std::size_t idle = 0;
  for (const CircuitFrame& frame : frames.frames) {
    const std::span<const Load> loads = loads_of[frame.first_frame];
    const bool is_idle = std::all_of(loads.begin(), loads.end(), [](const Load& load) { return load.value == 0.0; });
    if (is_idle && idle++ < kMostIdle) labelled.push_back({&frame, 0, 0.0});
    const std::optional<std::size_t> taxel = only_taxel(loads, array.cols);
    if (!taxel) continue;
    const auto newtons = static_cast<double>(frame.newtons[*taxel]);  // not a number: saturated
    if (newtons > 0.0) labelled.push_back({&frame, *taxel, newtons});
  }
  return labelled;
}

/// At most so many, the lighter presses of each taxel left out first.
void LabelledPresses::thin_out(std::vector<LabelledFrame>& labelled, std::size_t most) {
  const auto is_before = [](const LabelledFrame& a, const LabelledFrame& b) {
    return a.taxel != b.taxel ? a.taxel < b.taxel : a.newtons > b.newtons;
  };
  std::stable_sort(labelled.begin(), labelled.end(), is_before);
  if (labelled.size() <= most) return;
  std::vector<std::size_t> place_in_taxel;
  for (std::size_t k = 0; k < labelled.size(); ++k) {
    const bool goes_on = k > 0 && labelled[k].taxel == labelled[k - 1].taxel;
    place_in_taxel.push_back(labelled[k].newtons == 0.0 ? 0 : goes_on ? place_in_taxel.back() + 1 : 0);
  }
  const std::size_t last = ranked(place_in_taxel, most);
  std::vector<LabelledFrame> kept;
  for (std::size_t k = 0; k < labelled.size(); ++k) {
    if (place_in_taxel[k] <= last) kept.push_back(labelled[k]);
  }
  labelled = std::move(kept);
}

std::optional<LabelledPresses> LabelledPresses::create(const ArrayDescription& array, std::span<const RawFrame> frames,
                                                       std::span<const Load> loads, Nanos settle_time, double work) {
  Result<CircuitFrames> circuit = circuit_frames(array, frames, loads, settle_time);
  if (!circuit) return std::nullopt;
  LabelledPresses presses;
  presses.circuit_ = std::make_shared<const CircuitFrames>(*std::move(circuit));
  presses.labelled_ = labelled_frames(array, *presses.circuit_, LoadsOfFrames(loads, frames.size()));
  thin_out(presses.labelled_, static_cast<std::size_t>(work / static_cast<double>(array.taxel_count())));
  return presses;
}

LabelledPresses LabelledPresses::some(double work) const {
  constexpr double kGolden = 0.618033988749895;  // its multiples are spread evenly
  if (labelled_.empty()) return *this;
  const auto taxels = static_cast<double>(labelled_.front().frame->ratio.size());
  const double share = work / (taxels * static_cast<double>(labelled_.size()));
  LabelledPresses presses;
  presses.circuit_ = circuit_;
  for (std::size_t k = 0; k < labelled_.size(); ++k) {
    const double place = kGolden * static_cast<double>(k);
    const bool is_idle = labelled_[k].newtons == 0.0;
    if (is_idle || place - std::floor(place) < share) presses.labelled_.push_back(labelled_[k]);
  }
  return presses;
}

std::optional<SinglePresses> LabelledPresses::invert(const ArrayDescription& array) const {
  std::vector<const CircuitFrame*> chosen;
  std::vector<CircuitFrame> felt;
  if (array.readout.film && array.cover) {
    felt.reserve(labelled_.size());
    const CoverKernel kernel(array);
    std::vector<float> surface(array.taxel_count());
    for (const auto& [frame, taxel, newtons] : labelled_) {
      felt.push_back(*frame);
      surface[taxel] = static_cast<float>(newtons);
      kernel.spread<float>(surface, felt.back().newtons);
      surface[taxel] = 0.0F;
      chosen.push_back(&felt.back());
    }
  } else {
    for (const LabelledFrame& one : labelled_) chosen.push_back(one.frame);
  }
  const Result<InvertedFrames> inverted = invert_frames(array, chosen);
  if (!inverted) return std::nullopt;
  SinglePresses single;
  std::vector<SinglePress> idle;
  for (std::size_t k = 0; k < labelled_.size(); ++k) {
    if (!(*inverted)[k]) continue;
    const auto& [frame, taxel, newtons] = labelled_[k];
    const std::vector<double>& siemens = (*inverted)[k]->siemens;
    SinglePress press{taxel, newtons, frame->temperature, siemens, std::vector<bool>(siemens.size())};
    std::transform(siemens.begin(), siemens.end(), press.held.begin(), [](double value) { return value == 0.0; });
    (newtons > 0.0 ? single.presses : idle).push_back(std::move(press));
  }
  if (idle.empty() || single.presses.size() < kLeastBase) return std::nullopt;
  take_out_unloaded(array, idle, single);
  return single;
}

std::optional<SinglePresses> single_presses(const ArrayDescription& array, std::span<const RawFrame> frames,
                                            std::span<const Load> loads, Nanos settle_time) {
  const double work = is_inverted_slowly(array) ? kMostSlowWork : kMostWork;
  const auto presses = LabelledPresses::create(array, frames, loads, settle_time, work);
  return presses ? presses->invert(array) : std::nullopt;
}

}  // namespace dermis::learn::calibration
