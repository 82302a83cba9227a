// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/out/report/page.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/pipeline/model.hpp"

/// Arrays and models in words, for pages and terminals.
namespace dermis::out::report {

/// Size and pitch, the circuit and its resistances, ADC and supply.
[[nodiscard]] std::vector<Fact> array_facts(const ArrayDescription& array);

/// The origin of a model, its coverage and its certainty, and the remarks of its calibration. A model that was not
/// calibrated has one fact that says so.
[[nodiscard]] std::vector<Fact> calibration_facts(const touch::pipeline::Model& model);

}  // namespace dermis::out::report
