// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/fusion/material_memory.hpp"
#include "learn/calibration/memory/siemens_history.hpp"

namespace dermis::learn::calibration {

/// The forces that networks give over a history: what the material feels.
struct MaterialHistory {
  std::vector<Nanos> time;     ///< [frames]
  std::vector<float> newtons;  ///< [frames, taxels]; NaN where there is none.
  std::size_t taxels = 0;
};

[[nodiscard]] MaterialHistory material_history(const SiemensHistory& history,
                                               const touch::fusion::ForceNetworks& networks);

/// A known force above zero on one taxel, or on several that share it, at a place in a history.
struct KnownLoad {
  std::size_t sample = 0;            ///< In the database.
  std::size_t place = 0;             ///< In the history.
  std::vector<std::size_t> taxels;   ///< That carry it.
  double newtons = 0.0;              ///< > 0
  std::optional<std::size_t> total;  ///< Number of it among the totals of the sample; empty: of one taxel.
};

/// Those of a database whose samples are in the history, by rising place.
[[nodiscard]] std::vector<KnownLoad> known_loads(const SampleDatabase& database, const SiemensHistory& history);

/// Felt and freed forces of known loads, sums over their taxels [N].
struct FreedLoad {
  double material_newtons = 0.0;
  double newtons = 0.0;
};

/// Known loads with the felt forces of their taxels over a history: any law frees them.
class FeltLoads {
 public:
  FeltLoads(const MaterialHistory& material, std::span<const KnownLoad> loads);

  [[nodiscard]] std::vector<FreedLoad> freed(const touch::fusion::MemoryLaw& law) const;

 private:
  /// The columns of a load at its place.
  struct Felt {
    std::size_t place = 0;
    std::vector<std::size_t> columns;
    double material_newtons = 0.0;
  };

  std::size_t columns_ = 0;     // of taxels that are asked for and felt anything
  std::vector<float> newtons_;  // [frames to the last load, columns]
  std::vector<std::optional<touch::fusion::MaterialMemory::Approach>> approach_;  // [frames to the last load]
  std::vector<Felt> loads_;
};

/// The loads as a law frees them.
[[nodiscard]] std::vector<FreedLoad> freed_loads(const MaterialHistory& material, std::span<const KnownLoad> loads,
                                                 const touch::fusion::MemoryLaw& law);

/// Root mean square relative error of the loads by a law. Each taxel and all totals have a gain of their own: networks
/// may be wrong by one.
[[nodiscard]] double memory_misfit(const MaterialHistory& material, std::span<const KnownLoad> loads,
                                   const touch::fusion::MemoryLaw& law);

/// The law whose misfit is the least, from `start`. Without stops where that has none.
[[nodiscard]] touch::fusion::MemoryLaw fit_memory(const MaterialHistory& material, std::span<const KnownLoad> loads,
                                                  const touch::fusion::MemoryLaw& start);

}  // namespace dermis::learn::calibration
