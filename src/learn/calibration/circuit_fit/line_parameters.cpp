// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/line_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double geometric_mean(const std::vector<double>& ohms) {
  double sum = 0.0;
  double count = 0.0;
  for (const double ohm : ohms) {
    if (std::isnan(ohm) || ohm <= 0.0) continue;
    sum += std::log(ohm);
    count += 1.0;
  }
  return count > 0.0 ? std::exp(sum / count) : 0.0;
}

std::vector<std::size_t> unknown_lines(const std::vector<double>& ohms) {
  std::vector<std::size_t> lines;
  for (std::size_t k = 0; k < ohms.size(); ++k) {
    if (std::isnan(ohms[k])) lines.push_back(k);
  }
  return lines;
}

/// `lines`: those of the parameters from `first` on.
std::vector<Index> parameters_of_lines(std::size_t count, const std::vector<std::size_t>& lines, Index first) {
  std::vector<Index> parameters(count, -1);
  for (const std::size_t line : lines) parameters[line] = first++;
  return parameters;
}

}  // namespace

bool is_inverted_slowly(const ArrayDescription& array) {
  return array.readout.circuit == Circuit::divider && array.readout.idle_rows == IdleRows::floating;
}

LineParameters::LineParameters(const ArrayDescription& array) : array_(array) {
  const Readout& readout = array.readout;
  if (readout.circuit == Circuit::none) {
    reference_ohm_ = 1.0;  // readings are conductances
    return;
  }
  drives_ = unknown_lines(readout.drive_ohm);
  loads_ = unknown_lines(readout.load_ohm);
  known_drive_ohm_ = geometric_mean(readout.drive_ohm);
  known_load_ohm_ = geometric_mean(readout.load_ohm);
  reference_ohm_ = known_load_ohm_ > 0.0 ? known_load_ohm_ : kNominalLoadOhm;
}

VectorXd LineParameters::start(double common_ratio) const {
  double load_ohm = reference_ohm_;
  if (known_load_ohm_ == 0.0 && known_drive_ohm_ > 0.0) load_ohm = known_drive_ohm_ / common_ratio;
  const double drive_ohm = known_drive_ohm_ > 0.0 ? known_drive_ohm_ : common_ratio * load_ohm;
  VectorXd parameters(count());
  parameters.head(drive_count()).setConstant(drive_ohm / reference_ohm_);
  parameters.tail(load_count()).setConstant(std::log(load_ohm / reference_ohm_));
  return parameters;
}

VectorXd LineParameters::moved(const VectorXd& parameters, const VectorXd& step) const {
  constexpr double kReach = 0.7;
  constexpr double kLeastReach = 0.02;
  VectorXd moved = parameters;
  for (Index p = 0; p < drive_count(); ++p) {
    const double reach = std::max(kReach * parameters[p], kLeastReach);
    moved[p] = std::max(0.0, parameters[p] + std::clamp(step[p], -reach, reach));
  }
  for (Index p = drive_count(); p < count(); ++p) moved[p] += std::clamp(step[p], -kReach, kReach);
  return moved;
}

ArrayDescription LineParameters::array_at(const VectorXd& parameters) const {
  ArrayDescription array = array_;
  Index p = 0;
  for (const std::size_t line : drives_) array.readout.drive_ohm[line] = parameters[p++] * reference_ohm_;
  for (const std::size_t line : loads_) array.readout.load_ohm[line] = std::exp(parameters[p++]) * reference_ohm_;
  return array;
}

LineGroup LineParameters::all_drives(const VectorXd& parameters) const {
  constexpr double kLeastUnit = 1e-4;
  const std::vector<double> ohms = array_at(parameters).readout.drive_ohm;
  LineGroup group{VectorXd(static_cast<Index>(ohms.size())), parameters_of_lines(ohms.size(), drives_, 0)};
  for (std::size_t k = 0; k < ohms.size(); ++k) group.values[static_cast<Index>(k)] = ohms[k] / reference_ohm_;
  if (!ohms.empty()) group.unit = std::max(kLeastUnit, group.values.mean());
  return group;
}

LineGroup LineParameters::all_loads(const VectorXd& parameters) const {
  const std::vector<double> ohms = array_at(parameters).readout.load_ohm;
  LineGroup group{VectorXd(static_cast<Index>(ohms.size())), parameters_of_lines(ohms.size(), loads_, drive_count())};
  for (std::size_t k = 0; k < ohms.size(); ++k) {
    group.values[static_cast<Index>(k)] = std::log(ohms[k] / reference_ohm_);
  }
  return group;
}

}  // namespace dermis::learn::calibration
