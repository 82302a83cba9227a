// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::calibration {

/// One of the circuits that `auto` chooses among.
struct CircuitCandidate {
  std::string name;  ///< "divider, idle rows floating"
  /// Root mean square of the residuals, over the noise of readings and rubber that the best circuit leaves. Infinity: a
  /// circuit that cannot give these readings, or is not resolved. Fitted with one resistance for all drivers and one
  /// for all loads, and with one for each line where circuits are nearly as good.
  double misfit = 0.0;
  bool chosen = false;
  bool indistinguishable = false;  ///< Less than a thousand to one worse than the chosen one.
  /// Where the ADC does not resolve this circuit under these loads: the noise of a reading over the conductance of its
  /// taxel. 0: it does.
  double noise_share = 0.0;
};

/// Two taxels that are to be pressed at the same time, with the same load each.
struct PressPair {
  std::size_t first = 0;
  std::size_t second = 0;
  double newtons = 0.0;
};

/// "press r2c3 and r2c7 together with 20 N each, r0c1 and r5c1 with 10 N each".
[[nodiscard]] std::string describe(const std::vector<PressPair>& presses, const ArrayDescription& array);

/// The resistances of a circuit as the calibration frames determine them.
struct CircuitFit {
  ArrayDescription array;  ///< Nothing is unknown any more.
  /// Relative standard errors of drive_ohm and load_ohm (1: nothing is known); 0 where the value was given. They hold
  /// the assumptions of docs/reasons/circuit-fit.md.
  std::vector<double> drive_error;
  std::vector<double> load_error;
  double common_drive_error = 0.0;  ///< Relative error of the mean of the fitted drivers.
  double rubber_scatter = 0.0;      ///< Relative scatter of a press about the law of its taxel, found with the circuit.
  std::size_t frames = 0;           ///< Frames the fit used, after repeated ones were averaged.
  std::vector<CircuitCandidate> candidates;       ///< Of `auto`; empty otherwise.
  std::vector<PressPair> discriminating_presses;  ///< Would distinguish the remaining circuits; at most 5.
  std::vector<PressPair> driver_presses;          ///< Would determine drivers that are uncertain; at most 5.
  std::vector<std::string> statements;            ///< The findings and what the data cannot determine, in plain words.
};

/// Finds the resistances that are kFitOhm, and the circuit where it is Circuit::automatic, from labelled frames: single
/// presses, several at once or uniform loads, mixed. For each trial of the resistances every frame is inverted. An
/// untouched taxel must then keep its conductance, whatever presses beside it. A pressed one must follow one smooth law
/// of force and temperature in all frames. Gauss-Newton on what is left, the laws of the taxels eliminated (variable
/// projection, Golub and Pereyra 1973). Deterministic, whatever the number of threads. A circuit that the ADC does not
/// resolve under these loads, also a known one, becomes Circuit::none. Errors: those of build_sample_database() that
/// concern frames and loads; no pressed frame.
[[nodiscard]] Result<CircuitFit> fit_circuit(const ArrayDescription& array, std::span<const RawFrame> frames,
                                             std::span<const Load> loads, Nanos settle_time = Nanos{0});

}  // namespace dermis::learn::calibration
