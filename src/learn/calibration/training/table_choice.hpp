// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/learn/calibration/force_training.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "learn/calibration/training/taxel_training.hpp"

namespace dermis::learn::calibration {

/// Compares a table of every taxel, as in the baseline "crosstalk_lookup", with the networks, by groups of neighbouring
/// taxels. The presses are ones that neither has seen (judge_left_out_presses()). A group gets its tables where they
/// are clearly better: by a fifth in the mean, and by four standard errors of the paired differences. At least twelve
/// presses are needed. Presses of one moment on several taxels are one.
///
/// Ghosts are the readings of a method after a press of a taxel, with nothing on the array. 99 of 100 are below the one
/// that counts. The networks may see ghosts of more than a tenth of the lightest load, and twice those of the tables. A
/// group then gets its tables also where they are not clearly worse on the presses. It gets none where its tables see
/// such ghosts. All others keep their networks. `points`: known forces of each taxel [taxels], with the numbers of
/// their presses.
void prefer_tables(const SampleDatabase& database, std::span<const std::vector<TaxelPoint>> points,
                   const SampleTemperatures& temperatures, ForceTraining& training);

/// Where all loads are about the same, no law can be learned from them: straight lines through the points.
void take_lines(std::span<const std::vector<TaxelPoint>> points, const SampleTemperatures& temperatures,
                ForceTraining& training);

}  // namespace dermis::learn::calibration
