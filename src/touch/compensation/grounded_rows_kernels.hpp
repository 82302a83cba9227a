// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "touch/compensation/film_follower.hpp"

namespace dermis::touch::compensation {

struct GroundedRowsFilm;

inline constexpr double kLeastSiemens = 1e-12;  ///< In logarithms, held at 0 below.

/// Of a driver or a load that is not connected.
inline constexpr double kOpenOhm = 1e9;

/// The state of the iteration of GroundedRows; grounded_rows.hpp explains the symbols. Matrices are [rows, stride],
/// row-major: zeros fill up the columns to whole SIMD vectors. Many members: the symbols of formula (4), of the
/// circuit, the frame and the iterate.
struct GroundedRowsState {
  /// A taxel without a reading, whose conductance is given.
  struct KeptTaxel {
    std::size_t row;
    std::size_t col;
    double siemens;
  };

  /// A row and a column that touch: one node (shorted_crossings.hpp).
  struct ShortedCrossing {
    std::size_t row;
    std::size_t col;
    bool is_second;  ///< The second one of its row: its conductances are in the column of the first.
  };

  /// The factors of `returned`, and itself.
  struct SinglePrecision {
    SinglePrecision(std::size_t size, std::size_t coupling_size);

    std::vector<float> dropped;
    std::vector<float> shunted;
    std::vector<float> siemens;
    std::vector<float> coupling;
    std::vector<float> returned;
  };

  GroundedRowsState(std::size_t row_count, std::size_t col_count, IdleColumns columns);

  std::size_t rows;
  std::size_t cols;
  std::size_t stride;
  IdleColumns idle_columns;

  // The circuit.
  std::vector<double> drive_ohm;          // Rd [rows]
  std::vector<double> column_ohm;         // RL [stride]
  std::vector<double> certificate_ratio;  // Ratio per bound on D S^-1 R [stride]
  std::vector<ShortedCrossing> shorted;   // at most one a column

  // The frame.
  std::vector<double> measured;   // y
  std::vector<double> explained;  // y', above y where a taxel is held at 0 S
  std::vector<double> dropped;    // Rd y'
  std::vector<double> estimate;   // G by the textbook, from y alone
  std::vector<KeptTaxel> kept;
  std::vector<double> kept_siemens;  // sums over the columns [stride]
  std::vector<double> kept_drawn;    // Z of them, likewise [stride]

  // The iterate.
  std::vector<double> siemens;   // G
  std::vector<double> shunted;   // G diag(eta)
  std::vector<double> coupling;  // diag(eta) G^T Rd y' [cols, stride]
  std::vector<double> returned;  // G diag(eta) G^T Rd y'
  SinglePrecision single;
  std::vector<double> line_gain;     // a [rows]
  std::vector<double> line_part;     // 1 / a [rows]
  std::vector<double> noise_gain;    // square of the diagonal of S D^-1 [rows]
  std::vector<double> column_part;   // w [stride]
  std::vector<double> column_scale;  // From Z to the next G [stride]

  std::shared_ptr<GroundedRowsFilm> film;  // the terms of a film over the lines (film_terms.hpp); null: there is none
};

/// `estimate` of the readings: exact for ideal drivers, and for columns at 0 V.
void estimate_from_readings(GroundedRowsState& state) noexcept;

/// Starts at the estimate, no taxel held.
void start_cold(GroundedRowsState& state) noexcept;

/// Starts at the solution that `state` holds, moved by what the estimate has changed; `last_estimate` was its own.
void start_warm(GroundedRowsState& state, const std::vector<double>& last_estimate) noexcept;

/// Equations (b) and (c) at the present G; gives its certificate, as a ratio, and prepares advance(). The readings of
/// kept taxels become what these draw. In single precision the certificate is right to about 1e-5.
[[nodiscard]] double assess(GroundedRowsState& state, Precision precision) noexcept;

/// Equations (d) and (e): the next G and y' after G was `from`.
void advance(GroundedRowsState& state, const std::vector<double>& from) noexcept;

/// Standard deviation of G [rows, cols] from that of y, `sigma` [stride]; see GroundedRows::propagate_noise.
void spread_noise(GroundedRowsState& state, const std::vector<double>& sigma, std::span<double> out) noexcept;

/// ln G where a mixed iteration starts at `siemens`.
void start_mixing(const std::vector<double>& siemens, std::vector<double>& log_siemens) noexcept;

/// G and y' of ln G, to be refreshed.
void take_mixed_step(GroundedRowsState& state, const std::vector<double>& log_siemens) noexcept;

/// The change of ln G by (d), of each at most ln 10; false: some want more. assess() comes before.
[[nodiscard]] bool find_log_step(GroundedRowsState& state, std::vector<double>& log_step) noexcept;

/// After a change of G or y' from outside, which keeps what is kept.
void refresh(GroundedRowsState& state) noexcept;

}  // namespace dermis::touch::compensation
