// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/fusion/look_up.hpp"

namespace dermis::learn::calibration {

/// The three estimators that dermis is set beside, made from the same samples:
///
///   raw_lookup          reading -> force, one table per taxel
///   temperature_lookup  the same with a linear temperature term per taxel
///   crosstalk_lookup    conductance after the crosstalk inversion -> force, with the linear temperature term
///
/// A table has a knot at every calibrated force (at most 64, in equal shares beyond), the mean signal there, made
/// rising by pooling neighbours. Taxels whose own force is never known get straight lines whose common slope fits the
/// totals.
[[nodiscard]] std::vector<touch::fusion::LookUpTables> make_baselines(const SampleDatabase& database);

}  // namespace dermis::learn::calibration
