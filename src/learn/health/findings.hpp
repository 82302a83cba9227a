// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/learn/health/diagnosis.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::health {

/// The problems by the values of the diagnosis, in plain words, a sentence each, worst first.
[[nodiscard]] std::vector<std::string> findings_of(const Diagnosis& diagnosis, const touch::pipeline::Model& model);

/// Descriptions of presses that may be a fault or not.
[[nodiscard]] std::vector<std::string> remarks_on(std::span<const touch::compensation::LineFault> suspicions,
                                                  const ArrayDescription& array);

}  // namespace dermis::learn::health
