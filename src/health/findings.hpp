// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/health/diagnosis.hpp"
#include "dermis/pipeline/model.hpp"

namespace dermis::health {

/// The problems by the values of the diagnosis, in plain words, a sentence each, worst first.
[[nodiscard]] std::vector<std::string> findings_of(const Diagnosis& diagnosis, const pipeline::Model& model);

/// Descriptions of presses that may be a fault or not.
[[nodiscard]] std::vector<std::string> remarks_on(std::span<const compensation::LineFault> suspicions,
                                                  const ArrayDescription& array);

}  // namespace dermis::health
