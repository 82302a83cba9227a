// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <string>

#include "dermis/core/result.hpp"
#include "dermis/paper/training.hpp"

namespace dermis::paper {

/// A training on disk, as a safetensors file: resumed from it, a training gives the same bits as in one run.
/// Float and double states are different files; neither is read as the other.

/// Writes the file atomically: it is whole or not there.
template <std::floating_point Real>
[[nodiscard]] Status write_training_checkpoint(const std::string& path, const TrainingState<Real>& state);

/// Reads a checkpoint of a training of this shape. Errors, one line with the path: a file that is not whole or not of
/// this kind; a training of another shape, both of which are named; or a state that check_state() refuses.
template <std::floating_point Real>
[[nodiscard]] Result<TrainingState<Real>> read_training_checkpoint(const std::string& path, const NetworkShape& shape);

}  // namespace dermis::paper
