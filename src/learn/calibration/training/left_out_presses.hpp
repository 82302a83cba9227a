// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/learn/calibration/force_training.hpp"
#include "learn/calibration/training/compared_taxel.hpp"
#include "learn/calibration/training/table_maker.hpp"
#include "learn/calibration/training/taxel_training.hpp"

namespace dermis::learn::calibration {

/// The errors of networks and tables on presses that neither has seen [taxels]. A tenth of the presses of a taxel is
/// left out of its table at a time. Where it has only two loads, all presses of one are left out. The error of the
/// network on a press is that of a fit without it, by the leverage of its samples. Presses heavier than all that are
/// left are not judged.
[[nodiscard]] std::vector<ComparedTaxel> judge_left_out_presses(std::span<const std::vector<TaxelPoint>> points,
                                                                const TableMaker& maker, const ForceTraining& training);

}  // namespace dermis::learn::calibration
