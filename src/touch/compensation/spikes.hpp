// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

/// Readings that jump from one frame to the next though nothing pressed. A taxel that is taken as x where it is X makes
/// all others of its line s times what they are, as the circuit solves them (MissingTaxels):
///
///   s = (g + x) / (g + X),   g the load of the line, x = G / (1 + R G) behind the resistance R of the crossing line
///
/// So after a press the conductances of the others are what they were, and after a spike their readings are. They are
/// witnesses: each is what it was, or it moved, or it is another load, and then it tells nothing. So a press on many
/// taxels is none of its witnesses. All jumps of a line are spikes, or none is. A spike that is not certain is a doubt,
/// the jump times the root of its probability. Frames of another touch are not compared. Where circuits give no
/// evidence, nothing is ever taken or doubted. Many members: the last frame, and work space, as take() may not
/// allocate.
class Spikes {
 public:
  explicit Spikes(const ArrayDescription& array);

  /// Spikes among the readings become invalid in `conductance`, which solves them or is the best attempt; whether there
  /// are any. Frames are compared that follow each other within 50 ms. Allocates nothing.
  [[nodiscard]] bool take(const ConditionedFrame& frame, bool is_solved, ConductanceFrame& conductance) noexcept;

  /// Whether a taxel of this frame may be a spike, but is not taken.
  [[nodiscard]] bool any_doubt() const noexcept { return !doubts_.empty(); }

  /// Adds the standard deviations of these taxels [taxels] [S].
  void add_doubt(std::span<float> doubt_siemens) const noexcept;

  /// The frame is solved without its spikes. Allocates nothing.
  void remember(const ConditionedFrame& frame, const ConductanceFrame& conductance) noexcept;

  void forget() noexcept;

 private:
  static constexpr double kLeastJump = 0.05;  // of the supply

  struct Doubt {
    std::size_t taxel;
    double siemens;
  };

  struct NowAndBefore {
    std::vector<double> now;
    std::vector<double> before;
  };

  /// A taxel of the line, behind the crossing line [S].
  struct Witness {
    double now;
    double before;
    double reads;      // with crosstalk
    double has_read;   // likewise, in the line as it is now
    double noise;      // of each
    double crosstalk;  // its standard deviation
  };

  [[nodiscard]] std::size_t taxel_of(std::size_t line, std::size_t place) const noexcept {
    return axis_ == Axis::row ? line * cols_ + place : place * cols_ + line;
  }
  [[nodiscard]] std::size_t line_at(std::size_t taxel) const noexcept {
    return axis_ == Axis::row ? taxel / cols_ : taxel % cols_;
  }
  [[nodiscard]] bool any_jump(std::span<const double> ratio) const noexcept;
  [[nodiscard]] bool is_jump(std::size_t taxel, std::span<const double> ratio) const noexcept {
    return ratio[taxel] - last_[taxel] > kLeastJump;
  }
  /// The taxel has a reading in this frame and had one before.
  [[nodiscard]] bool is_known(std::size_t taxel, std::span<const TaxelStatus> taxels) const noexcept {
    return taxels[taxel] != TaxelStatus::invalid && !std::isnan(last_[taxel]);
  }
  [[nodiscard]] bool is_touched(std::size_t taxel, std::span<const double> ratio, double sigma_ratio) const noexcept;
  [[nodiscard]] bool find_jumps(std::size_t line, const ConditionedFrame& frame,
                                std::span<const TaxelStatus> taxels) noexcept;
  void find_behind(const ConductanceFrame& conductance) noexcept;
  void find_loads(const ConditionedFrame& frame, std::span<const TaxelStatus> taxels, bool is_solved) noexcept;
  void find_loads_by_readings(const ConditionedFrame& frame, std::span<const TaxelStatus> taxels) noexcept;
  [[nodiscard]] Witness witness(std::size_t taxel, const ConditionedFrame& frame, bool is_solved) const noexcept;
  [[nodiscard]] double probability(std::size_t line, const ConditionedFrame& frame, std::span<const TaxelStatus> taxels,
                                   bool is_solved) const noexcept;
  [[nodiscard]] double evidence(const Witness& witness, double rise) const noexcept;
  [[nodiscard]] double density(const Witness& witness, double difference, double noise, double moves) const noexcept;
  [[nodiscard]] double changed_share(std::span<const double> ratio, double sigma_ratio) const noexcept;
  [[nodiscard]] bool take_line(std::size_t line, const ConditionedFrame& frame, bool is_solved,
                               ConductanceFrame& conductance) noexcept;

  /// Of taxels first ... end - 1: the mean as long as a reading changes by no more than noise.
  void follow(std::size_t first, std::size_t end, std::span<const double> ratio, std::span<const double> siemens,
              double noise) noexcept;

  std::size_t rows_;
  std::size_t cols_;
  Axis axis_;  // of the lines whose readings share a supply
  std::size_t lines_;
  std::size_t places_;
  std::vector<double> load_siemens_;  // g [lines]; empty: nothing is known of the circuit, 0: no evidence
  std::vector<double> crossing_ohm_;  // R [taxels]
  std::vector<double> share_;         // x / (g + sum of x) of a reading of 1 [taxels]
  bool is_next_ = false;              // after the frame that is remembered
  bool has_last_ = false;
  Nanos last_time_{};
  std::vector<double> last_;          // readings; the mean of those that stay; NaN: unknown [taxels]
  std::vector<double> last_siemens_;  // likewise
  std::vector<std::uint8_t> frames_;  // for which a jump has not been believed [taxels]
  bool any_taken_ = false;            // of the last frame or this one
  double changed_ = 0.0;              // share of the loads of this frame
  NowAndBefore behind_;               // the crossing line: x; 0 where it is not known [taxels]
  NowAndBefore loads_;                // g and all x [lines]
  std::vector<std::size_t> jumps_;    // of the line
  std::vector<Doubt> doubts_;
};

}  // namespace dermis::touch::compensation
