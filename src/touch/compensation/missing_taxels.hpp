// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

/// Conductances of taxels whose readings do not determine them. For three frames a taxel keeps its value; then its
/// neighbours determine it. In most circuits the others of its line are evidence, too. Let g be the line's load (at
/// virtual ground, the conductance of its driver). A taxel that is taken as x where it is X makes all others
///
///   s = (g + x) / (g + X)
///
/// times what they are. The true values of unloaded ones are known from the rest of the array. Both are weighed by
/// their standard deviations, in logarithms. Many members: what is known of each taxel, of the last frame and of this
/// one, and work space, as no frame allocates.
class MissingTaxels {
 public:
  MissingTaxels(const ArrayDescription& array, const ReferenceConductances& references);

  /// Those of the sheet that are invalid, or `hidden`; whether any is invalid.
  bool mark(std::span<const TaxelStatus> taxels, std::span<const std::uint8_t> hidden) noexcept;
  [[nodiscard]] bool any() const noexcept { return any_; }
  [[nodiscard]] bool is_missing(std::size_t taxel) const noexcept { return missing_[taxel] != 0; }

  /// A frame is one older than the last, whose values are stale after 50 ms.
  void start_frame(Nanos time) noexcept;

  /// Readings or conductances from those of their neighbours.
  void estimate(std::span<double> values) const noexcept;

  /// `siemens` are solved, with what was taken for the missing taxels. These become better, by the neighbours alone or
  /// by the others of the line, too. Returns the largest share of a voltage by which that matters to others. Allocates
  /// nothing.
  double improve(std::span<double> siemens, bool lines_tell = true) noexcept;

  /// There is no time for that: the estimates are those of the last frame.
  void doubt_estimates() noexcept;

  /// At these readings the estimates were made.
  void note_readings(std::span<const double> ratio) noexcept;

  /// Where it is known, what a taxel was a moment ago.
  [[nodiscard]] std::optional<double> held(std::size_t taxel) const noexcept;

  /// The same, or what it was estimated to be in the last frame.
  [[nodiscard]] std::optional<double> start(std::size_t taxel) const noexcept;

  /// They were estimated a few milliseconds ago, at much the same readings.
  [[nodiscard]] bool are_fresh(std::span<const double> ratio) const noexcept;

  /// What missing taxels were taken for in this frame; the next begins there if the frame is solved.
  void keep_estimates(std::span<const double> siemens, bool are_solved) noexcept;

  /// Relative standard deviation of a missing taxel.
  [[nodiscard]] double doubt(std::size_t taxel) const noexcept { return doubt_[taxel]; }

  /// The frame is solved, at these conductances.
  void remember(std::span<const double> siemens) noexcept;
  void forget() noexcept;
  void forget(std::size_t taxel) noexcept;

 private:
  /// The middle of some values, and the standard deviation of that.
  struct Middle {
    double value;
    double sigma;
  };

  [[nodiscard]] std::optional<double> logarithm(std::span<const double> values, std::size_t taxel,
                                                double floor) const noexcept;
  [[nodiscard]] std::optional<Middle> change_of_unloaded(std::optional<Axis> axis, std::size_t line) noexcept;
  void find_lacking(std::span<const double> siemens) noexcept;
  [[nodiscard]] bool any_is_missing(std::size_t line) const noexcept;
  void weigh(std::span<double> siemens) noexcept;
  void find_rises(std::span<const double> siemens) noexcept;
  void improve(std::size_t taxel, double taken, const Middle& lacking, double load_siemens,
               std::span<double> siemens) noexcept;

  const ArrayDescription& array_;
  std::optional<Axis> sharing_axis_;      // lines whose taxels take from each other
  std::vector<double> load_siemens_;      // g [lines]
  std::vector<double> typical_siemens_;   // [taxels]
  std::vector<double> series_ohm_;        // of the ends of both lines [taxels]
  std::vector<double> unloaded_siemens_;  // [taxels]; empty: unknown
  std::vector<std::uint8_t> absent_;      // [taxels]
  std::vector<std::uint8_t> missing_;     // [taxels]
  bool any_ = false;                      // of them
  std::vector<double> last_siemens_;      // [taxels]
  std::vector<std::uint8_t> frames_ago_;  // of it, at most a few [taxels]
  std::vector<double> estimated_;         // in the last frame; 0: it was not [taxels]
  Nanos last_time_{};
  std::optional<Nanos> estimated_at_;
  std::vector<double> estimated_of_;            // readings [taxels]
  std::vector<double> doubt_;                   // [taxels]
  std::vector<double> taken_;                   // [taxels]
  std::vector<double> rises_;                   // over the unloaded conductances; 0 where it tells nothing [taxels]
  std::vector<double> sorted_;                  // [taxels]
  std::vector<std::optional<Middle>> lacking_;  // of the lines of missing taxels [lines]
};

}  // namespace dermis::touch::compensation
