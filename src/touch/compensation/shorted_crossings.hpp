// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "touch/compensation/grounded_rows_kernels.hpp"

namespace dermis::touch::compensation {

/// Shorted crossings in the equations of GroundedRows. Where row k and column J touch they are one node. It has the
/// driver of k and, if all columns are loaded, the load of J. So J is no column any more: its taxels G_iJ lead from row
/// i to row k. With t = y_J RL_J, the node's voltage,
///
///   S = A - G diag(eta) G^T - C,   eta_J = 0,   C_ik = C_ki = G_iJ,   A_kk with 1/RL_J where all are loaded
///   (b) of rows i and k:  Z_ij less G_iJ Rd_k y_kj,   Z_kj less sum_i G_iJ Rd_i y_ij
///   (c) of column J:      S D^-1 t = e_k  gives  G_iJ = Z_iJ / (Rd_k y_kJ),   i other than k
///
/// The one reading too many, t_k, is not used elsewhere. Where one column is loaded, the readings of J are first made
/// those without its load: y / (1 - Rd_k y_kJ). In the state's matrices G_kJ is all that leaves the node but for the
/// driver and the taxels of row k, so that (a) holds. Two columns that touch one row determine only the sum of their
/// taxels; it stands in the first. These functions allocate nothing.

/// Readings of one loaded column become those without its load.
void take_loads_away(GroundedRowsState& state) noexcept;

/// The estimate, which took the columns for columns.
void estimate_with_shorted(GroundedRowsState& state) noexcept;

/// G_kJ, before the sums over the rows.
void add_up_nodes(GroundedRowsState& state) noexcept;

/// eta_J = 0, and Rd_k y_kJ in the place of w_J.
void take_columns_away(GroundedRowsState& state) noexcept;

/// C in (b); what has no equation of its own is made to fit.
void return_through_nodes(GroundedRowsState& state) noexcept;

/// (c) of the columns J.
void scale_shorted_columns(GroundedRowsState& state) noexcept;

}  // namespace dermis::touch::compensation
