// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/recognition/comparison.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// A BP network on the features of 'dermis recognise learn', for comparison. It has one hidden layer of 16 or 64 tanh
/// units and a log-sigmoid output for each class, and is trained by Adam on mini-batches. One fold of the examples is
/// left out to choose the size and the number of epochs with the most right answers. Then all examples are learned for
/// that many epochs. Probabilities are shares of the odds of the outputs.
[[nodiscard]] Result<std::vector<float>> answer_by_bp_network(const learn::recognition::Lesson& lesson);

}  // namespace dermis::paper
