// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "touch/compensation/film_follower.hpp"
#include "touch/compensation/grounded_rows_kernels.hpp"

namespace dermis::touch::compensation {

/// A film over the lines in the equations of GroundedRows, all columns loaded. Lr and Lc are the Laplacians of what it
/// conducts from row to row and from column to column. With the column matrix C = diag(1/RL + G^T 1) + Lc,
///
///   S = A + Lr - G C^-1 G^T,   y = D S^-1 G C^-1 diag(1/RL),   P = diag(RL) C
///   (a) a_i = 1 + Rd_i (sum_j G_ij + Lr_ii)
///   (b) Z = S D^-1 y = diag(a) y - (G C^-1 G^T - Lr + diag(Lr)) Rd y
///   (c) s_j = (sum_i (Z diag(RL) (diag(1/RL) + Lc))_ij) / (1 - RL_j sum_i Z_ij),   P_jj = 1 + RL_j (s_j + Lc_jj)
///   (d) G <- max(Z - f, 0) diag(P),   f_ij = sum over the neighbours j' of j of -Lc_jj' RL_j' Z_ij' / P_jj
///
/// The certificate is that of GroundedRows with R = Z - G P^-1. These functions allocate nothing.

/// The terms of the film in the state of the iteration. Many members: their symbols, and work space.
struct GroundedRowsFilm {
  GroundedRowsFilm(const FilmFollower& film_follower, std::size_t rows, std::size_t stride);

  /// `to_next` and `to_previous` of the film as it is.
  void update_flows(const GroundedRowsState& state) noexcept;

  FilmFollower follower;
  std::vector<double> to_next;      // RL_j l, from column j to the next [stride]
  std::vector<double> to_previous;  // the same to the one before [stride]
  std::vector<double> upper;        // of the elimination of P [stride]
  std::vector<double> drawn;        // G P^-1 [rows, stride]
  std::vector<double> currents;     // Z [rows, stride]
  std::vector<double> sums;         // over the rows [stride]
  std::vector<double> flow;         // through the film [stride]
  std::vector<double> ones;         // [stride]
  std::vector<double> worst;        // of the certificate [stride]
  std::vector<double> spread;       // likewise [stride]
};

/// After the sums of refresh(): (a), and G C^-1 in the place of G diag(eta).
void put_film_into_lines(GroundedRowsState& state) noexcept;

/// After `returned` of full columns: (b) and (c), and f in `returned`. Gives the certificate.
[[nodiscard]] double assess_with_film(GroundedRowsState& state) noexcept;

/// `measured` becomes the current that enters each column from the rows, y (I + diag(RL) Lc), for the estimate. It
/// stands in `currents` then.
void exchange_film_currents(GroundedRowsState& state) noexcept;

}  // namespace dermis::touch::compensation
