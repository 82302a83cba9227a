// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/force_sums.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/unloaded_law.hpp"
#include "dermis/touch/fusion/force_tables.hpp"
#include "dermis/touch/network/perceptron_bank.hpp"

namespace dermis::touch::fusion {

/// Inputs of a network that learned temperature; without it there is one less.
inline constexpr std::size_t kInputsWithTemperature = 3;

/// Forces at which the relative error of a network is known.
inline constexpr std::size_t kSigmaKnots = 6;

/// The result of calibration: one small BP network per taxel, (conductance, temperature) -> force. Each per-taxel
/// vector has the size taxels; taxels without a calibration of their own carry the parameters of a shared network and a
/// gain.
///
///   e = siemens - (offset + per_celsius * dT),   dT = temperature - centre              excess over the unloaded taxel
///   newtons = gain * exp(network(ln(e / reference), e / reference - 1, dT / half_span))    and 0 where e <= 0
///
/// The network's direct connection from ln(e) is the power law of conductive rubber, F ~ e^p. It also carries the force
/// to zero below the lightest calibrated load. The hidden units learn what bends the law (contact resistance,
/// percolation, temperature). Above the heaviest load F_h the power law at its end continues, to eight times that load,
/// as far as it exceeds the noise. Let x = ln(newtons / F_h) by that law and s the relative standard deviation at F_h.
/// Then newtons = F_h exp(x^3 / (x^2 + s^2)). Outside the calibrated temperatures the temperature is clamped. The force
/// rises with conductance throughout.
///
/// This differs from the paper, whose networks see every taxel and the supply (Fig. 7). The circuit and the supply are
/// known relationships and are solved before. Only the material of one taxel is left to learn. Many members: each is
/// part of the model file.
struct ForceNetworks {
  network::PerceptronShape shape{2, 1, 2};  ///< 2 inputs (conductance, twice) or 3 (temperature too).
  UnloadedLaw unloaded;                     ///< Over the calibrated temperatures.
  std::vector<float> reference_siemens;     ///< Excess conductance of a typical load [S], > 0.
  std::vector<float> heaviest_siemens;      ///< e of the heaviest calibrated load [S], > 0.
  std::vector<float> heaviest_newtons;      ///< Heaviest calibrated load [N]; infinite where only sums are known.
  std::vector<float> gain;                  ///< > 0; 1 where the taxel has its own network.
  std::vector<std::uint8_t> dead;           ///< 1: did not answer to its loads.
  std::vector<float> parameters;            ///< [shape.parameter_count(), taxels]
  ForceTables tables;  ///< Take the place of the network, and of its gain, on the taxels that have one.

  // The uncertainty that calibration found; see ForceFusion.
  double temperature_sigma_celsius = 0.0;  ///< Noise of the temperature sensor [C], >= 0.
  /// Lowest and highest of the temperatures between which the bend of the forces is unknown; equal: there are none.
  std::array<double, 2> temperature_gap_celsius{};
  std::vector<float> offset_sigma_siemens;  ///< Standard deviation of unloaded.offset_siemens [S], >= 0.
  /// Relative error of the force from causes without a term of their own (misfit, hysteresis, creep), > 0, at
  /// kSigmaKnots forces in equal ratios. Between them its square is linear in ln(newtons), beyond the ends it is
  /// constant.
  std::vector<float> relative_sigma;                       ///< [kSigmaKnots, taxels]
  std::array<float, 2> sigma_knots_newtons{0.1F, 100.0F};  ///< First and last of the forces [N], > 0, rising.
  /// Relative change of d ln newtons / d ln e for every factor e of the force, >= 0. Below the lightest and above the
  /// heaviest calibrated load.
  std::array<float, 2> end_bends{};

  GainErrors gain_errors;  ///< Changes of gains that a recalibration saw and left, or of a fitted cover; empty: none.

  [[nodiscard]] std::size_t taxel_count() const noexcept { return gain.size(); }

  /// Position of a force between the knots of relative_sigma: 0 at the first (and below), kSigmaKnots - 1 at the last.
  [[nodiscard]] float sigma_place(float log_newtons) const noexcept;

