// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "calibration/training/taxel_training.hpp"
#include "dermis/calibration/force_training.hpp"
#include "dermis/calibration/sample_database.hpp"
#include "dermis/calibration/sample_temperatures.hpp"

namespace dermis::calibration {

/// Samples in a row under about the same force are one press: sets TaxelPoint::press of all points of a taxel, by
/// rising sample, before any are left out.
void number_presses(std::vector<TaxelPoint>& points);

/// Holds a table of every taxel, as the baseline "crosstalk_lookup" has it, against the networks, group of neighbouring
/// taxels by group, on presses that neither has seen: a tenth of the presses of a taxel is left out of its table at a
/// time, and the error of the network on a press is that of a fit without it, by the leverage of its samples. Presses
/// heavier than all that are left are not judged; where a taxel has but two loads, all presses of one are left out at a
/// time. A group gets its tables where they are clearly better: by a fifth in
/// the mean, and by four standard errors of the paired differences over at least twelve presses (those of one moment on
/// several taxels are one). What either method reads after a press of a taxel, with nothing on the array, are ghosts: a
/// group gets its tables also where they are not clearly worse on the presses and the networks see ghosts (99 of 100
/// are below) of more than a tenth of the lightest load, twice those of the tables; and none where its tables see such
/// ghosts. All others keep their networks. `points`: known forces of each taxel [taxels], with the numbers of their
/// presses.
void prefer_tables(const SampleDatabase& database, std::span<const std::vector<TaxelPoint>> points,
                   const SampleTemperatures& temperatures, ForceTraining& training);

/// Where all loads are about the same, no law can be learned from them: straight lines through the points.
void take_lines(std::span<const std::vector<TaxelPoint>> points, const SampleTemperatures& temperatures,
                ForceTraining& training);

}  // namespace dermis::calibration
