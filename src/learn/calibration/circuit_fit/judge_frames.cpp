// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/judge_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/compensation/circuit_model.hpp"
#include "learn/calibration/circuit_fit/cut_readings.hpp"
#include "learn/calibration/circuit_fit/pressed_readings.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kMostSquare = 25.0;  // of a reading
constexpr double kResolved = 5.0;     // a pressed conductance over its noise
constexpr double kCutSigmas = 3.0;    // below, idle readings are mostly cut at 0
constexpr std::size_t kJudgedPerTask = 16;

bool is_judged(const Rubber& rubber, std::size_t taxel, float newtons) {
  const TaxelLaw& law = rubber.laws[taxel];
  return newtons == 0.0F ? law.unloaded.size() > 0 : newtons > 0.0F && law.pressed.size() > 0;
}

/// The rows and columns that a frame presses.
class PressedLines {
 public:
  PressedLines(const CircuitFrame& frame, std::size_t cols)
      : cols_(cols), is_row_(frame.newtons.size() / cols), is_col_(cols) {
    for (std::size_t taxel = 0; taxel < frame.newtons.size(); ++taxel) {
      if (!(frame.newtons[taxel] > 0.0F)) continue;
      is_row_[taxel / cols] = is_col_[taxel % cols] = true;
      ++pressed_;
    }
  }

  [[nodiscard]] bool cross(std::size_t taxel) const { return is_row_[taxel / cols_] || is_col_[taxel % cols_]; }
  [[nodiscard]] bool are_of_one_press() const { return pressed_ == 1; }

 private:
  std::size_t cols_;
  std::vector<bool> is_row_;
  std::vector<bool> is_col_;
  std::size_t pressed_ = 0;
};

void add(const JudgedReading& reading, float variance, FrameMisfit& misfit) {
  if (reading.taxel == JudgedReading::Taxel::unknown) return;
  double square = static_cast<double>(reading.square) / static_cast<double>(variance);
  if (!(square < kMostSquare)) square = kMostSquare;  // also where it is not a number
  misfit.square += square;
  misfit.readings += 1.0;
  if (reading.taxel == JudgedReading::Taxel::pressed) {
    misfit.pressed_square += square;
    misfit.pressed_readings += 1.0;
  }
  if (reading.taxel == JudgedReading::Taxel::crossed) {
    misfit.crossed_square += square;
    misfit.crossed_readings += 1.0;
  }
}

void add_beside(const JudgedReading& reading, const JudgedReading& other, FrameMisfit& misfit) {
  if (!reading.depends_on_circuit || !other.depends_on_circuit) return;
  add(reading, std::max(reading.variance, other.variance), misfit);
}

/// Residuals of pressed taxels that are smaller than their noise and scatter count as large as these.
FrameMisfit with_scatter(FrameMisfit frame) {
  const double scattered = std::max(frame.pressed_square, frame.pressed_readings);
  frame.square += scattered - frame.pressed_square;
  frame.pressed_square = scattered;
  return frame;
}

/// One circuit and its rubber. Idle taxels are judged by their readings, whose noise is the same in all circuits.
class Judge {
 public:
  Judge(const ArrayDescription& array, const Rubber& rubber, const Scatter& scatter)
      : cols_(array.cols), rubber_(rubber), scatter_(scatter) {
    if (array.readout.circuit == Circuit::none) return;
    Result<touch::compensation::CircuitModel> model = touch::compensation::CircuitModel::create(array);
    if (model) model_.emplace(std::move(*model));
  }