  /// All vectors have the right size and every number is in its range.
  [[nodiscard]] bool is_consistent() const noexcept;
};

/// Unit 4 of the paper, the Data Processing Unit: fuses conductance and temperature to newtons.
///
/// The standard deviation of a force, to first order. p = d ln newtons / d ln e and q = d ln newtons / dT at a fixed
/// conductance come from the backward pass of the network:
///
///   (sigma_newtons / newtons)^2 = (p / e)^2 (sigma_siemens^2 + offset_sigma^2) + (q sigma_T)^2 + relative_sigma^2
///
/// The square of gain_errors is added. The square of 0.5 %/C times the distance from the calibrated temperatures is
/// added. Pressure-sensitive rubber drifts by 0.2 to 1 %/C (FlexiForce: 0.36), and how this rubber drifts there is not
/// measured.
///
/// Outside the calibrated loads further squares are added. Beyond the heaviest load F_h it is that of x sqrt(0.2^2 +
/// (0.3 x)^2), x = ln(newtons / F_h), and that of exp(-ln(1 - c x) / c - x) - 1, c the second of end_bends, straight on
/// from c x = 0.95. Below the first of sigma_knots_newtons it is that of 0.1 x and of c x min(x, 1) / 2, x = ln(first /
/// newtons), c the first of them. On the line below the first load of a table it is also that of 0.3 ln(e_1 / e), e_1
/// the conductance there. From 8 F_h on the force is constant, with an infinite sigma.
///
/// sigma_T is the noise of the temperature sensor and the distance to the nearest calibrated temperature, by which a
/// temperature outside was clamped. In temperature_gap_celsius the network draws a line, but rubber may have changed
/// anywhere. Without a temperature sigma_T is half_span / sqrt(3). Below e = sigma_siemens (+) offset_sigma the right
/// side times newtons is that of this conductance, reached along the power law. So an unloaded taxel shows its
/// detection limit, the force that would just exceed the noise.
///
///   signal_to_noise = e / (sqrt(sigma_siemens^2 + offset_sigma^2) + 2 |per_celsius| sigma_T)
///
/// An error of the temperature moves the zero of all taxels alike, and no sum over taxels averages it out. So two
/// standard deviations of it count in full.
///
/// ForceFrame::sums continues the law below zero, F(-e) = -F(e), so that noise of either sign cancels. A bent law lifts
/// the mean of a noisy e. So p (p - 1) / 2 times the square of noise over e, which is at most 1 here, is taken away
/// from F.
///
/// Not thread-safe: one per stream. Many members: process() may not allocate.
class ForceFusion {
 public:
  /// `networks` must be consistent.
  explicit ForceFusion(ForceNetworks networks);

  /// Allocates nothing once `force` has the array's size.
  void process(const ConductanceFrame& conductance, ForceFrame& force) noexcept;

  /// The first term of sigma_newtons in the frame before: the noise of readings and zero alone [taxels] [N]. It is new
  /// in each frame; the other terms stay as long as a touch does. Meaningless where there is no force.
  [[nodiscard]] std::span<const float> noise_newtons() const noexcept { return noise_newtons_; }

 private:
  /// Offset from the centre, clamped, and its standard deviation [C].
  struct Temperature {
    double offset = 0.0;
    double sigma = 0.0;
    double outside = 0.0;  // that the clamp took

    [[nodiscard]] float unlearned_variance() const noexcept;
  };
  /// The temperature of the array, as uncertain as that of any taxel, and of each taxel [taxels].
  struct Temperatures {
    Temperature of_array{};
    std::vector<double> offset;
    std::vector<float> sigma;
    std::vector<float> gain_variance;  // ForceSources::gain_variance
  };
  [[nodiscard]] bool uses_temperature() const noexcept { return networks_.shape.inputs == kInputsWithTemperature; }
  [[nodiscard]] Temperature temperature(std::optional<double> celsius, ForceFrame& force) const noexcept;
  void find_temperatures(const ConductanceFrame& conductance, ForceFrame& force) noexcept;
  void find_own_temperatures(const ConductanceFrame& conductance, ForceFrame& force) noexcept;
  void prepare_inputs(const ConductanceFrame& conductance) noexcept;
  void look_up() noexcept;
  void compute_forces(ForceFrame& force) noexcept;
  void compute_signals(ForceFrame& force) const noexcept;
  void apply_status(ForceFrame& force) const noexcept;
  [[nodiscard]] bool are_plain(std::size_t from, std::size_t to, const ForceFrame& force) const noexcept;
  [[nodiscard]] bool apply_status(std::size_t taxel, ForceFrame& force) const noexcept;
  void extrapolate(std::size_t taxel, float& newtons, float& sigma) const noexcept;

  ForceNetworks networks_;
  std::shared_ptr<const GainErrors> gain_errors_;  // null: there are none
  network::PerceptronBank bank_;
  Temperatures temperatures_;
  std::vector<float> per_reference_siemens_;  // [taxels]
  std::vector<float> log_gain_;               // [taxels]
  std::vector<float> offset_per_celsius_;     // [taxels]
  std::vector<float> variance_rises_;         // ForceSources::variance_rises [kSigmaKnots, taxels]
  std::vector<float> excess_siemens_;         // [taxels]
  std::vector<float> sigma_siemens_;          // of the excess [taxels]
  std::vector<float> inputs_;                 // [inputs, taxels]
  std::vector<float> outputs_;                // [taxels]
  std::vector<float> gradient_;               // of the outputs [inputs, taxels]
  std::vector<float> line_end_siemens_;       // ForceTables::line_end_siemens() [tables]
  std::vector<float> table_variance_;         // ForceSources::table_variance [taxels]
  std::vector<float> noise_newtons_;          // [taxels]
};

}  // namespace dermis::touch::fusion
