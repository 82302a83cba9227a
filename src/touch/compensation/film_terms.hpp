// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "touch/compensation/film_follower.hpp"
#include "touch/compensation/grounded_rows_kernels.hpp"

namespace dermis::touch::compensation {

/// A film over the lines in the equations of GroundedRows. Lr and Lc are the Laplacians of what it conducts from row to
/// row and from column to column. With the column matrix C = diag(1/RL + G^T 1) + Lc (one loaded: without 1/RL)
///
///   S = A + Lr - G C^-1 G^T,   y = D S^-1 G P^-1 diag(1/u)
///   all loaded:  P = diag(RL) C,  u_j = 1
///   one loaded:  P = C,  u_j = (RL_j + b_j) / (1 - d_j),  b_j = (C^-1)_jj,  d_j = sum_i (G C^-1)_ij Rd_i y_ij
///   (a) a_i = 1 + Rd_i (sum_j G_ij + Lr_ii)
///   (b) Z = S D^-1 y = diag(a) y - (G C^-1 G^T - Lr + diag(Lr)) Rd y
///   (c) all loaded:  s_j = (sum_i (Z diag(RL) (diag(1/RL) + Lc))_ij) / (1 - RL_j sum_i Z_ij)
///       one loaded:  u_j = 1 / sum_i Z_ij, as the columns of G C^-1 sum to 1; it tells b, and b the sums s of columns
///       P_jj = 1 + RL_j (s_j + Lc_jj); one loaded: s_j + Lc_jj
///   (d) G <- max(Z - f, 0) diag(u_j P_jj),   f_ij = sum over the neighbours j' of j of -P_j'j u_j' Z_ij' / (u_j P_jj)
///
/// (c): d b_j / d s_k = -(C^-1)_jk^2. An element of C^-1 beside the diagonal is a product of one factor for each pair
/// of neighbours between. So are the squares: their inverse has three diagonals, and Newton's step is by them.
///
/// Certificate. With E = Z diag(u) P - G it is that of GroundedRows, R = E P^-1. As P^-1 >= 0, |R| is at most |E| P^-1,
/// of sums over the rows. With one load u also differs from what it is at G, by b less the b that it tells. That is
///
///   |y - y(G)|_kj <= (1 + max(Rd)/RL_j) (2 sum_i |E P^-1|_ij + |b_j - b_j(u)| / (RL_j + b_j)) / u_j
///
/// These functions allocate nothing.

/// The terms of the film in the state of the iteration. Many members: their symbols, and work space.
struct GroundedRowsFilm {
  GroundedRowsFilm(const FilmFollower& film_follower, const GroundedRowsState& state);

  FilmFollower follower;
  Precision precision = Precision::full;  // of the film
  bool one_loaded;
  std::vector<double> scale;         // of C in P: RL, or 1 [stride]
  std::vector<double> to_next;       // -P from column j to the next [stride]
  std::vector<double> to_previous;   // the same to the one before [stride]
  std::vector<double> column_sum;    // G^T 1 [stride]
  std::vector<double> diagonal;      // of P [stride]
  std::vector<double> part;          // 1 / the pivots of P [stride]
  std::vector<double> inverse;       // b [stride]
  std::vector<double> currents;      // Z, with one number before and one behind [rows, stride]
  std::vector<double> last_siemens;  // G before it was hastened [rows, stride]
  std::vector<double> last_step;     // to that [rows, stride]
  bool has_last_step = false;
  std::vector<double> sums;          // of Z over the rows [stride]
  std::vector<double> weights;       // of Z where it is positive [stride]
  std::vector<double> drops;         // of that and Rd y [stride]
  std::vector<double> unit;          // u [stride]
  std::vector<double> kept_shares;   // of G C^-1 over the taxels without a reading [stride]
  std::vector<double> kept_sums;     // of their Z [stride]
  std::vector<double> kept_changes;  // of their Z in a step
  std::vector<double> own;           // u P_jj [stride]
  std::vector<double> from_left;     // to_next u of the column before [stride]
  std::vector<double> from_right;    // to_previous u of the column behind [stride]
  std::vector<double> doubt;         // of u in the certificate [stride]
  std::vector<double> worst;         // |E| over the rows, likewise [stride]
  std::vector<double> spread;        // likewise [stride]
  std::vector<double> work;          // [stride]
  std::vector<double> line_part;     // of the elimination of rows [rows]
};

/// After the sums of refresh(): (a), and P.
void put_film_into_lines(GroundedRowsState& state) noexcept;

/// After `returned` of full columns: (b) and (c), and f in `returned`. Gives the certificate.
[[nodiscard]] double assess_with_film(GroundedRowsState& state) noexcept;

/// G that followed `from` becomes the one that two steps tell, were they linear (Anderson's mixing of depth 1).
void hasten_with_film(GroundedRowsState& state, const std::vector<double>& from) noexcept;

/// `estimate` of the readings.
void estimate_with_film(GroundedRowsState& state) noexcept;

/// G C^-1 in the place of G diag(eta), and what a column makes of Z in that of w, for the noise.
void shunt_with_film(GroundedRowsState& state) noexcept;

/// Potentials of the rows by these currents into them, the columns at 0 V; in their place [rows].
void find_lines_with_film(GroundedRowsState& state, std::vector<double>& currents) noexcept;

}  // namespace dermis::touch::compensation
