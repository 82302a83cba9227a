// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/preprocessing/supply_bounds.hpp"

namespace dermis::learn::calibration {

/// A total force over several taxels that share it in an unknown way.
struct TotalForce {
  std::vector<std::size_t> taxels;  ///< Row-major indices.
  double newtons = 0.0;             ///< >= 0
  double material_share = 1.0;      ///< Share of it that the material felt, as in Sample.
};

/// A labelled frame with supply and crosstalk removed.
struct Sample {
  std::size_t frame = 0;  ///< Index in the recording.
  std::optional<double> temperature_celsius;
  std::vector<float> ratio;          ///< Reading / supply [taxels].
  double sigma_ratio = 0.0;          ///< Standard deviation of every ratio for the array's adc_noise_counts.
  std::vector<float> siemens;        ///< Conductances [taxels].
  std::vector<float> sigma_siemens;  ///< Standard deviation of each from noise of the readings; empty: not known.
  std::vector<TaxelStatus> taxels;   ///< What is known about each [taxels].
  std::vector<float> known_newtons;  ///< Force of each taxel [taxels]: 0 where unloaded, NaN where unknown.
  std::vector<TotalForce> totals;
  /// Share of each known force that the material felt, after all that came before [taxels]; NaN: not known. Empty: all
  /// of it.
  std::vector<float> material_share{};
  bool unloaded = false;               ///< Nothing presses anywhere.
  std::vector<float> taxel_celsius{};  ///< As in ConditionedFrame.
};

/// The paper's "sample database": what the networks are trained on.
struct SampleDatabase {
  ArrayDescription array;
  std::vector<Sample> samples;
  double siemens_per_count = 0.0;  ///< Conductance of one ADC count at an unloaded taxel [S].
  /// Supplies of all samples but outliers; empty: their frames give none.
  std::optional<touch::preprocessing::SupplyRange> supply;
  std::size_t frames_rejected = 0;
  std::string first_rejection;       ///< "frame 17: a supply of 0 V or less"; empty when none.
  std::vector<std::string> remarks;  ///< Sentences on errors in labels and readings, and on what is left out.
  /// Where circuit and ADC are not as described and stay so: forces are less sure, a sentence each.
  std::vector<std::string> doubts;
  /// Too few presses on two to six taxels show whether circuit and ADC are as described; eight are needed.
  bool lacks_proof = false;
  /// Relative residual of presses on several taxels under circuit and ADC, beside that of single presses; 0: nothing.
  double unexplained_share = 0.0;
  double cover_error = 0.0;               ///< Relative error that all forces have in common, as the cover was fitted.
  std::optional<CircuitFit> circuit_fit;  ///< Where resistances or the circuit were unknown; `array` holds its result.
};

/// Runs labelled frames after `settle_time` through units 2 and 3. Errors: no labelled frame, no unloaded frame (a
/// frame labelled `force,all,0`), a load beyond the frames, a circuit that cannot be inverted. So is more than a tenth
/// of the labelled frames rejected. Frames that are called unloaded but are pressed are left out. Unknown parts of the
/// circuit are found first: fit_circuit(). A taxel without a reading has the conductance that its neighbours suggest,
/// and no known force. Some of very many frames become samples: see choose_samples(). `progress` gets the share of them
/// that is done.
[[nodiscard]] Result<SampleDatabase> build_sample_database(const ArrayDescription& array,
                                                           std::span<const RawFrame> frames,
                                                           std::span<const Load> loads, Nanos settle_time = Nanos{0},
                                                           const std::function<void(double)>& progress = {});

/// Bare reading of a taxel, counts / full scale, turned round where pressure lowers it; 0 where there is none.
[[nodiscard]] double bare_reading(const SampleDatabase& database, const Sample& sample, std::size_t taxel);

}  // namespace dermis::learn::calibration
