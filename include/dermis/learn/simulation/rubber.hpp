// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/simulation/rubber_memory.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::simulation {

/// Area of the discs of the paper (Fig. 1: 7 mm in diameter, 0.7 mm thick), the taxel area of its array [m2].
inline constexpr double kPaperDiscAreaM2 = 38.48e-6;

/// A piece of conductive rubber under one array. The defaults are the reference array of the project (the 10 % grade).
/// docs/simulation.md has the source of each value, and what is assumed. Many members: each is a key of physics.toml.
struct RubberOptions {
  std::uint64_t seed = 1;  ///< Identifies the piece: the same seed gives the same taxel scatter in every scene.

  double resistance_at_10n_ohm = 900.0;  ///< Median resistance of a taxel at 10 N and 20 C [ohm], > 0. Reference array.
  double resistance_spread = 0.15;       ///< Sd of the logarithm of it over the taxels, 0 ... 1. Assumed 10-20 %.
  double exponent = 0.9;                 ///< Mean b of R ~ F^-b, 0.1 ... 3. FlexiForce: 1; range in use 0.5-1.2.
  double exponent_spread = 0.05;         ///< Relative sd of b over the taxels, 0 ... 0.3. Reference array.
  double unloaded_ohm = 200e3;           ///< Resistance beside the pressed path [ohm], > 0. Reference array.
  /// Resistance in series with the pressed path [ohm], 0 ... below resistance_at_10n_ohm. 0 because the reference array
  /// folds it into the power law; 100-500 ohm is a fair assumption for electrodes of conductive fabric.
  double contact_ohm = 0.0;

  double temperature_coefficient = -0.004;      ///< Mean d ln R / dT at 20 C [1/C], -0.1 ... 0.1. Reference array.
  double temperature_coefficient_spread = 0.2;  ///< Relative sd of it over the taxels, 0 ... 2. Assumed.
  double temperature_curvature = 0.0;           ///< Quadratic term of ln R [1/C^2], -0.001 ... 0.001.

  double hysteresis = 0.0;  ///< Gap between loading and unloading, relative to F, 0 ... 0.5. Interlink FSR: 0.10.
  double creep = 0.0;       ///< Share of the force that acts late, 0 ... 0.5. Assumed 0.05-0.10.
  /// The memory of real rubber in the place of `hysteresis` and `creep`, which must then be 0.
  std::optional<RubberMemoryOptions> memory;
  /// An aged sheet feels a load so many times as strongly as when it was new, 0.1 ... 10.
  double gain = 1.0;
  double gain_spread = 0.0;  ///< Sd of the logarithm of this gain over the taxels, 0 ... 1.
  double pink_noise = 1e-9;  ///< K of the PSD K/f of the relative conductance noise, 0 ... 1e-4. Assumed 1e-9-1e-8.
  /// Share of a taxel's load that its 4 neighbours carry, a quarter each, 0 ... 0.5. A quarter that falls off the edge
  /// of the array is carried by the frame around it and lost.
  double mechanical_spread = 0.0;

  /// Names the first field that is out of its range, as "rubber.exponent: ...".
  [[nodiscard]] Status validate() const;
};

/// The three carbon black grades of the paper: 5, 10 or 15 percent; 10 is the default above. The paper gives no
/// numbers. The other two are scaled from the 10 % grade by percolation theory, conductivity ~ (p - pc)^2, with an
/// assumed threshold pc = 3 %. All resistances are 12.3 times higher at 5 % and 0.34 times at 15 %. The noise is
/// proportional to the resistance. The exponent falls from 1.0 to 0.8, like the gauge factor of such rubbers with the
/// content.
[[nodiscard]] Result<RubberOptions> rubber_grade(int carbon_percent);

/// Switches the memory by its name: "simple" (hysteresis and creep above) or "rubber" (RubberMemory; options already
/// set stay). Fails on other names.
[[nodiscard]] Status choose_memory(const std::string& name, RubberOptions& rubber);

