// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::simulation {

/// Strength of a rubber's memory. The ranges cover measurements on real sheets (docs/reasons/simulation.md).
struct RubberMemoryOptions {
  double creep_per_decade = 0.10;  ///< Growth of a held reading per decade of time, 0.02 ... 0.30. Measured 0.08-0.31.
  double loop_gap = 0.08;          ///< Gap between loading and unloading, relative to the force, 0 ... 0.2. FSR: 0.10.
  double touch_gain = 0.05;        ///< Sd of the logarithm of the gain of a touch, 0 ... 0.3. Measured 0.06-0.10.
  double release_dip = 0.35;       ///< Greatest loss of unloaded conductance by a release, 0 ... 0.6. 0.2-0.4.

  /// Names the first field that is out of its range, as "rubber.touch_gain: ...".
  [[nodiscard]] Status validate() const;
};

/// Effect of past loads on the taxels of a sheet of filled rubber between electrodes. The forward law of a taxel uses
/// its present load F [N], c = creep_per_decade, E(t) = sum_k (1 - exp(-t/tau_k)) and z = sum_k s_k:
///
///   compression  e = F (1 - c E(1 s)) + c z
///                tau_k ds_k/dt = F - s_k, tau_k = 0.01, 0.1 ... 1000 s
///   friction     p = e (1 - loop_gap/6 sum_j m_j)
///                m_j <- clamp(m_j + d ln(1 + F/1 N)/r_j, -1, 1), r_j = 0.1, 0.3, 1
///   closing      w = 1 - exp(-F/0.02 N)
///   felt force   f = w g p, the force in the static law of ConductiveRubber
///   set          the unloaded conductance is multiplied by 1 - release_dip (1 - w) z/(z + 0.5 N)
///
/// Compression: an elastic layer in series with one Kelvin-Voigt element per decade, all of the same compliance. So
/// creep follows the logarithm of time as in filled rubber (Gent, J. Appl. Polym. Sci. 6:433, 1962). A held load on
/// rested rubber reads e = F after one second. From t to 10 t it grows by c F (exp(-t/1000 s) - exp(-1000 t/1 s)). This
/// is c F within 1 % from 5 ms to 100 s.
///
/// Friction: filler slides against the polymer at three thresholds (stops of Prandtl, 1928). It follows the load, not
/// time; p is loop_gap e lower on a long way up than on a long way down.
///
/// Closing: rough surfaces conduct where a load closes them, and open at once when it goes. So a sheet that is still
/// compressed does not conduct for that reason.
///
/// Set: rubber that is still compressed after a release lifts off the electrodes that it was mounted against. Its
/// unloaded path conducts less until it has crept back. On Velostat under a load cell it was 20-40 % for more than ten
/// seconds.
///
/// Gain: g = exp(touch_gain N(0,1)), drawn when a load comes onto an unloaded taxel, because rubber settles differently
/// each time.
///
/// Exact for any time step while loads change in steps. Const members are thread-safe, press() is not.
class RubberMemory {
 public:
  static constexpr double kCreepSeconds[6] = {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0};  ///< tau_k [s].
  static constexpr double kStopReach[3] = {0.1, 0.3, 1.0};                           ///< r_j.
  static constexpr double kClosingN = 0.02;                                          ///< Assumed.
  static constexpr double kSetN = 0.5;                                               ///< Assumed.

  /// Rested rubber. `options` are valid; `seed` drives the gains of the touches.
  RubberMemory(const RubberMemoryOptions& options, std::size_t taxels, std::uint64_t seed);

  /// Puts `load_n` (>= 0, [taxels]) on at once and keeps it there for `seconds` (>= 0).
  void press(std::span<const double> load_n, double seconds);

  /// f [N], >= 0.
  [[nodiscard]] double material_force(std::size_t taxel) const;

  /// Remaining share of the unloaded conductance, 1 - release_dip ... 1.
  [[nodiscard]] double unloaded_share(std::size_t taxel) const;

 private:
  void change_load(std::size_t taxel, double load_n);
  void creep(double seconds);
  [[nodiscard]] double late_compression(std::size_t taxel) const;

  RubberMemoryOptions options_;
  double instant_share_;         // 1 - c E(1 s)
  std::vector<double> load_n_;   // F
  std::vector<double> creep_n_;  // s_k, [6, taxels]
  std::vector<double> stops_;    // m_j, [taxels, 3]
  std::vector<double> gain_;     // g
  Random touches_;
};

}  // namespace dermis::learn::simulation
