// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/network/perceptron_bank.hpp"

namespace dermis::fusion {

/// Inputs of a network that learned temperature; without it there is one less.
inline constexpr std::size_t kInputsWithTemperature = 3;

/// What calibration learns: one small BP network per taxel, (conductance, temperature) -> force. Each per-taxel vector
/// has the size taxels; taxels without a calibration of their own carry the parameters of a shared network and a gain.
///
///   e = siemens - (offset + offset_per_celsius * dT),   dT = temperature - centre       excess over the unloaded taxel
///   newtons = gain * exp(network(ln(e / reference), e / reference - 1, dT / half_span))    and 0 where e <= 0
///
/// The network's direct connection from ln(e) is the power law of conductive rubber, F ~ e^p, which also carries the
/// force to zero below the lightest calibrated load; what bends it (contact resistance, percolation, temperature) is
/// learned by the hidden units. Above the heaviest load, and outside the calibrated temperatures, the inputs and the
/// force are clamped. The force rises with conductance throughout.
///
/// We deviate from the paper, whose networks see every taxel and the supply (Fig. 7): the circuit and the supply are
/// known relationships and are solved before; what is left to learn is the material of one taxel.
struct ForceNetworks {
  network::PerceptronShape shape{2, 1, 2};  ///< 2 inputs (conductance, twice) or 3 (temperature too).
  double temperature_centre_celsius = 20.0;
  double temperature_half_span_celsius = 0.0;  ///< >= 0; the calibrated range is centre +- half span.

  std::vector<double> offset_siemens;      ///< Conductance of the unloaded taxel at the centre temperature [S].
  std::vector<double> offset_per_celsius;  ///< [S/C]
  std::vector<float> reference_siemens;    ///< Excess conductance of a typical load [S], > 0.
  std::vector<float> heaviest_siemens;     ///< e of the heaviest calibrated load [S], > 0.
  std::vector<float> heaviest_newtons;     ///< Heaviest calibrated load [N]; infinite where only sums are known.
  std::vector<float> gain;                 ///< > 0; 1 where the taxel has its own network.
  std::vector<std::uint8_t> dead;          ///< 1: did not answer to its loads.
  std::vector<float> parameters;           ///< [shape.parameter_count(), taxels]

  [[nodiscard]] std::size_t taxel_count() const noexcept { return gain.size(); }

  /// All vectors have the right size and every number is in its range.
  [[nodiscard]] bool is_consistent() const noexcept;
};

/// Unit 4 of the paper, the Data Processing Unit: fuses conductance and temperature to newtons.
/// Not thread-safe: one per stream.
class ForceFusion {
 public:
  /// `networks` must be consistent.
  explicit ForceFusion(ForceNetworks networks);

  /// Allocates nothing once `force` has the array's size.
  void process(const ConductanceFrame& conductance, ForceFrame& force) noexcept;

 private:
  [[nodiscard]] bool uses_temperature() const noexcept { return networks_.shape.inputs == kInputsWithTemperature; }
  [[nodiscard]] double temperature_offset(const ConductanceFrame& conductance, ForceFrame& force) const noexcept;
  void prepare_inputs(const ConductanceFrame& conductance, double temperature_offset) noexcept;
  void finish(std::size_t taxel, ForceFrame& force) const noexcept;

  ForceNetworks networks_;
  network::PerceptronBank bank_;
  std::vector<float> excess_siemens_;  // [taxels]
  std::vector<float> inputs_;          // [inputs, taxels]
  std::vector<float> outputs_;         // [taxels]
};

}  // namespace dermis::fusion