/// The state of all taxels of one array. With T in C, F in N and per-taxel a, b, alpha:
///   G = (1 + n) [1/unloaded_ohm + 1/(contact_ohm + a F_eff^-b)] exp(-alpha (T - 20) - curvature (T - 20)^2)   [S]
///   contact_ohm + a0 10^-b = resistance_at_10n_ohm exp(resistance_spread N(0,1))
///   a = a0 g^-b,  g = gain exp(gain_spread N(0,1))
///   F_eff = [F (1 - creep) + creep mean(s_1, s_2, s_3)] (1 - hysteresis/2 m)
/// s: Kelvin-Voigt elements of 0.1, 3 and 100 s that follow F. m: a stop (elastic-plastic) operator on ln(1 + F/1 N)
/// with reach 0.5, from 0 on a new piece. It is +1 after loading (reads low) and -1 after unloading (reads high). n:
/// 1/f noise, one Ornstein-Uhlenbeck process a decade with corners at 1 mHz ... 10 Hz. F: the force on the taxel, after
/// mechanical_spread. With RubberOptions::memory, F_eff and the unloaded conductance are those of RubberMemory. Exact
/// for any time step. Const members are thread-safe, the others are not.
class ConductiveRubber {
 public:
  static constexpr double kCreepSeconds[3] = {0.1, 3.0, 100.0};  ///< Time constants of s_k [s].
  static constexpr double kHysteresisReach = 0.5;                ///< Change of ln(1 + F/1 N) that moves m by 1.
  static constexpr double kNoiseCornersHz[5] = {1e-3, 1e-2, 1e-1, 1e0, 1e1};  ///< Corner frequencies of n [Hz].

  /// `noise_seed` drives the 1/f noise and the gains of touches. Fails on options out of range. Also fails if the
  /// scatter gives a taxel a resistance below contact_ohm or an exponent that is not positive.
  [[nodiscard]] static Result<ConductiveRubber> create(const RubberOptions& options, std::size_t rows, std::size_t cols,
                                                       std::uint64_t noise_seed);

  /// Puts `force_n` (>= 0, [rows, cols]) on the array at once and keeps it there for `seconds` (>= 0).
  void press(std::span<const double> force_n, double seconds);

  /// Conductance of every taxel now [S], [rows, cols], at the temperature of the whole array.
  void read(double temperature_celsius, std::span<double> siemens);
  /// The same where each taxel has a temperature of its own [taxels].
  void read(std::span<const double> taxel_celsius, std::span<double> siemens);

  /// The law alone, memory and noise excluded [S], for the force on this taxel (after mechanical_spread).
  [[nodiscard]] double conductance_from_force(std::size_t taxel, double force_n, double temperature_celsius) const;

  /// Its inverse [N]: what a perfect calibration would say. 0 at or below the unloaded conductance; infinity at or
  /// above the conductance of contact_ohm, which no force reaches.
  [[nodiscard]] double force_from_conductance(std::size_t taxel, double siemens, double temperature_celsius) const;

  /// The forces on the taxels now, after mechanical_spread [rows, cols].
  [[nodiscard]] const std::vector<double>& load_n() const noexcept { return load_n_; }

  [[nodiscard]] std::size_t taxel_count() const noexcept { return taxels_.size(); }

 private:
  struct Taxel {
    double scale_ohm;                // a [ohm N^b]
    double exponent;                 // b
    double temperature_coefficient;  // alpha [1/C]
  };

  ConductiveRubber(const RubberOptions& options, std::size_t rows, std::size_t cols, std::uint64_t noise_seed);
  [[nodiscard]] Status draw_taxels();
  void age();
  void share_load(std::span<const double> force_n);
  void follow_loop();
  void creep_towards_load(double seconds);
  void advance_noise();
  [[nodiscard]] double effective_force(std::size_t taxel) const;
  [[nodiscard]] double unloaded_siemens(std::size_t taxel) const;
  [[nodiscard]] double conductance(std::size_t taxel, double unloaded_siemens, double force_n,
                                   double temperature_celsius) const;
  [[nodiscard]] double relative_noise(std::size_t taxel) const;
  [[nodiscard]] double temperature_factor(std::size_t taxel, double temperature_celsius) const;

  RubberOptions options_;
  std::size_t rows_;
  std::size_t cols_;
  std::vector<Taxel> taxels_;
  std::vector<double> load_n_;      // Force on each taxel after mechanical_spread.
  std::vector<double> previous_n_;  // The same before the last press.
  std::vector<double> creep_n_;     // s_k, [3, taxels].
  std::vector<double> loop_;        // m.
  std::optional<RubberMemory> memory_;
  std::vector<double> noise_;    // Ornstein-Uhlenbeck states, [5, taxels].
  double unread_seconds_ = 0.0;  // Time by which the noise is behind.
  Random random_;
};

}  // namespace dermis::learn::simulation
