// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/compensation/line_fault.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "touch/compensation/anderson_mixing.hpp"
#include "touch/compensation/film_follower.hpp"
#include "touch/compensation/joined_lines.hpp"
#include "touch/compensation/lumped_circuit.hpp"
#include "touch/compensation/missing_taxels.hpp"
#include "touch/compensation/step_budget.hpp"

namespace dermis::touch::compensation {

/// Inverts the circuit with its faults by defect correction around the inversion of the healthy circuit: the readings
/// that the healthy circuit would give,
///
///   T' = T + T_healthy(G) - T_faulty(G),   G <- invert_healthy(T')
///
/// Taxels whose conductance no reading determines (on a silent line, stuck, without a reading in this frame) are
/// estimated (MissingTaxels). Without faults of lines, the healthy inversion keeps those estimates. An open row still
/// couples the columns through them: eliminating it adds -g g^T / sum(g) to their equations. Lines that
/// touch are one node with all that either touches. Broken lines are left to the inversion where it solves them.
/// Shorted crossings are in both circuits: the inversion solves them, or keeps their taxels at a large conductance. For
/// resistive lines, switches, real amplifiers, `none` and arrays of more than 256 lines there is no faulty circuit.
/// There the readings of faulty lines are replaced by those of their neighbours, and the rest is solved as if healthy.
/// Many members: one for each kind of fault, and work space, as invert() may not allocate.
class FaultInversion {
 public:
  FaultInversion(const ArrayDescription& array, double tolerance_ratio, const ReferenceConductances& references);

  /// `healthy` gets the shorted crossings. Allocates nothing.
  void set_faults(std::span<const LineFault> faults, CrosstalkInversion& healthy);
  [[nodiscard]] bool any() const noexcept { return any_; }

  /// See CrosstalkInversion.
  void hold_film(const FilmConductances& film) noexcept { film_.hold(film); }

  /// The bounds on the readings of a line together still hold: none is at the supply or joined with another.
  [[nodiscard]] bool keeps_bounds() const noexcept { return keeps_bounds_; }

  /// All taxels whose row and column are one line.
  [[nodiscard]] std::span<const std::size_t> shorted_crossings() const noexcept { return crossings_.taxels; }

  /// The taxel has no force of its own to report.
  [[nodiscard]] bool is_masked(std::size_t taxel) const noexcept { return is_.masked[taxel] != 0; }

  /// Learns which taxels of the next frame have no reading; whether that frame needs invert().
  [[nodiscard]] bool concerns(std::span<const TaxelStatus> taxels) noexcept;

  /// Frames that follow each other in time give the last values of taxels.
  void start_frame(Nanos time) noexcept {
    missing_.start_frame(time);
    budget_.start_frame(time);
  }

  /// Adds to the standard deviations these of taxels in doubt, and what the others of their lines owe to them.
  void add_doubt(std::span<const float> doubt_siemens, std::span<const double> siemens,
                 std::span<double> sigma_siemens) const noexcept;

  /// Whether a taxel may be only estimated.
  [[nodiscard]] bool any_doubt() const noexcept { return missing_.any(); }

  /// The standard deviation of taxels that are only estimated, 0 of the others [taxels] [S].
  void find_doubt(std::span<const double> siemens, std::span<float> doubt_siemens) const noexcept;

  /// The frame is solved, at these conductances.
  void remember(std::span<const double> siemens) noexcept { missing_.remember(siemens); }
  void forget() noexcept {
    missing_.forget();
    correction_.has_shift = false;
    budget_.forget();
  }

  /// As CrosstalkInversion::invert; `healthy` inverts the circuit without faults.
  InversionResult invert(CrosstalkInversion& healthy, std::span<const double> ratio,
                         std::span<double> siemens) noexcept;

 private:
  /// Both circuits; where it is not modelled there is none.
  struct Circuits {
    LumpedCircuit healthy;
    LumpedCircuit faulty;
  };

  /// The masks of each taxel [taxels].
  struct Masks {
    explicit Masks(const ArrayDescription& array);

    std::vector<std::uint8_t> masked;  // without a force to report
    std::vector<std::uint8_t> hidden;  // by a fault
  };

  /// Taxels whose row and column touch. Where `healthy` does not solve them they are kept at a large conductance, or,
  /// where idle rows are grounded, corrected as other faults are.
  struct Crossings {
    std::vector<std::size_t> taxels;    // all of lines that are one
    std::vector<std::size_t> spanning;  // as few of them as join these lines
    std::vector<std::size_t> in_first;  // taxels of joined lines, whose conductance stands in the first of them
    bool are_kept = false;
    bool are_corrected = false;
  };

  /// Work space of a round [taxels].
  struct Correction {
    explicit Correction(std::size_t taxels);

    std::vector<double> shift;       // T' less T of the last frame,
    bool has_shift = false;          // which had the same faults
    std::vector<double> difference;  // T' found less T' put in
    std::vector<double> last_difference;
    std::vector<double> last_corrected;
    std::vector<double> healthy_ratio;
    std::vector<double> faulty_ratio;
  };

  void add(const LineFault& fault);
  void find_crossings() noexcept;
  void mask_joined(bool are_solved) noexcept;
  void put_in_first_rows() noexcept;
  void hide_sensed_line(std::size_t taxel) noexcept;
  void add_crossings(CrosstalkInversion& healthy);
  [[nodiscard]] bool start_missing(const CrosstalkInversion& healthy, std::span<double> siemens) noexcept;
  void start_circuits() noexcept;
  void keep_shift() noexcept;
  void add_to_circuit(const LineFault& fault, LumpedCircuit& circuit) const;
  void subtract_supplied_rows(std::span<const double> ratio) noexcept;
  void average_shorted_lines() noexcept;
  void average(Axis axis, std::size_t first, std::size_t last) noexcept;
  InversionResult keep_estimates(CrosstalkInversion& healthy, std::span<double> siemens) noexcept;
  void keep_crossings(std::span<double> siemens) noexcept;
  void solve_circuits(std::span<const double> siemens) noexcept;
  double correct(bool first) noexcept;
  void mix(bool first) noexcept;
  [[nodiscard]] bool is_doubtful(std::size_t taxel) const noexcept;
  [[nodiscard]] double misfit(std::span<const double> siemens) const noexcept;

  ArrayDescription array_;
  double tolerance_;
  bool any_ = false;
  bool keeps_bounds_ = true;
  bool has_crossings_ = false;     // that are shorted
  bool lines_are_faulty_ = false;  // so that the circuit is another one,
  bool lines_are_solved_ = false;  // which the healthy inversion solves
  std::optional<Circuits> circuits_;
  FilmFollower film_;
  Masks is_;
  MissingTaxels missing_;
  Crossings crossings_;
  std::vector<std::size_t> supplied_rows_;
  PerAxis<std::vector<std::uint8_t>> is_shorted_to_next_;  // [lines]
  std::vector<double> measured_;                           // T without what supplied rows add [taxels]
  std::vector<double> equivalent_;                         // T' [taxels]
  JoinedLines lines_;
  StepBudget budget_;  // in rounds
  Correction correction_;
  std::optional<AndersonMixing> mixing_;  // of T', under a film
};

}  // namespace dermis::touch::compensation
