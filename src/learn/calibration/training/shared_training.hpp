// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/force_training.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "learn/calibration/samples/unloaded_fit.hpp"
#include "learn/calibration/training/force_network.hpp"

namespace dermis::learn::calibration {

/// One network for all taxels and a gain for each.
struct SharedNetwork {
  ForceNetwork network;
  std::vector<double> gain;  ///< [taxels]; all 1 where gains did not help.
  bool has_gains = false;
  double heaviest_newtons = 0.0;     ///< The most that one taxel carried, by this network.
  double leave_one_out_error = 0.0;  ///< Root mean square relative error of a load that is held out.
  std::vector<TestedLoad> tested;
  /// Loads on single taxels, with the errors of taxels that no load pressed.
  std::vector<TestedLoad> tested_unpressed;
};

/// Trains through the sum: for every load, sum over its taxels of gain_i f(e_i, t) = newtons. The analytic
/// leave-one-out error chooses the number of hidden units (0 ... 3; one for every seven different forces). Each is
/// trained from the best of several random starts. Gains have a prior about 1, as wide as taxels are known to differ.
/// They are fitted in turn with the network as long as they lower the error of held-out loads. Large calibrations are
/// thinned out evenly (12 presses of a taxel alone, 200,000 taxels of all loads together). Deterministic, whatever the
/// number of threads.
[[nodiscard]] SharedNetwork train_shared(const SampleDatabase& database, const SampleTemperatures& temperatures,
                                         const UnloadedFit& unloaded, const std::vector<bool>& dead);

}  // namespace dermis::learn::calibration
