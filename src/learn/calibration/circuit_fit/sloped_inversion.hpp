// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/circuit_fit/solved_slopes.hpp"

namespace dermis::learn::calibration {

/// Frames in a row that one inversion takes, each from the last one's solution, whatever the number of threads.
[[nodiscard]] std::size_t frames_per_task(const ArrayDescription& array);

/// Whether derivatives by the parameters are wanted.
enum class Slopes { none, all };

/// Inversions of one circuit at the parameters, and their slopes.
class SlopedInversion {
 public:
  static Result<SlopedInversion> create(const LineParameters& lines, const Eigen::VectorXd& parameters, Slopes slopes);

  /// The film over the lines, where the array has one, is that of these loads [taxels]; not a number: 0.
  void hold_film(const std::vector<float>& newtons);

  /// Does not start from the last frame.
  void forget();

  [[nodiscard]] Eigen::Index slope_count() const { return slope_count_; }

  /// false: the circuit cannot give these readings.
  [[nodiscard]] bool invert(const std::vector<double>& ratio, std::vector<double>& siemens);

  /// Propagates the noise of the frame inverted last.
  void propagate_noise(double sigma_ratio, std::vector<double>& sigma);

  /// d siemens / d parameter [taxels, parameters] at readings whose inversion is `siemens`.
  [[nodiscard]] bool differentiate(const std::vector<double>& ratio, const std::vector<double>& siemens,
                                   Eigen::MatrixXd& slopes);

 private:
  Eigen::Index slope_count_ = 0;
  std::vector<std::unique_ptr<touch::compensation::CrosstalkInversion>> inversions_;
  std::optional<Film> film_;
  FilmConductances film_conductances_{0, 0};
  std::optional<SolvedSlopes> solved_slopes_;  // where they are faster than an inversion beside each parameter
  std::vector<double> shifted_;
};

}  // namespace dermis::learn::calibration
