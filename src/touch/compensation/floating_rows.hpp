// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "touch/compensation/anderson_mixing.hpp"
#include "touch/compensation/dense_inverse.hpp"
#include "touch/compensation/film_follower.hpp"

namespace dermis::touch::compensation {

/// The divider whose idle rows float and whose lines have no resistance: "Floating rows" in
/// docs/reasons/derivations-circuits.md. It is solved by a fixed point of as many numbers as there are lines. Given the
/// sum D_j of the conductances on each column and a factor b_i of each row, all conductances follow from the readings.
/// These give D and b anew. A reading below what its neighbours alone explain is raised until its taxel is at 0 S.
/// Usually settles in 5 to 20 passes of about 35 cols^3 + 4 rows cols^2 multiplications, where a single product with
/// the Jacobian takes rows^2 cols^2. Under a film its conductances are further numbers, and the sum of each row stands
/// for b_i. That takes two to three times as many passes.
///
/// Many members: the work space of a pass, which may not allocate.
class FloatingRows {
 public:
  /// `array`: inverts() it. A film follows the taxels by `references`.
  explicit FloatingRows(const ArrayDescription& array, const ReferenceConductances& references = {});

  [[nodiscard]] static bool inverts(const Readout& readout) noexcept;

  /// false: the drivers cannot carry what these readings [rows, cols] take from them, whatever the taxels are.
  [[nodiscard]] bool allows(std::span<const double> ratio) const noexcept;

  /// The conductances [rows, cols] of readings that it allows; taxels without a reading keep those in `siemens`. Passes
  /// go on until one changes nothing by more than `enough` (relative; for raised readings, over the supply). Starts
  /// from the last frame that settled. Returns what the last pass has changed, more than `enough` where it does not
  /// settle, infinity where it runs away. Allocates nothing.
  [[nodiscard]] double solve(std::span<const double> ratio, double enough, std::span<double> siemens) noexcept;

  /// See CrosstalkInversion.
  void hold_film(const FilmConductances& film) noexcept { film_.hold(film); }

  /// Does not start from the last frame.
  void forget() noexcept { has_last_ = false; }

 private:
  using Matrix = DenseInverse::Matrix;

  /// L of L L^T = diag(own) plus the Laplacian of conductances between neighbours: its diagonal, and the one below.
  struct Bidiagonal {
    explicit Bidiagonal(std::size_t size)
        : diagonal(static_cast<Eigen::Index>(size)), below(static_cast<Eigen::Index>(size)) {}
    void factorise(const double* log_own, const double* log_between) noexcept;

    Eigen::VectorXd diagonal;
    Eigen::VectorXd below;
  };

  [[nodiscard]] double settle(double enough) noexcept;
  void start() noexcept;
  void copy_film() noexcept;
  void find_potentials() noexcept;
  void weigh() noexcept;
  void weigh_under_film() noexcept;
  void couple_columns() noexcept;
  void couple_under_film() noexcept;
  void advance() noexcept;
  [[nodiscard]] double follow() noexcept;
  [[nodiscard]] double follow_rows() noexcept;
  [[nodiscard]] double follow_rows_under_film() noexcept;
  void follow_film() noexcept;
  [[nodiscard]] double follow_taxel(Eigen::Index row, Eigen::Index col, double factor, double driven) noexcept;

  Eigen::VectorXd drive_ohm_;
  Eigen::RowVectorXd load_siemens_;
  FilmFollower film_;
  AndersonMixing mixing_;
  Eigen::VectorXd logarithms_;       // of D [cols], then of b [rows]; under a film of |G_i|, then of the film
  Eigen::VectorXd change_;           // of them in a pass
  Eigen::VectorXd last_logarithms_;  // under a film
  bool has_last_ = false;
  Matrix readings_;
  Matrix siemens_;
  Matrix kept_;               // conductances of taxels without a reading
  Matrix raised_;             // readings, those of taxels at 0 S or without one as the circuit gives them
  Matrix potentials_;         // p: of the columns at 1 V of the driven row
  Eigen::VectorXd driven_;    // potential of the driven row
  Eigen::VectorXd currents_;  // c: of the driven row at 1 V; 0: none of its readings shows any
  Eigen::RowVectorXd scale_;  // sqrt(D)
  Bidiagonal of_cols_;        // the same under a film: of D, with it
  Bidiagonal of_rows_;        // and of the rows
  Eigen::VectorXd beside_;    // by way of the film from each row to the others [rows]
  Matrix weighted_;
  Matrix coupling_;  // M
  Matrix returned_;  // p M
  Matrix square_;    // T
  Matrix root_;      // 1/2 + sqrt(1/4 + T)
  Matrix product_;
  DenseInverse inverse_;
};

}  // namespace dermis::touch::compensation
