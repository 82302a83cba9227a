// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "learn/calibration/instrument/proof.hpp"

namespace dermis::learn::calibration {

/// In what an instrument is not as its description says, and what is left.
struct InstrumentFit {
  ArrayDescription array;               ///< With what was found.
  std::vector<std::string> statements;  ///< What was found, a sentence each.
  std::vector<std::string> doubts;      ///< Parts that are not as described and stay so, a sentence each.
  /// By how much any force may be off beyond what a calibration says, relative, as presses on several taxels tell
  /// (Proof::unexplained_share()). 0: they agree, or there are none.
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

/// Applies those findings of find_instrument() with which whole calibrations do better on presses that they have not
/// seen (Proof). Drivers are named, not changed: the description gives them. All resistances of `array` are known.
/// `is_asked_for`: a sentence says so where nothing can be determined.
[[nodiscard]] InstrumentFit judge_instrument(const ArrayDescription& array, const Trainable& trainable,
                                             bool is_asked_for);

/// Whether another circuit explains the frames better, with all that was found of the instrument. Where presses on
/// several taxels tell, it is named if whole calibrations do better with it. Errors that they leave are doubted in any
/// case.
void doubt_circuit(const Trainable& trainable, InstrumentFit& instrument);

}  // namespace dermis::learn::calibration
