// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/resolution.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"

namespace dermis::learn::calibration {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t kMostFrames = 12;  // that are looked at
constexpr std::uint64_t kPatternSeed = 1;
constexpr double kMostReading = 0.999;         // over the supply
constexpr double kMostNoiseShare = 1.0 / 3.0;  // three standard deviations are as much as the taxel itself

std::size_t count_pressed(const CircuitFrame& frame) {
  return static_cast<std::size_t>(
      std::count_if(frame.newtons.begin(), frame.newtons.end(), [](float newtons) { return newtons > 0.0F; }));
}

/// Random signs [rows, cols], the mean of every line taken off.
Matrix interior_pattern(std::size_t rows, std::size_t cols) {
  Random random(kPatternSeed);
  Matrix pattern(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
  for (double& value : pattern.reshaped()) value = random.below(2) == 0 ? 1.0 : -1.0;
  pattern.colwise() -= pattern.rowwise().mean().eval();
  pattern.rowwise() -= pattern.colwise().mean().eval();
  return pattern;
}

/// Conductances that would give the readings without crosstalk.
std::vector<double> apparent_siemens(const CircuitFrame& frame, double load_ohm) {
  std::vector<double> siemens;
  for (const double reading : frame.ratio) {
    const double ratio = std::clamp(reading, frame.sigma_ratio, kMostReading);
    siemens.push_back(ratio / (1.0 - ratio) / load_ohm);
  }
  return siemens;
}

/// The noise of a reading as a share of a taxel's conductance, in the frame where it is least. It matters where most
/// taxels are pressed in all frames with a load. Floating idle lines then tie all others to one potential, and a
/// reading hardly depends on its own taxel. Changes of conductance that keep the sums of all lines stand for all
/// changes. 0: there are frames with fewer pressed taxels, which any circuit resolves. Unknown drivers are taken to be
/// ideal, unknown loads to be alike.
double noise_share(const ArrayDescription& array, const CircuitFrames& frames) {
  std::vector<const CircuitFrame*> pressed;
  for (const CircuitFrame& frame : frames.frames) {
    const std::size_t count = count_pressed(frame);
    if (count == 0) continue;
    if (2 * count < array.taxel_count()) return 0.0;
    pressed.push_back(&frame);
  }
  const LineParameters lines(array);
  Result<touch::compensation::CircuitModel> model =
      touch::compensation::CircuitModel::create(lines.array_at(lines.start(lines.allows_ideal_drivers() ? 0.0 : 1.0)));
  if (!model || array.rows < 2 || array.cols < 2) return 0.0;
  const Matrix pattern = interior_pattern(array.rows, array.cols);
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> change(array.taxel_count());
  std::vector<double> response(array.taxel_count());
  for (std::size_t k = 0; k < std::min(pressed.size(), kMostFrames); ++k) {
    const CircuitFrame& frame = *pressed[k * pressed.size() / std::min(pressed.size(), kMostFrames)];
    const std::vector<double> siemens = apparent_siemens(frame, lines.reference_ohm());
    model->solve(siemens);
    for (std::size_t taxel = 0; taxel < change.size(); ++taxel) change[taxel] = siemens[taxel] * pattern.data()[taxel];
    model->multiply_taxel_jacobian(change, response);
    const double moved = Eigen::Map<const Eigen::VectorXd>(response.data(), pattern.size()).norm() / pattern.norm();
    least = std::min(least, frame.sigma_ratio / moved);
  }
  return std::isfinite(least) ? least : 0.0;
}

}  // namespace

double unresolved_share(const ArrayDescription& array, const CircuitFrames& frames) {
  if (array.readout.circuit == Circuit::none) return 0.0;
  const double share = noise_share(array, frames);
  return share > kMostNoiseShare ? share : 0.0;
}

}  // namespace dermis::learn::calibration
