// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

/// A labelled recording and how a whole calibration is made of it.
struct Trainable {
  std::span<const RawFrame> frames;
  std::span<const Load> loads;
  Nanos settle_time{0};
  /// Networks, memory and uncertainty by some of the loads; empty: they cannot be trained.
  std::function<std::optional<touch::pipeline::Model>(const ArrayDescription&, std::span<const Load>)> train;
};

/// The total force of a press by a calibration that has not seen it.
struct UnseenPress {
  double log_error = 0.0;  ///< ln(total / true), at most 1 and at least -1; NaN: no force.
  double sigma = 0.0;      ///< Relative, as the calibration says.
};

/// [presses of Proof]
struct UnseenPresses {
  std::vector<UnseenPress> several;
  std::vector<UnseenPress> single;
};

/// Presses that are left out of whole calibrations: half of those on several taxels at a time, by place, and a tenth of
/// the single ones, each with all others of its taxel and force.
class Proof {
 public:
  static constexpr std::size_t kLeastPresses = 8;  ///< On several taxels; fewer tell nothing.
  static constexpr double kOfWrongCircuit = 0.5;  ///< A share of the force: circuits described wrongly left 14 to 56 %.

  Proof(const ArrayDescription& array, const CircuitFrames& frames, const Trainable& trainable);

  [[nodiscard]] bool has_presses() const { return several_.size() >= kLeastPresses; }

  /// `fit`: the array by the loads that are left. Empty: it cannot be fitted or trained without a half.
  using Fit = std::function<std::optional<ArrayDescription>(std::span<const Load>)>;
  [[nodiscard]] std::optional<UnseenPresses> errors_of(const Fit& fit) const { return errors_of(fit, false); }
  /// Calibrations are by single presses alone. Laws that are learned from several taxels take in a part of what is
  /// wrong.
  [[nodiscard]] std::optional<UnseenPresses> errors_by_singles(const ArrayDescription& array) const;

  /// Presses on several taxels get better by more than chance, their median by a tenth, and single ones do not get
  /// worse. Beside their middle error, which what changes with time gives them, too, they get better by a standard
  /// error. There are such presses.
  [[nodiscard]] bool is_better(const UnseenPresses& candidate, const UnseenPresses& before) const;
  /// Neither kind of press gets worse by more than chance, those on several taxels not by a standard error.
  [[nodiscard]] bool is_no_worse(const UnseenPresses& candidate, const UnseenPresses& before) const;
  /// Presses on several taxels are farther off, over what the calibrations say, than single presses and than chance.
  [[nodiscard]] static bool do_not_add_up(const UnseenPresses& unseen);
  /// By how much any force may be off beyond what the calibrations say, relative: as presses on several taxels are.
  /// The circuit is not shown by single presses: its error grows with the others on the lines of a taxel, up to
  /// kOfWrongCircuit. 0: as near as said.
  [[nodiscard]] double unexplained_share(const UnseenPresses& unseen) const;

 private:
  struct LeftOut {
    std::vector<std::size_t> taxels;
    double newtons = 0.0;
    std::size_t first_frame = 0;
    std::size_t last_frame = 0;
    std::size_t place = 0;  ///< Single presses: of its taxel and force.
    std::size_t half = 0;   ///< 2: none.
  };

  template <typename IsSame>
  static void number_places(std::vector<LeftOut>& presses, const IsSame& is_same);
  [[nodiscard]] std::vector<double> gains_of_places(const UnseenPresses& candidate, const UnseenPresses& before) const;
  [[nodiscard]] std::vector<Load> loads_without(std::size_t half, bool all_several) const;
  [[nodiscard]] std::optional<UnseenPresses> errors_of(const Fit& fit, bool without_several) const;
  [[nodiscard]] bool judge(const touch::pipeline::Model& model, std::size_t half, UnseenPresses& unseen) const;

  const Trainable& trainable_;
  std::size_t lines_;
  std::vector<LeftOut> several_;
  std::vector<LeftOut> single_;
};

}  // namespace dermis::learn::calibration
