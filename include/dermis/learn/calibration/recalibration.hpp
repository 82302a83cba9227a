// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/force_sums.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// A press of known force, against what a model read of it.
struct KnownPress {
  std::vector<std::size_t> taxels;  ///< That carry it.
  std::vector<double> shares;       ///< Share of the read force on each of them; together 1.
  double log_ratio = 0.0;           ///< ln(known / read), mean over its labelled frames.
  double sigma = 0.0;               ///< Standard deviation of it as the model says, > 0.
};

/// How gains have changed: logarithms of factors on the forces.
struct GainChange {
  double sheet = 0.0;          ///< Of all taxels,
  double sheet_sigma = 0.0;    ///< and its standard deviation.
  double spread = 0.0;         ///< Standard deviation over the taxels besides; 0: not distinguished.
  double row_share = 0.0;      ///< Share of its square that rows were found to have in common,
  double column_share = 0.0;   ///< and columns.
  std::vector<double> taxels;  ///< Change of each taxel, that of the sheet included [taxels].
  GainErrors left;             ///< How wrong `taxels` may still be.
};

/// Derives the change of gains from presses. Each taxel has changed by x + y: x is common to the sheet, 0 ± 0.1 before
/// any press; y is its own, 0 ± spread. The most likely values are those of a linear model (Gauss and Markov; kriging).
/// Little evidence moves a gain little, and a taxel that nothing pressed gets x. The spread is the root mean square of
/// those that the presses leave likely. It is 0 where none makes the presses likelier, and with fewer than 5 presses or
/// pressed taxels.
///
/// Parts of y may be those of rows or columns. They are fitted if presses foretell others better by it, by 12 in the
/// logarithm of the odds (leave-one-out). Otherwise y is each taxel's own, and `left` shares the spread between rows,
/// columns and taxels as likely as each is. Deterministic, thread-safe.
[[nodiscard]] GainChange change_of(std::span<const KnownPress> presses, const FrameShape& shape);

/// A model with gains of today.
struct Recalibration {
  touch::pipeline::Model model;  ///< The model with other gains and their errors; its provenance says why.
  GainChange change;
  double unloaded = 0.0;  ///< Relative change of the unloaded conductances, which moved the zero; 0: none was found.
  std::size_t presses = 0;
  std::size_t taxels = 0;    ///< That were pressed.
  std::size_t left_out = 0;  ///< Presses without a force, or beyond the calibrated loads.
};

/// Presses of known force -> new gains of `model`, by which its look-up tables and its heaviest loads are scaled, too.
/// The parameters of its networks stay as they are, and so do its baselines. If untouched frames show that all unloaded
/// taxels conduct up to half more or less, that is the new zero. Labelled frames in a row with loads
/// on one region are one press, until its reading falls below a third of what it was. Errors: a load beyond the frames,
/// or a pressure without an area of the taxels; no load above zero has a force; more than kMostPresses.
[[nodiscard]] Result<Recalibration> recalibrate(const touch::pipeline::Model& model, std::span<const RawFrame> frames,
                                                std::span<const Load> loads);

/// More are worth a calibration.
inline constexpr std::size_t kMostPresses = 1000;

/// "the sheet reads 9.1 % too much (± 2.0 %): from one press"; a sentence more of the spread, if that is known.
[[nodiscard]] std::string describe(const Recalibration& recalibration);

}  // namespace dermis::learn::calibration
