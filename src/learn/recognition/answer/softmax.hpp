// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

namespace dermis::learn::recognition {

/// Replaces scores by probabilities: exp(score) over the sum of these, 0 for a score of -infinity. Returns ln of the
/// sum, so that -ln P is this less the score. At least one score is finite.
double softmax(std::span<double> scores);

}  // namespace dermis::learn::recognition
