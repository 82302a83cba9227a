// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "touch/compensation/anderson_mixing.hpp"
#include "touch/compensation/driver_error.hpp"
#include "touch/compensation/film_terms.hpp"
#include "touch/compensation/grounded_rows_kernels.hpp"
#include "touch/compensation/step_budget.hpp"

namespace dermis::touch::compensation {

/// Circuits whose idle rows are grounded through their drivers and whose columns end in resistors RL to ground. Either
/// all columns are loaded at once or only the one that is read (IdleColumns). With y_kj the current into the load of
/// column j while row k is driven, over the supply [S], formula (1) of docs/reasons/derivations-circuits.md reads
///
///   y = D S^-1 G diag(w),   S = A - G diag(eta) G^T,   D = diag(1/Rd),   A = D + diag(G 1)
///   all loaded:  eta_j = RL_j w_j,         w_j = 1 / (1 + RL_j sum_i G_ij)
///   one loaded:  eta_j = 1 / sum_i G_ij,   w_j = (1 - sum_i G_ij Rd_i y_ij / sum_i G_ij) / (1 + RL_j sum_i G_ij)
///
/// (one loaded: T_kj = D_k K_jk / (1 + K_jj/RL_j), K the resistances of the unloaded circuit). G is the fixed point of
/// (4), which inverts no matrix and, written with Rd, also holds for ideal drivers:
///
///   (a)  a = 1 + Rd . G 1
///   (b)  Z = S D^-1 y = diag(a) y - G diag(eta) G^T diag(Rd) y
///   (c)  all loaded:  s_j = 1 / (1 - RL_j sum_i Z_ij)
///        one loaded:  s_j = 1 / (1 - RL_j sum_i Z_ij - sum_i Z_ij Rd_i y_ij / sum_i Z_ij)
///   (d)  G <- max(Z, 0) diag(s)
///   (e)  y <- y' = max(y, G diag(eta) G^T diag(Rd) y' / a)
///
/// (e): a taxel whose current is below the one that its neighbours cause is held at 0 S. Its current is taken as the
/// caused one, so that the others are solved with it at 0. It starts from the textbook's G, which is exact for Rd = 0,
/// and for RL = 0 with formula (2). Or it starts from the last frame's, moved by the change of the textbook's. Where
/// the plain iteration does not shrink quickly (heavy loads on weak drivers), Anderson's mixing of ln G takes over.
///
/// A taxel without a reading keeps its conductance: its y is what that draws at the present G, which (a) to (c) give.
///
/// Certificate. With the present G and R = Z - G diag(w), y - y(G) = D S^-1 R for all loaded. D S^-1 >= 0 as S is an
/// M-matrix. Its columns sum to at most 1, as 1^T S >= 1^T D (the current of every row is at most that of its driver).
/// Its diagonal is at least 1/a, as S D^-1 <= diag(a). Its other elements of column i are thus at most 1 - 1/a_i, and
///
///   |y - y(G)|_kj <= max_i |R_ij| + sum_i (1 - 1/a_i) |R_ij| = b_j
///
/// With one load w_j depends on y, which adds at most T_kj max(Rd)/RL_j b_j: |y - y(G)|_kj <= (1 + max(Rd)/RL_j) b_j.
///
/// Amplifiers (`transimpedance`): the column sees the resistance RL, the switch and the feedback resistor over 1 +
/// gain, to a voltage e = offset gain / (1 + gain). The reading is (I load_ohm - offset) / (1 + 1/gain). The currents
/// that e alone drives into the array are common to all scans; they are found anew for every G and added to y.
///
/// G is not always unique. On large arrays of low resistance beside weak drivers (max Rd sum_j G_ij above about 2) two
/// arrays can give the same readings. The result is the one that is reached from G = 0 as all readings grow.
/// Many members: the iterate, what is kept of the last frame, and work space, as no frame allocates.
class GroundedRows final : public CrosstalkInversion {
 public:
  /// `array` is a divider or transimpedance with grounded idle rows.
  GroundedRows(const ArrayDescription& array, double tolerance_ratio, const InversionOptions& options);
  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override;
  [[nodiscard]] bool set_shorted(std::span<const std::size_t> taxels) noexcept override;
  [[nodiscard]] bool set_broken(std::span<const LineFault> faults) noexcept override;
  void hold_film(const FilmConductances& film) noexcept override;
  bool start_frame(Nanos time) noexcept override {
    budget_.start_frame(time);
    return !budget_.is_scarce();
  }
  void start_attempt(double share) noexcept override { budget_.start_attempt(share); }
  void forget() noexcept override;
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override;
  [[nodiscard]] double siemens_per_ratio() const noexcept override;

