// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::learn::calibration {

/// The loads' geometric mean where no resistance is known [ohm].
inline constexpr double kNominalLoadOhm = 1000.0;

/// All drivers or all loads of an array.
struct LineGroup {
  Eigen::VectorXd values;                ///< In the units of the parameters.
  std::vector<Eigen::Index> parameters;  ///< Of each line; -1: given.
  double unit = 1.0;                     ///< The unit of a relative spread of 1.
};

/// The inversion of idle rows that float takes longer than that of others.
[[nodiscard]] bool is_inverted_slowly(const ArrayDescription& array);

/// The unknown resistances of an array as parameters of a fit. Drivers are multiples of a reference resistance, so that
/// 0 ohm is a value like any other; loads are logarithms. Drivers come first.
class LineParameters {
 public:
  /// A resistance of kFitOhm is unknown.
  explicit LineParameters(const ArrayDescription& array);

  [[nodiscard]] const ArrayDescription& array() const { return array_; }
  [[nodiscard]] Eigen::Index count() const { return drive_count() + load_count(); }
  [[nodiscard]] Eigen::Index drive_count() const { return static_cast<Eigen::Index>(drives_.size()); }
  [[nodiscard]] Eigen::Index load_count() const { return static_cast<Eigen::Index>(loads_.size()); }
  [[nodiscard]] const std::vector<std::size_t>& drives() const { return drives_; }  ///< Lines of the parameters.
  [[nodiscard]] const std::vector<std::size_t>& loads() const { return loads_; }
  /// A resistance is given.
  [[nodiscard]] bool has_absolute() const { return known_drive_ohm_ > 0.0 || known_load_ohm_ > 0.0; }
  [[nodiscard]] double reference_ohm() const { return reference_ohm_; }

  /// start(0) exists: the loads' scale need not come from a known driver.
  [[nodiscard]] bool allows_ideal_drivers() const { return known_drive_ohm_ == 0.0; }

  /// All drivers, or all loads, in the same ratio to each other.
  [[nodiscard]] Eigen::VectorXd start(double common_ratio) const;

  /// parameters + step, each within a reach in which the circuit is about linear.
  [[nodiscard]] Eigen::VectorXd moved(const Eigen::VectorXd& parameters, const Eigen::VectorXd& step) const;

  [[nodiscard]] ArrayDescription array_at(const Eigen::VectorXd& parameters) const;
  [[nodiscard]] LineGroup all_drives(const Eigen::VectorXd& parameters) const;
  [[nodiscard]] LineGroup all_loads(const Eigen::VectorXd& parameters) const;

 private:
  ArrayDescription array_;
  std::vector<std::size_t> drives_;
  std::vector<std::size_t> loads_;
  double known_drive_ohm_ = 0.0;  // geometric means; 0: none
  double known_load_ohm_ = 0.0;
  double reference_ohm_ = kNominalLoadOhm;
};

}  // namespace dermis::learn::calibration
