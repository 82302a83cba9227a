// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <span>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"

namespace dermis::compensation {

/// Inverts one kind of readout circuit: readings with crosstalk -> the conductance of every taxel. A new circuit is a
/// new class behind make_crosstalk_inversion(); the pipeline does not change. Not thread-safe: one per thread.
class CrosstalkInversion {
 public:
  CrosstalkInversion() = default;
  CrosstalkInversion(const CrosstalkInversion&) = delete;
  CrosstalkInversion& operator=(const CrosstalkInversion&) = delete;
  virtual ~CrosstalkInversion() = default;

  /// ratio [rows, cols] (reading / supply) -> siemens [rows, cols]. A reading below what the neighbours alone explain
  /// gives a small negative conductance: noise stays unbiased. Returns false where the readings have no solution in
  /// this circuit; `siemens` then holds the best attempt. Allocates nothing.
  [[nodiscard]] virtual bool invert(std::span<const double> ratio, std::span<double> siemens) noexcept = 0;

  /// Rise of an unloaded taxel's conductance for a rise of its ratio [S], the largest of all columns: what the noise of
  /// a reading becomes.
  [[nodiscard]] virtual double siemens_per_ratio() const noexcept = 0;
};

/// The inversion for the array's circuit. Errors: a circuit that cannot be inverted yet.
[[nodiscard]] Result<std::unique_ptr<CrosstalkInversion>> make_crosstalk_inversion(const ArrayDescription& array);

/// Unit 3 of the paper, the Compensation Unit: data "that deviate from the actual values by a known relationship" are
/// put right by that relationship. Not thread-safe: one per stream.
class Compensator {
 public:
  [[nodiscard]] static Result<Compensator> create(const ArrayDescription& array);

  /// Allocates nothing once `conductance` has the array's size.
  void process(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept;

  [[nodiscard]] double siemens_per_ratio() const noexcept { return inversion_->siemens_per_ratio(); }

 private:
  explicit Compensator(std::unique_ptr<CrosstalkInversion> inversion) : inversion_(std::move(inversion)) {}
  std::unique_ptr<CrosstalkInversion> inversion_;
};

}  // namespace dermis::compensation
