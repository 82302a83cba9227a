// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <span>

#include "dermis/touch/frames/film.hpp"

namespace dermis::learn::simulation {

using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// An array as its electronics see it: conductances between its terminals [terminal, terminal] [S]. The driven lines
/// come first, then the sensed lines; symmetric, the diagonal has no meaning.
using TerminalNetwork = Table;

/// A film between neighbouring taxels [S]; empty tables: there is none.
struct FilmTables {
  Table along_sensed;  ///< Between driven lines i and i + 1 [driven - 1, sensed].
  Table along_driven;  ///< Between sensed lines j and j + 1 [driven, sensed - 1].
};

/// `newtons`: on the taxels [driven, sensed].
[[nodiscard]] FilmTables film_tables(const Film& film, const Table& newtons);

/// Lines without resistance; `taxels`: conductances [driven, sensed] [S].
[[nodiscard]] TerminalNetwork lumped_network(const Table& taxels, const FilmTables& film);

/// Lines with a resistance from one taxel to the next [ohm], one value a line, >= 0; an empty list: none at all. The
/// terminal of a driven line is at the taxel of sensed line 0. That of a sensed line is at the taxel of driven line 0.
[[nodiscard]] TerminalNetwork resistive_network(const Table& taxels, std::span<const double> driven_segment_ohm,
                                                std::span<const double> sensed_segment_ohm, const FilmTables& film);

/// The electronics at the terminals. The cases share the resistors and differ in the sources.
struct Electronics {
  Eigen::ArrayXd series_ohm;  ///< [terminal], from each to its source; 0: it is at the source; infinite: nothing there.
  Table source_v;             ///< [terminal, case] [V]
  Table current_a;            ///< [terminal, case], driven into the terminal beside that [A]
};

struct Solution {
  Table voltage_v;  ///< [terminal, case]; above 1e99 where a current enters lines that nothing connects to a source.
  Table sunk_a;     ///< [terminal, case], through the series resistor into the source
};

/// Kirchhoff's current law at all terminals. Nothing is subtracted where sources and currents are >= 0 and no source is
/// above 0 V where `sunk_a` is wanted. So every voltage and current then is right to some roundings of its own size,
/// however small it is beside the others.
[[nodiscard]] Solution solve(TerminalNetwork network, const Electronics& electronics);

}  // namespace dermis::learn::simulation
