// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/inverted_frame.hpp"
#include "learn/calibration/circuit_fit/rubber.hpp"

namespace dermis::learn::calibration {

/// The residual of a reading in a circuit, in units of its noise, which is the same in all circuits.
struct JudgedReading {
  enum class Taxel : unsigned char { unknown, idle, crossed, pressed };  ///< crossed: idle, on a line of a pressed one.
  float square = 0.0F;           ///< Infinite: the circuit cannot give its frame.
  float variance = 1.0F;         ///< 1 and the scatter of the rubber.
  Taxel taxel = Taxel::unknown;  ///< unknown: not judged.
  /// The reading depends on the circuit. It does not for a taxel pressed alone, which the law of the taxel explains in
  /// any circuit. Nor does it where the noise hides the conductance in this circuit.
  bool depends_on_circuit = false;
};
using JudgedReadings = std::vector<JudgedReading>;  ///< [frames, taxels]

/// Sums of squares over variances; no single reading decides.
struct FrameMisfit {
  double square = 0.0;
  double readings = 0.0;
  double pressed_square = 0.0;
  double pressed_readings = 0.0;
  double crossed_square = 0.0;
  double crossed_readings = 0.0;

  FrameMisfit& operator+=(const FrameMisfit& other);
};

/// Idle taxels against their unloaded conductance, pressed ones against their laws, over all frames. `inverted`: of
/// them in `array`, whose resistances are all known.
[[nodiscard]] JudgedReadings judge_frames(const ArrayDescription& array, const Rubber& rubber, const Scatter& scatter,
                                          const InvertedFrames& inverted,
                                          const std::vector<const CircuitFrame*>& frames);

/// The misfit over all judged readings.
[[nodiscard]] FrameMisfit misfit_of(const JudgedReadings& readings);

/// The misfit over the readings that depend on both circuits, by the larger of their variances: the two compare by
/// these. Otherwise a circuit in which a reading hardly follows its taxel would look worse than one that leaves it to
/// the rubber.
[[nodiscard]] FrameMisfit misfit_beside(const JudgedReadings& readings, const JudgedReadings& other);

/// The same of circuits whose lines are not known singly. Residuals of the pressed taxels of a frame within their noise
/// and scatter do not count. Otherwise many taxels that are pressed alike would decide by the shape of their laws.
[[nodiscard]] FrameMisfit rough_misfit_beside(const JudgedReadings& readings, const JudgedReadings& other,
                                              std::size_t taxels);

}  // namespace dermis::learn::calibration
