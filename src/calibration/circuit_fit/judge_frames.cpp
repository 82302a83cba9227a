// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/circuit_fit/judge_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "calibration/circuit_fit/pressed_readings.hpp"
#include "dermis/compensation/circuit_model.hpp"
#include "dermis/core/parallel.hpp"

namespace dermis::calibration {
namespace {

constexpr double kMostSquare = 25.0;  // of a reading
constexpr std::size_t kJudgedPerTask = 16;

bool is_judged(const Rubber& rubber, std::size_t taxel, float newtons) {
  const TaxelLaw& law = rubber.laws[taxel];
  return newtons == 0.0F ? law.unloaded.size() > 0 : newtons > 0.0F && law.pressed.size() > 0;
}

/// One circuit and its rubber. Idle taxels are judged by their readings, whose noise is the same in all circuits.
class Judge {
 public:
  Judge(const ArrayDescription& array, const Rubber& rubber, const Scatter& scatter)
      : rubber_(rubber), scatter_(scatter) {
    if (array.readout.circuit == Circuit::none) return;
    Result<compensation::CircuitModel> model = compensation::CircuitModel::create(array);
    if (model) model_.emplace(std::move(*model));
  }

  /// `inverted`: empty where the circuit cannot give the frame.
  [[nodiscard]] FrameMisfit misfit(const CircuitFrame& frame, const std::optional<InvertedFrame>& inverted) {
    FrameMisfit misfit;
    if (inverted) expect_readings(frame, *inverted);
    for (std::size_t taxel = 0; taxel < frame.newtons.size(); ++taxel) {
      if (!is_judged(rubber_, taxel, frame.newtons[taxel])) continue;
      misfit.readings += 1.0;
      const double square = inverted ? square_of(frame, *inverted, taxel) : kMostSquare;
      misfit.square += square < kMostSquare ? square : kMostSquare;  // also where it is not a number
    }
    return misfit;
  }

 private:
  /// With the idle taxels at their laws.
  void expect_readings(const CircuitFrame& frame, const InvertedFrame& inverted) {
    expected_ = inverted.siemens;
    const Eigen::VectorXd basis = unloaded_basis(rubber_, frame.temperature);
    for (std::size_t taxel = 0; taxel < expected_.size(); ++taxel) {
      const Eigen::VectorXd& law = rubber_.laws[taxel].unloaded;
      if (frame.newtons[taxel] != 0.0F || law.size() == 0) continue;
      expected_[taxel] = std::max(0.0, law.dot(basis) * rubber_.reference_siemens);
    }
    if (!model_) return;
    model_->solve(expected_);
    expected_.assign(model_->ratio().begin(), model_->ratio().end());
  }

  [[nodiscard]] double square_of(const CircuitFrame& frame, const InvertedFrame& inverted, std::size_t taxel) const {
    const double siemens = inverted.siemens[taxel];
    const double sigma = inverted.sigma_siemens[taxel];
    if (frame.newtons[taxel] == 0.0F) {
      return std::pow((frame.ratio[taxel] - expected_[taxel]) / frame.sigma_ratio, 2) / scatter_.noise_variance;
    }
    const double log_force = rubber_.force_scale.log_force(static_cast<double>(frame.newtons[taxel]));
    const PressedPoint point =
        pressed_point({taxel, log_force, frame.temperature, siemens, sigma, {}}, rubber_, scatter_);
    const double noise = sigma / rubber_.reference_siemens;
    // No law is nearer to its rubber than this: what is beyond is not the circuit's.
    const double rubber_variance = std::max(scatter_.rubber_variance, kRubberScatter * kRubberScatter);
    const double variance = scatter_.noise_variance * noise * noise + rubber_variance * point.expected * point.expected;
    return std::pow(point.excess - point.expected, 2) / variance;
  }

  const Rubber& rubber_;
  const Scatter& scatter_;
  std::optional<compensation::CircuitModel> model_;  // empty: readings are conductances
  std::vector<double> expected_;                     // readings over the supply
};

}  // namespace

FrameMisfit judge_frames(const ArrayDescription& array, const Rubber& rubber, const Scatter& scatter,
                         const InvertedFrames& inverted, const std::vector<const CircuitFrame*>& frames) {
  std::vector<FrameMisfit> parts((frames.size() + kJudgedPerTask - 1) / kJudgedPerTask);
  parallel_for(parts.size(), [&](std::size_t task) {
    Judge judge(array, rubber, scatter);
    const std::size_t end = std::min(frames.size(), (task + 1) * kJudgedPerTask);
    for (std::size_t k = task * kJudgedPerTask; k < end; ++k) parts[task] += judge.misfit(*frames[k], inverted[k]);
  });
  FrameMisfit all;
  for (const FrameMisfit& part : parts) all += part;
  return all;
}

}  // namespace dermis::calibration
