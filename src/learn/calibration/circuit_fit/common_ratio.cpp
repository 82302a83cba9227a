// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/common_ratio.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "learn/calibration/circuit_fit/gauss_newton.hpp"
#include "learn/calibration/circuit_fit/judge_frames.hpp"
#include "learn/calibration/circuit_fit/sloped_inversion.hpp"
#include "learn/calibration/even_choice.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::array kRatios = {0.0, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0};  // tried first
constexpr int kRefinements = 8;
constexpr double kFineEnough = 0.01;     // of the logarithm of the ratio
constexpr std::size_t kFirstFrames = 8;  // to see whether the circuit can give them

std::vector<const CircuitFrame*> some_of(const std::vector<const CircuitFrame*>& frames, std::size_t most) {
  std::vector<const CircuitFrame*> some;
  for (const std::size_t k : even_choice(frames.size(), most)) some.push_back(frames[k]);
  return some;
}

/// The circuit cannot give most frames.
bool is_impossible(const InvertedFrames& inverted) {
  const auto unsolved = std::count_if(inverted.begin(), inverted.end(), [](const auto& frame) { return !frame; });
  return 2 * static_cast<std::size_t>(unsolved) > inverted.size();
}

/// The same of a few frames, without their noise, and no longer than until that is sure.
Result<bool> is_impossible_at_first(const LineParameters& known, const std::vector<const CircuitFrame*>& frames) {
  Result<SlopedInversion> inversion = SlopedInversion::create(known, Eigen::VectorXd(0), Slopes::none);
  if (!inversion) return inversion.error();
  std::vector<double> siemens(known.array().taxel_count());
  std::size_t unsolved = 0;
  for (std::size_t k = 0; k < frames.size() && 2 * unsolved <= frames.size(); ++k) {
    if (2 * (k - unsolved) >= frames.size()) break;
    if (inversion->invert(frames[k]->ratio, siemens)) continue;
    inversion->forget();
    ++unsolved;
  }
  return 2 * unsolved > frames.size();
}

/// Empty: the circuit cannot give most of the frames.
Result<std::optional<CommonRatio>> try_ratio(const LineParameters& lines,
                                             const std::vector<const CircuitFrame*>& frames, const Rubber& unknown,
                                             double ratio) {
  CommonRatio trial;
  trial.ratio = ratio;
  trial.array = lines.array_at(lines.start(ratio));
  const LineParameters known(trial.array);
  const Result<bool> is_hopeless = is_impossible_at_first(known, some_of(frames, kFirstFrames));
  if (!is_hopeless) return is_hopeless.error();
  if (*is_hopeless) return std::optional<CommonRatio>();
  Result<InvertedFrames> inverted = invert_frames(trial.array, frames);
  if (!inverted) return inverted.error();
  if (is_impossible(*inverted)) return std::optional<CommonRatio>();
  trial.inverted = *std::move(inverted);
  const Iteration laws = fit_laws(known, trial.inverted, frames, {Eigen::VectorXd(0), unknown, Scatter{}});
  trial.rubber = laws.estimate.rubber;
  trial.scatter = laws.estimate.scatter;
  return std::optional(std::move(trial));
}

/// Where the parabola through three points has its least value; x1 is between the others.
double least_of_parabola(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  const double left = (x[1] - x[0]) * (y[1] - y[2]);
  const double right = (x[1] - x[2]) * (y[1] - y[0]);
  const double curvature = left - right;
  const double middle = 0.5 * (x[0] + x[2]);
  if (curvature == 0.0) return middle;
  return x[1] - 0.5 * ((x[1] - x[0]) * left - (x[1] - x[2]) * right) / curvature;
}

/// Trials in the order of their ratios.
class RatioSearch {
 public:
  RatioSearch(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames, const Rubber& unknown)
      : lines_(lines), frames_(frames), unknown_(unknown) {}

  Status add(double ratio) {
    Result<std::optional<CommonRatio>> trial = try_ratio(lines_, frames_, unknown_, ratio);
    if (!trial) return trial.error();
    if (!*trial) return Done{};
    judge(**trial);
    const auto above =
        std::find_if(trials_.begin(), trials_.end(), [&](const CommonRatio& other) { return other.ratio > ratio; });
    trials_.insert(above, **std::move(trial));
    return Done{};
  }

  /// Judges by the scatter that the best so far has learned, which is the same for all.
  void learn_scatter() {
    scatter_ = trials_[best()].scatter;
    for (CommonRatio& trial : trials_) judge(trial);
  }

  /// A ratio between the best and its neighbours that promises a smaller misfit; empty: fine enough, or at an end.
  [[nodiscard]] std::optional<double> next() const {
    const std::size_t k = best();
    if (k == 0 || k + 1 >= trials_.size() || trials_[k - 1].ratio == 0.0) return std::nullopt;
    std::array<double, 3> x{};
    std::array<double, 3> y{};
    for (std::size_t n = 0; n < 3; ++n) {
      x[n] = std::log(trials_[k - 1 + n].ratio);
      y[n] = trials_[k - 1 + n].misfit;
    }
    const bool is_wider_below = x[1] - x[0] > x[2] - x[1];
    const double wider = std::max(x[1] - x[0], x[2] - x[1]);
    double promising = least_of_parabola(x, y);
    // Too near to a tried ratio: halve the wider side instead.
    if (std::abs(promising - x[1]) < kFineEnough) promising = x[1] + (is_wider_below ? -0.5 : 0.5) * wider;
    if (wider < kFineEnough) return std::nullopt;
    return std::exp(promising);
  }

  [[nodiscard]] std::size_t best() const {
    const auto least = std::min_element(trials_.begin(), trials_.end(),
                                        [](const CommonRatio& a, const CommonRatio& b) { return a.misfit < b.misfit; });
    return static_cast<std::size_t>(least - trials_.begin());
  }

  [[nodiscard]] bool is_empty() const { return trials_.empty(); }
  [[nodiscard]] CommonRatio take_best() { return std::move(trials_[best()]); }

 private:
  void judge(CommonRatio& trial) const {
    trial.misfit = misfit_of(judge_frames(trial.array, trial.rubber, scatter_, trial.inverted, frames_)).square;
  }

  const LineParameters& lines_;
  const std::vector<const CircuitFrame*>& frames_;
  const Rubber& unknown_;
  Scatter scatter_;
  std::vector<CommonRatio> trials_;
};

}  // namespace

Result<CommonRatio> fit_common_ratio(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                                     const Rubber& unknown) {
  RatioSearch search(lines, frames, unknown);
  for (const double ratio : kRatios) {
    if (ratio == 0.0 && !lines.allows_ideal_drivers()) continue;
    if (Status tried = search.add(ratio); !tried) return tried.error();
    if (lines.count() == 0) break;
  }
  if (search.is_empty()) {
    return bad_input("readout: no resistances explain the calibration frames in this circuit; check its kind");
  }
  search.learn_scatter();
  for (int k = 0; k < kRefinements; ++k) {
    const std::optional<double> ratio = search.next();
    if (!ratio) break;
    if (Status tried = search.add(*ratio); !tried) return tried.error();
  }
  return search.take_best();
}

}  // namespace dermis::learn::calibration
