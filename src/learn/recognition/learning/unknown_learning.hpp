// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/recognition/classes.hpp"
#include "learn/recognition/learning/expert_fusion.hpp"

namespace dermis::learn::recognition {

/// Learns the unknown score of `classes`, whose experts are there: ranks, weights and threshold. The look of an unknown
/// thing is learned from the examples themselves. Each is answered a second time as if its class had never been
/// learned. `scores`: fused, [examples, classes]; `distances`: of each expert, to the mean of each class; both of
/// examples that were not learned from.
void learn_unknown(Classes& classes, const Judged& judged, const Matrix& scores, const std::vector<Matrix>& distances);

}  // namespace dermis::learn::recognition
