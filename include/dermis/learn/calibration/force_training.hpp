// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"

namespace dermis::learn::calibration {

/// The choices of the training, their reasons, and the fit. Many members: reports show each of them.
struct TrainingReport {
  std::size_t own_networks = 0;     ///< Taxels with a network of their own.
  std::size_t shared_networks = 0;  ///< Taxels on the shared network with a gain.
  std::vector<std::size_t> dead_taxels;
  std::size_t hidden_units = 0;             ///< Most of a network of its own; fewer where its samples are few.
  std::size_t shared_hidden_units = 0;      ///< Of the shared network.
  double shared_leave_one_out_error = 0.0;  ///< Root mean square relative error of a load left out of the shared fit.
  bool uses_temperature = false;
  double lowest_celsius = 0.0;  ///< Calibrated temperatures; meaningful where uses_temperature.
  double highest_celsius = 0.0;
  double lightest_newtons = 0.0;  ///< Lightest and heaviest calibrated load.
  double heaviest_newtons = 0.0;
  double heaviest_taxel_newtons = 0.0;  ///< The most that one taxel carried, known or by the shared network.
  double median_fit_error = 0.0;        ///< Median over taxels of the root mean square relative error on own samples.
  double worst_fit_error = 0.0;         ///< The worst taxel.
  std::size_t worst_taxel = 0;
  std::size_t groups = 0;            ///< Groups of taxels in reading order on which tables were compared with networks.
  std::size_t groups_on_tables = 0;  ///< Groups where tables were clearly better and are used.
  std::vector<std::size_t> table_taxels;  ///< Taxels with a look-up table in place of their network.
  bool is_one_load = false;               ///< All loads are about the same: straight lines, no law could be learned.
  std::string choice;                     ///< One sentence: which networks were trained and what decided it.
};

/// "median 0.74 %, worst taxel r2c7 1.44 %" of the networks of their own, and what a left-out load of the shared
/// network shows.
[[nodiscard]] std::string describe_fit(const TrainingReport& report, const ArrayDescription& array);

/// A load and the error of the networks on it, estimate less load, from the residual of the training.
struct TestedLoad {
  std::size_t sample = 0;           ///< In the database.
  std::vector<std::size_t> taxels;  ///< That carry it.
  double newtons = 0.0;             ///< The load, > 0.
  double residual_n = 0.0;          ///< Of the training [N].
  double noise_n = 0.0;             ///< Scaled to the noise of the load [N].
  double error_n = 0.0;             ///< Scaled to the error on a new load in the same place [N].
  double leverage = 0.0;            ///< Leverage of the load on its own estimate: touch::network::FittedResidual.
  std::size_t touch = 0;            ///< First sample of its touch, whose loads have errors in common.
};

struct ForceTraining {
  touch::fusion::ForceNetworks networks;  ///< Their uncertainty is still to be found: fit_uncertainty().
  TrainingReport report;
  std::vector<TestedLoad> tested_own;     ///< Loads on taxels with a network of their own, one taxel each.
  std::vector<TestedLoad> tested_shared;  ///< Of the shared network.
  std::vector<TestedLoad> tested_tables;  ///< Loads on taxels with a look-up table, each left out of it.
  /// Loads of the shared network on single taxels, with the errors of taxels that no load pressed.
  std::vector<TestedLoad> tested_unpressed;
};

/// Trains what the samples support. A taxel whose own force is known often enough gets its own network. The others
/// share one network with gains, trained through the sum of the taxels. Look-up tables are used if they are clearly
/// better on presses that are left out, or if only one load is known. `progress` gets the share done, from any thread.
/// Errors: no load above zero; no taxel answers to the loads.
[[nodiscard]] Result<ForceTraining> train_force_networks(const SampleDatabase& database,
                                                         const std::function<void(double)>& progress = {});

}  // namespace dermis::learn::calibration
