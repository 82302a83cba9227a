// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "learn/recognition/matrix.hpp"

/// One answer from those of several experts: docs/reasons/recognition.md, eqs. (4) and (5).
namespace dermis::learn::recognition {

/// Examples that were scored by what they did not teach.
struct Judged {
  std::vector<std::size_t> classes;                 ///< The right one of each example.
  std::vector<std::size_t> fold_of;                 ///< Of each example.
  std::vector<std::vector<std::uint8_t>> is_known;  ///< [folds][classes]: whether the others of a fold have the class.

  /// Whether the right class could have been answered at all.
  [[nodiscard]] bool counts(std::size_t example) const { return is_known[fold_of[example]][classes[example]] != 0; }
};

/// exp(score) over its sum, of the known classes; the others get 0.
void softmax(const Judged& judged, Matrix& scores);

/// Mean of -ln P(right class) under softmax(scores * sharpness), over those that count.
[[nodiscard]] double log_loss(const Judged& judged, const Matrix& scores, double sharpness);

/// The sharpness with the least log loss, 1e-4 ... 1e4.
[[nodiscard]] double best_sharpness(const Judged& judged, const Matrix& scores);

/// Weights >= 0 of the experts' scores, [examples, classes] each, for the least log loss of softmax(sum of w scores)
/// + 1e-3 |w|^2; by Newton's method on those that are not held at 0.
[[nodiscard]] std::vector<double> fuse(const Judged& judged, const std::vector<Matrix>& scores);

/// sum of w scores
[[nodiscard]] Matrix fused_scores(const std::vector<Matrix>& scores, const std::vector<double>& weights);

/// The same, the examples of each fold with the weights that suit the other folds.
[[nodiscard]] Matrix fused_out_of_fold(const Judged& judged, const std::vector<Matrix>& scores);

}  // namespace dermis::learn::recognition
