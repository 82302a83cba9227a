// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "dermis/touch/compensation/line_fault.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

/// Finds line faults in a stream of frames, and notices when they are gone. It knows the conductance of the unloaded
/// taxels and the noise of a reading:
///
/// silent lines, dead taxels   an unloaded taxel that works reads at least 0.3 of its unloaded value, less what the
///                             other taxels of its lines take; log-likelihood ratio against the floor of the ADC,
///                             summed over the line and the frames (Page's test), 3 frames at least; a dead taxel 12;
///                             only while most unloaded taxels elsewhere do read
/// stuck taxels                equal readings of a pressed taxel beside a noise that makes unpressed ones change, about
///                             30 times in a row; single taxels are judged 64 a frame, by turns; a dead taxel whose
///                             neighbours are pressed and that takes current from its line is stuck at 0
/// shorted lines               equal readings of both lines and of no other line, in 6 presses, each released before
///                             the next, at several places, and no frame in which they differ; in 2 presses where
///                             other lines have shown that the places of a press scatter
/// supplied lines              a column at full scale in all rows, 3 frames, or 20 different loads where loads can do
///                             that too; a row of which 3 presses, likewise, show in most rows, while others do not;
///                             2 presses where taxels scatter, or 2 frames that show the row at many places then
/// impossible readings         what the driver's current, with all readings of its line, cannot give; 10 frames
/// shorted crossings           a reading that leaves less than 10 ohm, or 1.5 % of the load, for its taxel, in
///                             10 frames, and changes as noise does;
///                             at virtual ground a saturated reading on a row that else
///                             reads nothing
/// drifting drivers            unloaded taxels that fall from one frame to the next when the current of their line
///                             rises, and rise when it falls; reported, but neither masked nor corrected
///
/// It cannot find a silent line of 16 whose unloaded taxels read below about 1.7 counts and 1.5 standard
/// deviations each (sees_silent_*). Nor can it find a short between lines that nothing presses. A taxel stuck at an
/// unloaded reading is not found either, nor one at the end of the ADC where its circuit can give that. With `circuit =
/// "none"` silent lines and taxels are judged where nothing is pressed, shorts and drivers not at all. Not thread-safe:
/// one per stream.
class LineFaultMonitor {
 public:
  /// `unloaded_siemens` [rows, cols]: conductance of the unloaded taxels [S]; 0 or less if unknown, or if the taxel is
  /// dead since calibration. The array is valid and its circuit known.
  LineFaultMonitor(const ArrayDescription& array, std::span<const double> unloaded_siemens);
  LineFaultMonitor(LineFaultMonitor&&) noexcept;
  LineFaultMonitor& operator=(LineFaultMonitor&&) noexcept;
  ~LineFaultMonitor();

  /// One frame before and after the crosstalk was solved, with the faults found so far in the model. True if faults()
  /// has changed. Allocates nothing.
  bool observe(const ConditionedFrame& conditioned, const ConductanceFrame& conductance) noexcept;

  /// The present faults, in the order in which they were found.
  [[nodiscard]] std::span<const LineFault> faults() const noexcept;

  /// Possible faults: too few presses, or all in one place. Nothing is masked for them. Allocates.
  [[nodiscard]] std::vector<LineFault> suspicions() const;

  /// The line's unloaded taxels read far enough above the noise to show its silence; false until the first frame.
  [[nodiscard]] bool sees_silent_row(std::size_t row) const noexcept;
  [[nodiscard]] bool sees_silent_column(std::size_t col) const noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::touch::compensation
