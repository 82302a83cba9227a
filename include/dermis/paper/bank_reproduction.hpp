// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "dermis/paper/bank_training.hpp"
#include "dermis/paper/paper_report.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

struct BankEffort {
  std::size_t convergence_steps = 300;      ///< Gradient descent from each start.
  std::size_t training_steps = kBankSteps;  ///< Adam, for the points.
};

/// The array of the paper with the circuit of the project's reference array.
[[nodiscard]] ArrayDescription paper_array(std::size_t rows, std::size_t cols);

/// The unknown count, the structured start, the convergence from each start and Fig. 11 to 13, on a simulated array:
/// fills these parts of `found`. Deterministic.
[[nodiscard]] Status reproduce_bank(const ArrayDescription& array, const BankEffort& effort,
                                    const std::function<void(const std::string& part, double share)>& progress,
                                    PaperReproduction& found);

}  // namespace dermis::paper
