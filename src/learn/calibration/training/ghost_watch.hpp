// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "learn/calibration/training/compared_taxel.hpp"
#include "learn/calibration/training/table_maker.hpp"

namespace dermis::learn::calibration {

/// Both methods on some of the samples in which nothing presses, each taxel after its first press.
class GhostWatch {
 public:
  /// All but `maker` are to outlive it.
  GhostWatch(const SampleDatabase& database, const SampleTemperatures& temperatures,
             std::span<const std::vector<TaxelPoint>> points, const TableMaker& maker);

  /// Adds the ghosts of every taxel to `judged` [taxels].
  void watch(const touch::fusion::ForceNetworks& networks, std::vector<ComparedTaxel>& judged) const;

 private:
  [[nodiscard]] bool follows_a_press(std::size_t taxel, const Sample& sample) const;
  [[nodiscard]] float of_table(const touch::fusion::ForceNetworks& networks, std::size_t taxel,
                               const Sample& sample) const;

  const SampleDatabase& database_;
  const SampleTemperatures& temperatures_;
  std::span<const std::vector<TaxelPoint>> points_;
  std::vector<touch::fusion::ForceTables> tables_;  // [taxels], of one taxel each or of none
};

}  // namespace dermis::learn::calibration
