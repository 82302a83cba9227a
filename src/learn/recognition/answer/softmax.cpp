// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/answer/softmax.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::recognition {

double softmax(std::span<double> scores) {
  const double largest = *std::max_element(scores.begin(), scores.end());
  double sum = 0.0;
  for (double& score : scores) {
    score = std::exp(score - largest);
    sum += score;
  }
  for (double& score : scores) score /= sum;
  return largest + std::log(sum);
}

}  // namespace dermis::learn::recognition
