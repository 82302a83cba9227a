// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/instrument/instrument_parameters.hpp"

namespace dermis::learn::calibration {

/// Parts of an instrument at the values that explain presses best.
struct InstrumentFinding {
  std::vector<InstrumentPart> parts;
  ArrayDescription array;
  std::vector<std::string> sentences;  ///< [parts]
  double loss_by_drivers = 0.0;        ///< Relative, of one of two equal presses in a row, for the heaviest.
  /// Idle taxels on pressed lines differ by noise alone with the last part, and by clearly more without it.
  bool explains_idle = false;
};

struct InstrumentFindings {
  std::vector<InstrumentFinding> found;  ///< Each has a part more than the one before.
  bool disagree = false;                 ///< Presses on several taxels differ from single ones by more than chance.
  bool lacks_presses = false;            ///< Fewer than eight on several taxels tell nothing.
};

/// Presses on several taxels must give the forces that single presses have taught. They may show offset and curve of
/// the ADC, and resistance of the supply and of the drivers. Each kind that the description leaves open is fitted by
/// Gauss-Newton. The kind that explains most is taken, then the next beside it, as long as chance would not explain as
/// much. Idle taxels on pressed lines add to this, but without eight presses on several taxels nothing is fitted:
/// temperature and material move idle taxels, too. All resistances of `array` are known.
[[nodiscard]] InstrumentFindings find_instrument(const ArrayDescription& array, const CircuitFrames& frames);

/// These parts by other frames. Empty: they cannot be fitted, or are too large for any instrument.
[[nodiscard]] std::optional<InstrumentFinding> refit_instrument(const ArrayDescription& array,
                                                                const std::vector<InstrumentPart>& parts,
                                                                const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