  /// `inverted`: empty where the circuit cannot give the frame. `readings`: [taxels].
  void judge(const CircuitFrame& frame, const std::optional<InvertedFrame>& inverted, JudgedReading* readings) {
    if (inverted) expect_readings(frame, *inverted);
    const PressedLines lines(frame, cols_);
    for (std::size_t taxel = 0; taxel < frame.newtons.size(); ++taxel) {
      if (!is_judged(rubber_, taxel, frame.newtons[taxel])) continue;
      JudgedReading& reading = readings[taxel];
      const bool is_pressed = frame.newtons[taxel] > 0.0F;
      if (!inverted) {
        reading = {std::numeric_limits<float>::infinity(), 1.0F, {}, true};
      } else {
        reading = is_pressed ? judge_pressed(frame, *inverted, taxel) : judge_idle(frame, taxel);
      }
      if (is_pressed && lines.are_of_one_press()) reading.depends_on_circuit = false;
      reading.taxel = is_pressed           ? JudgedReading::Taxel::pressed
                      : lines.cross(taxel) ? JudgedReading::Taxel::crossed
                                           : JudgedReading::Taxel::idle;
    }
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

  [[nodiscard]] JudgedReading judge_pressed(const CircuitFrame& frame, const InvertedFrame& inverted,
                                            std::size_t taxel) const {
    const double sigma = inverted.sigma_siemens[taxel];
    const double log_force = rubber_.force_scale.log_force(static_cast<double>(frame.newtons[taxel]));
    const PressedPoint point =
        pressed_point({taxel, log_force, frame.temperature, inverted.siemens[taxel], sigma, {}}, rubber_, scatter_);
    const double noise = std::sqrt(scatter_.noise_variance) * sigma / rubber_.reference_siemens;
    // No law is nearer to its rubber than this, so a larger residual is not due to the circuit.
    const double rubber = std::max(std::sqrt(scatter_.rubber_variance), kRubberScatter) * point.expected;
    return {static_cast<float>(std::pow((point.excess - point.expected) / noise, 2)),
            static_cast<float>(1.0 + std::pow(rubber / noise, 2)),
            {},
            point.expected > kResolved * sigma / rubber_.reference_siemens};
  }

  [[nodiscard]] JudgedReading judge_idle(const CircuitFrame& frame, std::size_t taxel) const {
    const double cut = rubber_.laws[taxel].is_readable ? trusted_above(frame) : kCutSigmas * frame.described_sigma;
    const double sigma = frame.sigma_ratio * std::sqrt(scatter_.noise_variance);
    const double difference = std::max(frame.ratio[taxel], cut) - mean_above(cut, expected_[taxel], sigma);
    const double square = std::pow(difference / sigma, 2);
    return {static_cast<float>(square), 1.0F, {}, true};
  }

  std::size_t cols_;
  const Rubber& rubber_;
  const Scatter& scatter_;
  std::optional<touch::compensation::CircuitModel> model_;  // empty: readings are conductances
  std::vector<double> expected_;                            // readings over the supply
};

}  // namespace

FrameMisfit& FrameMisfit::operator+=(const FrameMisfit& other) {
  square += other.square;
  readings += other.readings;
  pressed_square += other.pressed_square;
  pressed_readings += other.pressed_readings;
  crossed_square += other.crossed_square;
  crossed_readings += other.crossed_readings;
  return *this;
}

JudgedReadings judge_frames(const ArrayDescription& array, const Rubber& rubber, const Scatter& scatter,
                            const InvertedFrames& inverted, const std::vector<const CircuitFrame*>& frames) {
  JudgedReadings readings(frames.size() * array.taxel_count());
  parallel_for((frames.size() + kJudgedPerTask - 1) / kJudgedPerTask, [&](std::size_t task) {
    Judge judge(array, rubber, scatter);
    const std::size_t end = std::min(frames.size(), (task + 1) * kJudgedPerTask);
    for (std::size_t k = task * kJudgedPerTask; k < end; ++k) {
      judge.judge(*frames[k], inverted[k], &readings[k * array.taxel_count()]);
    }
  });
  return readings;
}

FrameMisfit misfit_of(const JudgedReadings& readings) {
  FrameMisfit all;
  for (const JudgedReading& reading : readings) add(reading, reading.variance, all);
  return all;
}

FrameMisfit misfit_beside(const JudgedReadings& readings, const JudgedReadings& other) {
  FrameMisfit all;
  for (std::size_t k = 0; k < readings.size(); ++k) add_beside(readings[k], other[k], all);
  return all;
}

FrameMisfit rough_misfit_beside(const JudgedReadings& readings, const JudgedReadings& other, std::size_t taxels) {
  FrameMisfit all;
  for (std::size_t first = 0; first < readings.size(); first += taxels) {
    FrameMisfit frame;
    for (std::size_t k = first; k < first + taxels; ++k) add_beside(readings[k], other[k], frame);
    all += with_scatter(frame);
  }
  return all;
}

}  // namespace dermis::learn::calibration
