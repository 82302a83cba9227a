// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "learn/calibration/samples/unloaded_fit.hpp"

namespace dermis::learn::calibration {

inline constexpr double kMeasurableSigmas = 3.0;  // standard deviations of the unloaded reading

/// A load with the excess conductances of its taxels.
struct MeasuredLoad {
  std::size_t sample = 0;                              ///< In the database.
  std::vector<std::pair<std::size_t, double>> excess;  ///< Taxel, siemens > 0.
  double temperature = 0.0;                            ///< As an input of a network, in [-1, 1].
  double newtons = 0.0;                                ///< What the material felt of it.
  double load_newtons = 0.0;
  std::size_t touch = 0;  ///< First sample of its touch.
};

/// The loads of a database that one network of all taxels learns from. These are the loads on several taxels, and some
/// presses on single taxels that are not dead and feel them.
class SharedLoads {
 public:
  SharedLoads(const SampleDatabase& database, const SampleTemperatures& temperatures, const UnloadedFit& unloaded,
              const std::vector<bool>& dead);

  /// All loads, or as many of them, evenly, as hold about `most_shares` taxels.
  [[nodiscard]] std::vector<MeasuredLoad> loads(std::size_t most_shares) const;

 private:
  struct Press {
    std::size_t sample;
    double newtons;
    std::size_t touch;
  };

  void add_presses();
  void add(const Press& press, const std::vector<std::size_t>& taxels, double material_share);
  [[nodiscard]] double mean_temperature(const Sample& sample, const std::vector<std::size_t>& taxels) const;

  const SampleDatabase& database_;
  const SampleTemperatures& temperatures_;
  const UnloadedFit& unloaded_;
  const std::vector<bool>& dead_;
  std::vector<MeasuredLoad> loads_;
};

}  // namespace dermis::learn::calibration
