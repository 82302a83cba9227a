// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "touch/compensation/film_terms.hpp"

namespace dermis::touch::compensation {

/// The columns in the equations of film_terms.hpp. These functions allocate nothing.

/// Follows the conductances of the film from column to column.
void follow_film(GroundedRowsFilm& film) noexcept;

/// P of the sums of the columns, its pivots, and b. Nothing is subtracted.
void factorise_columns(GroundedRowsFilm& film) noexcept;

/// u, and the next P_jj.
void find_columns(const GroundedRowsState& state, std::vector<double>& diagonal) noexcept;

/// u and P_jj of readings that rows do not take from each other.
void estimate_columns(GroundedRowsState& state) noexcept;

/// u P_jj, and what u Z of its neighbours enters each column by.
void weigh_columns(GroundedRowsFilm& film) noexcept;

/// `matrix` [cols, stride] becomes C^-1 of it.
void divide_by_columns(const GroundedRowsState& state, std::vector<double>& matrix) noexcept;
void divide_by_columns(const GroundedRowsState& state, std::vector<float>& matrix) noexcept;

/// `row` P^-1 in its place [stride].
void divide_row(const GroundedRowsFilm& film, std::vector<double>& row) noexcept;

/// P^-1 `column` in its place [stride].
void divide_column(const GroundedRowsFilm& film, std::vector<double>& column) noexcept;

}  // namespace dermis::touch::compensation
