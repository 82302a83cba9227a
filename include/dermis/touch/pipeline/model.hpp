// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/contacts/strip_table.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/fusion/look_up.hpp"
#include "dermis/touch/fusion/material_memory.hpp"
#include "dermis/touch/preprocessing/supply_bounds.hpp"

namespace dermis::touch::pipeline {

/// Everything that turns the counts of one array into newtons. It holds what is known (the array and its circuit) and
/// what was learned (the networks). It also holds the baselines of the same calibration, to compare the networks with.
struct Model {
  ArrayDescription array;
  fusion::ForceNetworks networks;
  std::vector<fusion::LookUpTables> baselines;
  std::optional<fusion::MemoryLaw> memory{};    ///< Memory of the material, where the calibration learned one.
  std::optional<contacts::StripTable> strip{};  ///< Learned positions on a strip, where the calibration had some.
  /// Supplies of the frames of the calibration; empty: they had none, or the model is of a time that did not keep them.
  std::optional<preprocessing::SupplyRange> supply{};
  std::map<std::string, std::string> provenance;  ///< Hashes, counts and statistics of the calibration, as text.
};

/// The provenance that says in what circuit and ADC are not as described; missing: nothing was noticed.
inline constexpr const char* kDoubts = "doubts";

/// All sizes are those of the array, and all values can be used.
[[nodiscard]] bool is_consistent(const Model& model);

}  // namespace dermis::touch::pipeline
