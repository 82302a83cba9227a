// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/paper/network_shape.hpp"
#include "dermis/paper/samples.hpp"

namespace dermis::paper {

/// Parameters to begin a training with, [shape.parameter_count()]. The same seed gives the same numbers. The shape must
/// be valid. Thread-safe.

/// All parameters uniform in +-range, range >= 0.
template <std::floating_point Real>
[[nodiscard]] std::vector<Real> uniform_start(const NetworkShape& shape, double range, std::uint64_t seed);

/// Weights uniform in +-sqrt(6 / (inputs of the neuron + units of its layer)), thresholds 0: Glorot and Bengio 2010.
template <std::floating_point Real>
[[nodiscard]] std::vector<Real> xavier_start(const NetworkShape& shape, std::uint64_t seed);

struct InputRange {
  double least = -1.0;
  double greatest = 1.0;
};

/// The range of each input over all patterns, [inputs]. At least one pattern.
template <std::floating_point Real>
[[nodiscard]] std::vector<InputRange> input_ranges(const Samples<Real>& samples, std::size_t inputs);

/// Nguyen and Widrow 1990, as in MATLAB's initnw. The active regions of the neurons of a layer divide the range of its
/// inputs evenly (sums in +-4 for log_sigmoid, +-2 for tanh). Take S neurons of R inputs scaled to +-1, before the
/// stretch to the active region. Weights have a random direction and length 0.7 S^(1/R). Thresholds run evenly from
/// minus to plus that length, each times the sign of the neuron's first weight (0 for S = 1). The layers above have the
/// outputs of the layer below as their range. Layers of other activations, whose active region has no end, begin as in
/// xavier_start(); so do layers above a relu or linear one. `ranges` [inputs], finite, least <= greatest; an input
/// without a range gets weights of 0.
template <std::floating_point Real>
[[nodiscard]] std::vector<Real> nguyen_widrow_start(const NetworkShape& shape, std::span<const InputRange> ranges,
                                                    std::uint64_t seed);

}  // namespace dermis::paper
