// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/assumptions.hpp"

#include <cmath>
#include <cstddef>

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSheetSpread = 0.03;  // a pseudo-observation of the spread of the rubber from line to line

void assume_alike(const LineGroup& group, double spread, Index parameter_count, std::vector<Assumption>& assumptions) {
  if (group.values.size() == 0) return;
  const auto count = static_cast<double>(group.values.size());
  const double mean = group.values.mean();
  VectorXd mean_row = VectorXd::Zero(parameter_count);
  for (const Index p : group.parameters) {
    if (p >= 0) mean_row[p] += 1.0 / count;
  }
  for (std::size_t k = 0; k < group.parameters.size(); ++k) {
    VectorXd row = -mean_row;
    if (group.parameters[k] >= 0) row[group.parameters[k]] += 1.0;
    assumptions.push_back({row, group.values[static_cast<Index>(k)] - mean, spread * group.unit});
  }
}

/// Logarithms of the unloaded conductances: first their sums over a line, then their means.
struct LineLevels {
  VectorXd sensed;
  VectorXd driven;
  VectorXd sensed_count;
  VectorXd driven_count;
  MatrixXd slopes;  // of `sensed` by the parameters

  /// Means of lines compare only where most of their taxels are known.
  [[nodiscard]] bool are_known() const {
    return 2.0 * sensed_count.minCoeff() >= static_cast<double>(driven.size()) &&
           2.0 * driven_count.minCoeff() >= static_cast<double>(sensed.size());
  }
};

LineLevels sum_levels(const LineParameters& lines, const Elimination& idle) {
  const ArrayDescription& array = lines.array();
  const bool rows_are_sensed = array.readout.circuit == Circuit::flexitac;
  LineLevels levels;
  levels.sensed_count = levels.sensed = VectorXd::Zero(static_cast<Index>(array.sensed_lines()));
  levels.driven_count = levels.driven = VectorXd::Zero(static_cast<Index>(array.driven_lines()));
  levels.slopes = MatrixXd::Zero(levels.sensed.size(), lines.count());
  for (std::size_t taxel = 0; taxel < idle.laws.size(); ++taxel) {
    const MatrixXd& law = idle.laws[taxel];
    if (law.size() == 0 || law(0, lines.count()) <= 0.0) continue;
    const auto row = static_cast<Index>(taxel / array.cols);
    const auto col = static_cast<Index>(taxel % array.cols);
    const Index sensed = rows_are_sensed ? row : col;
    const Index driven = rows_are_sensed ? col : row;
    const double level = std::log(law(0, lines.count()));
    levels.sensed[sensed] += level;
    levels.driven[driven] += level;
    levels.sensed_count[sensed] += 1.0;
    levels.driven_count[driven] += 1.0;
    levels.slopes.row(sensed) += law.row(0).head(lines.count()) / law(0, lines.count());
  }
  return levels;
}

void divide_by_counts(LineLevels& levels) {
  levels.sensed.array() /= levels.sensed_count.array();
  levels.driven.array() /= levels.driven_count.array();
  levels.slopes.array().colwise() /= levels.sensed_count.array();
}

double scatter_of(VectorXd levels) {
  levels.array() -= levels.mean();
  return std::sqrt((levels.squaredNorm() + kSheetSpread * kSheetSpread) / static_cast<double>(levels.size()));
}

}  // namespace

std::vector<Assumption> alike_lines(const LineParameters& lines, const Estimate& estimate) {
  std::vector<Assumption> assumptions;
  assume_alike(lines.all_drives(estimate.parameters), estimate.scatter.drive_spread, lines.count(), assumptions);
  assume_alike(lines.all_loads(estimate.parameters), estimate.scatter.load_spread, lines.count(), assumptions);
  return assumptions;
}

std::vector<Assumption> nominal_scale(const LineParameters& lines, const VectorXd& parameters) {
  constexpr double kSigma = 1e-4;
  const Index loads = lines.load_count();
  if (lines.has_absolute() || loads == 0) return {};
  VectorXd row = VectorXd::Zero(lines.count());
  row.tail(loads).setConstant(1.0 / static_cast<double>(loads));
  return {{row, parameters.tail(loads).mean(), kSigma}};
}

std::optional<SheetComparison> compare_sheet(const LineParameters& lines, const Elimination& idle) {
  if (lines.load_count() == 0 || lines.array().sensed_lines() < 2 || lines.array().driven_lines() < 2) {
    return std::nullopt;
  }
  LineLevels levels = sum_levels(lines, idle);
  if (!levels.are_known()) return std::nullopt;
  divide_by_counts(levels);
  SheetComparison comparison;
  comparison.scatter = scatter_of(levels.driven);
  const Eigen::RowVectorXd mean_slope = levels.slopes.colwise().mean();
  const double mean = levels.sensed.mean();
  for (Index line = 0; line < levels.sensed.size(); ++line) {
    comparison.assumptions.push_back(
        {(levels.slopes.row(line) - mean_slope).transpose(), levels.sensed[line] - mean, comparison.scatter});
  }
  return comparison;
}

}  // namespace dermis::learn::calibration
