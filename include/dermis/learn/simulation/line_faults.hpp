// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {
class ConfigFile;
}

namespace dermis::learn::simulation {

/// Rows or columns that are broken, numbered from 0.
struct BrokenLines {
  std::vector<std::size_t> open;      ///< The wire between a line and its driver or load is broken: it floats.
  std::vector<std::size_t> grounded;  ///< Shorted to 0 V.
  std::vector<std::size_t> supplied;  ///< Shorted to the supply.
  std::vector<std::size_t> shorted;   ///< Line k is shorted to line k + 1.
};

/// The defects of a simulated array, and their times.
struct LineFaults {
  BrokenLines rows;                         ///< In files "open_rows", "grounded_rows" and so on.
  BrokenLines columns;                      ///< The same.
  std::vector<std::string> dead_taxels;     ///< "r3c5": no contact at the crossing, 0 S.
  std::vector<std::string> stuck_taxels;    ///< "r3c5": the reading does not change.
  double stuck_ratio = 0.25;                ///< Reading of the stuck taxels over the supply, without noise, 0 ... 1.
  std::vector<std::string> shorted_taxels;  ///< "r3c5": row 3 and column 5 touch there, they are one line.
  std::vector<std::size_t> drifting_rows;   ///< The driver's resistance rises (the driver of a column in `flexitac`)
  double drift_ohm = 0.0;                   ///< by this in the end [ohm], >= 0,
  std::size_t drift_frames = 0;             ///< linearly over so many frames; 0: at once.

  std::size_t from_frame = 0;                                         ///< First frame with the faults.
  std::size_t until_frame = std::numeric_limits<std::size_t>::max();  ///< First frame without them again.

  /// There is a fault at all.
  [[nodiscard]] bool any() const noexcept;

  /// Names the first field that does not suit the array, as "faults.open_rows: ...".
  [[nodiscard]] Status validate(const ArrayDescription& array) const;
};

/// Reads the table [faults]; keys are the field names, with "open_rows" for rows.open.
void read_line_faults(bytes::files::ConfigFile& file, LineFaults& faults);

/// Readings of an array with faults, [rows, cols] over the supply, `frame` frames after the first of the recording.
/// Kirchhoff's current law holds at every line; each scan is its own system. Shorts have no resistance. Conventions are
/// those of ReadoutCircuit. A column at virtual ground that is shorted to the supply reads beyond any ADC. Thread-safe.
class FaultyCircuit {
 public:
  /// Errors: faults that do not suit the array; resistive lines, column switches and real amplifiers.
  [[nodiscard]] static Result<FaultyCircuit> create(const ArrayDescription& array, const LineFaults& faults);

  /// Stuck taxels still have the reading of the circuit here: see stick().
  void ratios(std::span<const double> siemens, std::size_t frame, std::span<double> ratio) const;

  /// The same where the taxels are under these forces [rows, cols], which Readout::film follows. Without them the film
  /// is unloaded.
  void ratios(std::span<const double> siemens, std::span<const double> newtons, std::size_t frame,
              std::span<double> ratio) const;

  /// Overwrites the counts of the stuck taxels, after the ADC.
  void stick(std::span<float> counts) const;

  /// The faults are there in this frame.
  [[nodiscard]] bool present(std::size_t frame) const noexcept {
    return frame >= faults_.from_frame && frame < faults_.until_frame;
  }

 private:
  FaultyCircuit(const ArrayDescription& array, const LineFaults& faults);

  ArrayDescription array_;
  LineFaults faults_;
  std::vector<std::size_t> dead_taxels_;   // row-major indices
  std::vector<std::size_t> stuck_taxels_;  // row-major indices
};

}  // namespace dermis::learn::simulation
