// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::paper {

/// A quantity over the epochs or steps of a training, thinned out for drawing.
struct TrainingCurve {
  std::string name;
  std::vector<double> step;   ///< Rising, from 1.
  std::vector<double> value;  ///< > 0; as many as steps.
};

/// The best that Levenberg-Marquardt found for one size of the hidden layer.
struct HiddenLayerFit {
  std::size_t hidden = 0;
  std::size_t starts = 0;            ///< Random starts that were tried, at least until one reached the goal.
  double best_mse = 0.0;             ///< Eq. (2), in the units of the function; 0: not tried.
  double best_mse_normalised = 0.0;  ///< Eq. (2), with targets scaled to [0, 1]; 0: not tried.
};

/// Eq. (1), (2) and Fig. 5, 6: Peaks on 61 x 61 points. The page judges what is here; fields left as they are read
/// "not judged".
struct PeaksReproduction {
  double goal = 0.001;
  double variance = 0.0;  ///< Of the 3,721 targets.
  double range = 0.0;     ///< Largest minus smallest target.

  // 2-5-1 by gradient descent with adaptive rate and momentum (MATLAB's traingdx), as in the paper.
  std::size_t adaptive_rate_starts = 0;  ///< Random starts that were tried.
  std::size_t adaptive_rate_epochs = 0;  ///< Of each.
  double adaptive_rate_best_mse = 0.0;
  TrainingCurve adaptive_rate_curve;  ///< Eq. (2) over the epochs of the best start.

  // The best 2-5-1 network found by any algorithm.
  std::size_t side = 0;        ///< 61
  std::vector<double> target;  ///< [side, side], rows along y, columns along x, both from -3 to 3.
  std::vector<double> output;  ///< Output of the best 2-5-1 network, same shape.

  std::vector<HiddenLayerFit> by_hidden;                  ///< Rising; the first is 5. By Levenberg-Marquardt.
  std::optional<std::size_t> smallest_hidden_raw;         ///< Fewest hidden units that reached the goal.
  std::optional<std::size_t> smallest_hidden_normalised;  ///< The same with targets scaled to [0, 1].
};

/// One solved system of the structured start.
struct StartSystem {
  std::string equation;             ///< "(11)"
  std::string where;                ///< "centre", "edge", "corner"; "output" of eq. (15).
  std::size_t neighbours = 0;       ///< 8, 5, 3; of no meaning in eq. (15).
  double same = 0.0;                ///< omega_A; omega of eq. (15).
  std::optional<double> neighbour;  ///< omega_B; none in eq. (15).
  std::optional<double> other;      ///< omega_C; none in eq. (15).
  double threshold = 0.0;           ///< theta
  double residual = 0.0;            ///< Largest deviation from the printed equations it comes from.
};

/// One of the 48 points of Fig. 11 to 13.
struct PaperPoint {
  std::string taxel;  ///< "r3c5"
  double true_newtons = 0.0;
  double output_v = 0.0;       ///< Output voltage of the taxel's column.
  double calibration_v = 0.0;  ///< Output voltage of the same taxel and force by its calibration.
  double bank_newtons = 0.0;   ///< The paper's bank.
  double dermis_newtons = 0.0;
};

/// All that `dermis paper` found.
struct PaperReproduction {
  std::size_t rows = 16;
  std::size_t cols = 16;
  PeaksReproduction peaks;
  std::size_t unknowns = 0;  ///< Counted by the bank.
  std::vector<StartSystem> start;
  /// Gradient descent of the bank from each start, the paper's structured start first. The error is eq. (6): half the
  /// weighted mean square of a batch, averaged over the networks.
  std::vector<TrainingCurve> convergence;
  TrainingCurve bank_training;                ///< The training that the points are judged with; the same error.
  std::size_t bank_samples = 0;               ///< Labelled frames of the training.
  std::size_t own_samples = 0;                ///< Those that load a network's own taxel.
  std::vector<PaperPoint> points;             ///< 16 at each of 10, 20 and 50 N.
  learn::calibration::Evaluation evaluation;  ///< Of all estimators on these points.
  touch::pipeline::Model model;               ///< Model of dermis, with the baselines; as `evaluation` had it.
  std::vector<std::pair<std::string, double>> seconds;  ///< Of each part.
};

/// The reproduction as one self-contained HTML page that sets what was found against what the paper says, point by
/// point; as evaluation_page().
[[nodiscard]] std::string paper_page(const PaperReproduction& reproduction);

/// Writes the page as DIR/index.html and each figure that has data as an SVG file beside it. Files are named after the
/// paper's figures if there is one (paper_fig_05.svg, ..., peaks_training.svg, ...). The rest is as in
/// write_evaluation_report().
[[nodiscard]] Status write_paper_report(const std::string& directory, const PaperReproduction& reproduction);

}  // namespace dermis::paper
