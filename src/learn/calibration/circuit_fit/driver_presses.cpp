// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/driver_presses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "learn/calibration/circuit_fit/press_prediction.hpp"
#include "learn/calibration/even_choice.hpp"

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kPresses = 5;
constexpr std::size_t kMostPairsOfLine = 10;  // that are looked at

/// A pair and its information on its driver.
struct DriverPair {
  PressPair pair;
  Index driver = 0;          // among the parameters
  double information = 0.0;  // 1 / variance of the parameter
};

std::vector<PressPair> pairs_of_line(const std::vector<std::size_t>& taxels, std::size_t cols,
                                     const std::vector<double>& heaviest) {
  std::vector<PressPair> pairs;
  for (std::size_t a = 0; a < taxels.size(); ++a) {
    for (std::size_t b = a + 1; b < taxels.size(); ++b) {
      const double newtons = std::min(heaviest[taxels[a]], heaviest[taxels[b]]);
      if (newtons > 0.0 && are_apart(cols, taxels[a], taxels[b])) pairs.push_back({taxels[a], taxels[b], newtons});
    }
  }
  std::vector<PressPair> some;
  for (const std::size_t k : even_choice(pairs.size(), kMostPairsOfLine)) some.push_back(pairs[k]);
  return some;
}

/// How the readings of pairs of taxels follow their driver. A taxel that was pressed alone has shown its law in series
/// with the driver. If the driver is s ohm larger, the conductance g is g^2 s larger.
class PairInformation {
 public:
  PairInformation(const LineParameters& lines, const Estimate& fitted, touch::compensation::CircuitModel& model,
                  double noise)
      : fitted_(fitted),
        model_(model),
        ohm_(lines.reference_ohm()),
        noise_(noise),
        drives_(static_cast<Index>(lines.array().driven_lines())),
        by_drive_(static_cast<std::size_t>(drives_) * lines.array().taxel_count()) {}

  [[nodiscard]] double of(const PressPair& pair, std::size_t line) {
    const std::vector<double> siemens = siemens_under(fitted_.rubber, pair);
    std::vector<double> change(siemens.size());
    std::vector<double> response(siemens.size());
    for (const std::size_t taxel : {pair.first, pair.second}) change[taxel] = siemens[taxel] * siemens[taxel];
    model_.solve(siemens);
    model_.drive_jacobian(by_drive_);
    model_.multiply_taxel_jacobian(change, response);
    double information = 0.0;
    for (const std::size_t taxel : {pair.first, pair.second}) {
      const double reading = model_.ratio()[taxel];
      const double slope = by_drive_[taxel * static_cast<std::size_t>(drives_) + line] + response[taxel];
      const double variance = noise_ * noise_ + fitted_.scatter.rubber_variance * reading * reading;
      information += std::pow(ohm_ * slope, 2) / variance;
    }
    return information;
  }

 private:
  const Estimate& fitted_;
  touch::compensation::CircuitModel& model_;
  double ohm_;  // of a parameter
  double noise_;
  Index drives_;
  std::vector<double> by_drive_;
};

/// The taxels of a driven line.
std::vector<std::size_t> taxels_of_line(const ArrayDescription& array, std::size_t line) {
  const bool columns_are_driven = array.readout.circuit == Circuit::flexitac;
  std::vector<std::size_t> taxels;
  for (std::size_t k = 0; k < array.sensed_lines(); ++k) {
    taxels.push_back(columns_are_driven ? k * array.cols + line : line * array.cols + k);
  }
  return taxels;
}

/// By how much the sum of the drivers' variances falls.
double gain(const MatrixXd& covariance, const DriverPair& pair) {
  const double variance = covariance(pair.driver, pair.driver);
  return covariance.col(pair.driver).squaredNorm() * pair.information / (1.0 + variance * pair.information);
}

}  // namespace

std::vector<PressPair> driver_presses(const LineParameters& lines, const Estimate& fitted, MatrixXd covariance,
                                      const CircuitFrames& frames) {
  Result<touch::compensation::CircuitModel> model =
      touch::compensation::CircuitModel::create(lines.array_at(fitted.parameters));
  if (!model) return {};
  PairInformation information(lines, fitted, *model, noise_of_presses(frames));
  const std::vector<double> heaviest = heaviest_loads(fitted.rubber, frames);
  std::vector<DriverPair> pairs;
  for (Index driver = 0; driver < lines.drive_count(); ++driver) {
    const std::size_t line = lines.drives()[static_cast<std::size_t>(driver)];
    for (const PressPair& pair : pairs_of_line(taxels_of_line(lines.array(), line), lines.array().cols, heaviest)) {
      pairs.push_back({pair, driver, information.of(pair, line)});
    }
  }
  std::vector<PressPair> presses;
  while (presses.size() < kPresses && !pairs.empty()) {
    const auto best = std::max_element(pairs.begin(), pairs.end(), [&](const DriverPair& a, const DriverPair& b) {
      return gain(covariance, a) < gain(covariance, b);
    });
    const VectorXd column = covariance.col(best->driver);
    const double gained = column[best->driver] * best->information;
    if (gained < 1.0) break;
    covariance -= column * column.transpose() * best->information / (1.0 + gained);
    presses.push_back(best->pair);
    pairs.erase(best);
  }
  return presses;
}

}  // namespace dermis::learn::calibration
