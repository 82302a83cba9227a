// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

/// The kinds of fault that readings alone can show.
enum class LineFaultKind {
  silent_row,          ///< Open or shorted to 0 V: nothing arrives from the row.
  silent_column,       ///< The same of a column.
  supplied_row,        ///< Shorted to the supply: every scan also holds its readings.
  supplied_column,     ///< Shorted to the supply: it reads full scale whatever is pressed.
  shorted_rows,        ///< Shorted to the next row: both read their sum.
  shorted_columns,     ///< Shorted to the next column.
  stuck_taxel,         ///< Its reading stays the same, noise included.
  dead_taxel,          ///< Reads less than an unloaded taxel can.
  shorted_crossing,    ///< Row and column of a taxel touch there and are one line.
  impossible_reading,  ///< A taxel reads more than the circuit can give.
  drifting_driver,     ///< The resistance of a driver has risen: the whole line sags with its own current.
};

/// The effect of a fault, wherever it is.
enum class LineFaultEffect { silent, supplied, shorted, stuck, dead, crossed, impossible, drifting };

/// The place of a fault.
enum class LineFaultScope { line, line_pair, taxel, driver };

/// The traits of all faults of a kind.
struct LineFaultTraits {
  const char* name = "";  ///< "silent_row", ...
  LineFaultEffect effect = LineFaultEffect::silent;
  LineFaultScope scope = LineFaultScope::line;
  std::optional<Axis> axis;        ///< Axis of the line or lines; empty for taxels and drivers.
  bool hides_conductance = false;  ///< No reading determines the conductance of the masked taxels.
};

[[nodiscard]] const LineFaultTraits& traits_of(LineFaultKind kind) noexcept;

struct LineFault {
  LineFaultKind kind = LineFaultKind::silent_row;
  std::size_t place = 0;   ///< Row or column (the first of two), driven line, or row-major taxel.
  std::size_t frame = 0;   ///< First frame in which it showed, counted from 0.
  Nanos time{};            ///< Time of that frame.
  double drive_ohm = 0.0;  ///< drifting_driver: its resistance now [ohm].
  /// Silent lines and dead taxels: log-likelihood ratio of a short to 0 V, or of a taxel that conducts, against an open
  /// one. The least is -30 (for lines, the most is 30). Both read the same, but draw different currents from the other
  /// lines when they are pressed. 0 until then.
  double ground_evidence = 0.0;
  bool grounded = false;  ///< Taken to be shorted to 0 V, not open: from evidence 10 until it has fallen to -10.
};

/// "silent_row", ...
[[nodiscard]] const char* to_string(LineFaultKind kind) noexcept;

/// "row 3", "columns 4 and 5", "taxel r3c5", "driver of row 3".
[[nodiscard]] std::string place_name(const LineFault& fault, const ArrayDescription& array);

/// A row that touches a column at virtual ground stands at 0 V, so that its taxels read nothing.
[[nodiscard]] bool silences_row(const LineFault& fault, const ArrayDescription& array) noexcept;

/// Number of taxels that a fault masks: all on the faulty lines, or the faulty one. A drifting driver masks none and is
/// only reported, because a wrong suspicion must not cost taxels.
[[nodiscard]] std::size_t masked_taxel_count(const LineFault& fault, const ArrayDescription& array) noexcept;

}  // namespace dermis::touch::compensation
