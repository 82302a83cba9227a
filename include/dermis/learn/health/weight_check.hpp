// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::health {

/// Means over frames [rows, cols], where the array has a film. Empty: none.
struct StandingReadings {
  std::vector<double> ratio;    ///< Readings over the supply, while the object lies still.
  std::vector<double> idle;     ///< The same before it was put on.
  std::vector<double> newtons;  ///< While it lies still.
};

/// The reading of an array while an object lies still on it, all contacts together.
struct WeighedPress {
  double newtons = 0.0;        ///< > 0
  double sigma_newtons = 0.0;  ///< As the model says, > 0.
  StandingReadings readings{};
};

/// The verdict on a calibration by an object of known weight.
struct WeightFinding {
  double weight_n = 0.0;
  std::vector<WeighedPress> presses;  ///< Of the object.
  std::size_t others = 0;    ///< Presses that read less than half or more than twice the weight: of something else.
  double other_n = 0.0;      ///< Reading of the last of them [N].
  std::size_t unsteady = 0;  ///< Presses that were too short or not steady.
  double ratio = 1.0;        ///< Reading over weight; geometric mean of the presses.
  double sigma = 0.0;        ///< Standard deviation of its logarithm, that from touch to touch included.
  double point_m = 0.0;      ///< Standard deviation of the forces of a point on the model's cover [m]; 0: no cover.
  double narrowest_m = 0.0;  ///< The least of the presses, across them [m].
  double film_factor = 1.0;  ///< By how much more the film between the lines conducts; 1: no change is seen.

  /// A larger change of the gain counts: three standard deviations, and 3 % at least.
  [[nodiscard]] double limit() const noexcept;
  [[nodiscard]] bool has_aged() const noexcept;
  /// Nothing looks narrower than a point on the cover: it spreads less than when it was calibrated.
  [[nodiscard]] bool has_lost_cover() const noexcept;
  [[nodiscard]] bool has_changed_film() const noexcept { return film_factor != 1.0; }
};

/// Lines of text: the weight, then "well: reads 1.2 % low, within 4 %" or "recalibrate: gains have changed by about 9 %
/// (± 3 %): it reads too much". Without a press, one line without an end names what is missing.
[[nodiscard]] std::string describe(const WeightFinding& finding);

/// Weighs a known object that is put on an array, once or several times. The steadiest second of each press counts,
/// from one second after its onset on, that reads between half and twice the weight. Not thread-safe.
class WeightCheck {
 public:
  /// `weight_n` > 0.
  WeightCheck(const touch::pipeline::Model& model, double weight_n);

  /// The next frame of the array, and the readings it was made of [rows, cols], over the supply. Without them nothing
  /// is said of a film. Where the array has one, allocates once a second.
  void add(const ForceFrame& force, std::span<const double> ratio = {});

  /// The finding over all frames so far; a press that still lasts counts.
  [[nodiscard]] WeightFinding finding() const;

 private:
  /// Sums of the taxels' values over frames.
  struct Sums {
    std::size_t frames = 0;
    std::vector<double> values;

    template <typename Values>
    void add(const Values& frame);
    [[nodiscard]] std::vector<double> mean() const;
  };
  /// A film that is known, without a cover, which would hide what it does.
  struct Sheet {
    ArrayDescription array;
    std::vector<double> idle_siemens;
  };
  /// A second of a press, or more where frames are rare.
  struct Piece {
    Nanos begin{};
    std::size_t frames = 0;
    double sum_n = 0.0;
    double sum_square = 0.0;
    double sum_sigma_n = 0.0;
    double sum_width_m = 0.0;  // of the strongest contact, across it
    Sums ratio;
    Sums newtons;
  };
  struct Press {
    Nanos onset{};
    std::optional<Piece> piece;
    std::optional<WeighedPress> steadiest;  ///< The steadiest piece that may be the weight.
    double deviation = 0.0;                 ///< Of `steadiest`, relative.
    double width_m = 0.0;                   ///< The same.
    std::optional<double> other_n;          ///< A still reading of less than half or more than twice the weight.
  };

  [[nodiscard]] bool is_taken_off() const;
  void rest(std::span<const double> ratio);
  void hold(const ForceFrame& force, std::span<const double> ratio);
  void close_piece(Press& press) const;
  [[nodiscard]] double width_m() const;
  static void count(const Press& press, WeightFinding& finding);

  PlaneVector middle_;  ///< Of the array [m].
  PlaneVector room_;    ///< About the middle, in which no cover reaches the rim [m]; 0 or less: none.
  touch::contacts::ContactTracker tracker_;
  ContactReport report_;
  std::optional<Sheet> sheet_;
  Sums idle_;                   ///< Ratios since the last press.
  std::optional<Press> press_;  ///< That lasts.
  WeightFinding finding_;       ///< Of the presses that are over.
};

}  // namespace dermis::learn::health