 private:
  /// The effect of the amplifiers' offsets [stride].
  struct Sources {
    Sources(std::size_t rows, std::size_t stride);

    std::vector<double> ratio;         // e over the supply; empty: none
    std::vector<double> siemens;       // what e drives into the array, over the supply
    std::vector<double> column_ratio;  // column voltages then, over the supply
    std::vector<double> last_ratio;    // the same of the pass before
    std::vector<double> change;        // by a pass
    AndersonMixing mixing;
    std::vector<double> column_return;  // currents from the rows into the columns then
    std::vector<double> column_sum;     // G^T 1
    std::vector<double> line_ratio;     // row voltages, over the supply [rows]
  };

  /// Rows that touch one column, or each other, are one row; its readings stand in the first. So do those of columns.
  struct JoinedLines {
    struct Pair {
      std::size_t first;
      std::size_t other;
    };

    std::vector<Pair> rows;
    std::vector<Pair> cols;
    std::vector<double> drive_ohm;   // of the rows apart [rows]
    std::vector<double> column_ohm;  // of the columns apart [stride]
  };

  /// Anderson's mixing of ln G.
  struct Mixing {
    explicit Mixing(std::size_t size);

    AndersonMixing anderson;
    std::vector<double> log_siemens;
    std::vector<double> last_log_siemens;
    std::vector<double> log_step;
  };

  [[nodiscard]] bool add_shorted(std::size_t row, std::size_t col) noexcept;
  void mend_lines() noexcept;
  [[nodiscard]] bool break_line(const LineFault& fault) noexcept;
  [[nodiscard]] bool join_lines(const LineFault& fault) noexcept;
  void keep_open_rows() noexcept;
  void spread_to_kept(double sigma_ratio, std::span<double> sigma_siemens) const noexcept;
  void split_joined(std::span<double> siemens) const noexcept;
  void load(std::span<const double> ratio, std::span<const double> siemens) noexcept;
  void load_readings(std::span<const double> ratio) noexcept;
  void keep_missing(std::span<const double> ratio, std::span<const double> siemens) noexcept;
  void load_joined() noexcept;
  template <typename Line>
  void move_kept(Line line, const JoinedLines::Pair& pair) noexcept;
  void start_anew() noexcept;
  [[nodiscard]] double certify(Precision precision) noexcept;
  [[nodiscard]] double follow_sources() noexcept;
  void find_row_currents() noexcept;
  void find_column_ratios() noexcept;
  [[nodiscard]] double current_into_film(std::size_t col) const noexcept;
  double iterate() noexcept;
  double iterate_with_mixing(double best, int damped_steps) noexcept;
  void choose_step() noexcept;
  void keep() noexcept;

  double tolerance_;
  StepBudget budget_;  // in steps without mixing
  GroundedRowsState state_;
  JoinedLines joined_;
  bool can_break_ = false;               // lines
  bool is_broken_ = false;               // some line
  std::vector<double> reading_siemens_;  // y of a ratio of 1 [stride]
  std::vector<double> offset_siemens_;   // y of a ratio of 0 [stride]
  Sources sources_;
  Precision first_precision_ = Precision::full;  // of a frame that differs from the last as that did from its own
  bool has_last_ = false;                        // `state_` holds the solution of the last frame,
  bool is_unfinished_ = false;                   // or what it came to
  std::vector<double> last_estimate_;            // and this is the estimate that belongs to it
  std::vector<double> best_siemens_;
  std::vector<double> best_explained_;
  Mixing mixing_;
  std::vector<double> sigma_column_;  // of y [stride]
  std::optional<DriverError> driver_error_;
};

}  // namespace dermis::touch::compensation
