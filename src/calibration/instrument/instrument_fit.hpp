// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/loads.hpp"
#include "dermis/core/result.hpp"

namespace dermis::calibration {

/// In what an instrument is not as its description says, and what is left.
struct InstrumentFit {
  ArrayDescription array;               ///< With what was found.
  std::vector<std::string> statements;  ///< What was found, a sentence each.
  std::vector<std::string> doubts;      ///< Parts that are not as described and stay so, a sentence each.
  /// The relative difference of presses on several taxels from single ones, beyond chance and beyond all that was
  /// found. 0: they agree, or there are none.
  double unexplained = 0.0;
  /// Too few presses on several taxels show whether the instrument is as described.
  bool lacks_proof = false;
};

/// The description says "fit" of its ADC or its supply.
[[nodiscard]] bool asks_for_instrument(const Readout& readout);

/// Offset and supply that are to be fitted are left out.
[[nodiscard]] ArrayDescription without_unknown_instrument(ArrayDescription array);

/// Sets a settling that the description leaves open to the measured one of single presses (measure_settling()), or to
/// none.
[[nodiscard]] InstrumentFit fit_settling(const ArrayDescription& array, std::span<const RawFrame> frames,
                                         std::span<const Load> loads);

/// Presses on several taxels must give the forces that single presses have taught. They may show offset and curve of
/// the ADC, and resistance of the supply and of the drivers. Each kind that the description leaves open is fitted by
/// Gauss-Newton. The kind that explains most is taken, then the next beside it, as long as chance would not explain as
/// much. Idle taxels on pressed lines add to this, but without eight presses on several taxels nothing is fitted:
/// temperature and material move idle taxels, too. Drivers are named, not changed: the description gives them. `array`
/// has a circuit whose resistances are known. `is_asked_for`: a sentence says so where nothing can be determined.
/// Errors: those of circuit_frames(), a circuit that cannot be inverted.
[[nodiscard]] Result<InstrumentFit> fit_instrument(const ArrayDescription& array, std::span<const RawFrame> frames,
                                                   std::span<const Load> loads, Nanos settle_time, bool is_asked_for);

}  // namespace dermis::calibration
