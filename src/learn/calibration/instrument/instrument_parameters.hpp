// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/inverted_frame.hpp"

namespace dermis::learn::calibration {

/// The parts of an instrument that may be wrong.
enum class InstrumentPart { offset, supply, curve, drivers };

/// The numbers of some parts, each on the scale of its usual size: [counts], [share of the mean load] and [share of the
/// full scale]. Drivers have one number a driven line, their ohms over the mean load.
class InstrumentParameters {
 public:
  InstrumentParameters(const ArrayDescription& array, std::vector<InstrumentPart> parts);

  [[nodiscard]] const std::vector<InstrumentPart>& parts() const noexcept { return parts_; }
  [[nodiscard]] Eigen::Index count() const noexcept { return count_; }
  /// The first parameter of a part, and how many it has.
  [[nodiscard]] Eigen::Index first_of(std::size_t place) const;
  [[nodiscard]] Eigen::Index size_of(std::size_t place) const;
  /// Standard deviations of what instruments are like [count()].
  [[nodiscard]] Eigen::VectorXd usual() const;
  /// Steps of finite differences [count()].
  [[nodiscard]] Eigen::VectorXd steps() const;
  /// Without what no instrument has: resistances below 0, and parts of more than three times their usual size.
  [[nodiscard]] Eigen::VectorXd possible(Eigen::VectorXd values) const;
  /// No part is as large as that.
  [[nodiscard]] bool are_within_bounds(const Eigen::VectorXd& values) const;
  [[nodiscard]] ArrayDescription array_at(const Eigen::VectorXd& values) const;
  /// The conductances that these frames of `array` have then. Errors: a circuit that cannot be inverted.
  [[nodiscard]] Result<InvertedFrames> invert(const std::vector<const CircuitFrame*>& frames,
                                              const Eigen::VectorXd& values) const;

 private:
  template <typename Visit>
  void visit_parts(const Visit& visit) const;
  [[nodiscard]] CircuitFrame corrected(const CircuitFrame& frame, const Eigen::VectorXd& values) const;

  ArrayDescription array_;
  std::vector<InstrumentPart> parts_;
  Eigen::Index count_ = 0;
  double load_ohm_;  // the mean
};

}  // namespace dermis::learn::calibration
