// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

enum class ReadingVerdict { possible, unknown, shorted, impossible };

/// Which readings of a frame no conductances explain. The current of a driven line comes through its driver, and at
/// least what all readings of the line carry away leaves it. So the voltage across a taxel is at most
///
///   slack_kj = 1 - Rd_k sum_j' I_kj' - V_kj        (one loaded column: - Rd_k I_kj)
///
/// and its resistance at most slack / I, if no other taxel carries current to the line. Where idle rows float others
/// do; then slack / I is that of them all, and low only under a wide press. Where idle rows are grounded, the
/// readings of a column are together less than the supply. Their sum is the reading with all rows driven at once. For
/// one column alone, the rest of the supply gives the resistances,
///
///   Rd_k + 1 / G_kj  =  RL_j (1 - sum_k' r_k'j) / r_kj
///
/// and with others it is near that while drivers are strong. A driven and a sensed line are one node if both stand at
/// the same voltage with all driven, U_k = 1 - Rd_k sum_j I_kj and W_j = sum_k r_kj, whatever else conducts. Taxels of
/// many ohm can have that by chance, too. So each driven line of the node must be one with each sensed line, and most
/// of their current must be their own: then the taxels between them are a few ohm. A film brings further current
/// to a line, so that fewer ohm are a short. No film lifts a line above the driven one. A reading that was
/// taken away in the last frame must stay further from its limits. Many members: facts of the lines and work space, as
/// check() may not allocate.
class PossibleReadings {
 public:
  explicit PossibleReadings(const ArrayDescription& array);

  /// From the next frame on, the row and the column of each of these taxels are known to be one. Allocates nothing.
  void set_shorted(std::span<const std::size_t> taxels) noexcept;

  /// Taxels become invalid whose reading the circuit cannot give, or only where row and column touch. The worst of a
  /// line are first; all of a line where they are many. `sigma_ratio` is the noise of a reading. Allocates nothing.
  void check(std::span<const double> ratio, double sigma_ratio, std::span<TaxelStatus> taxels) noexcept;

  /// The verdict on each reading; `unknown` where it is invalid, and on a line with many bad ones, where none counts.
  /// The worst of a line is judged first: the current of an impossible reading is not there, that of a short is.
  /// `verdicts` [taxels]. Allocates nothing.
  void judge(std::span<const double> ratio, double sigma_ratio, std::span<const TaxelStatus> taxels,
             std::span<ReadingVerdict> verdicts) noexcept;

  /// A reading over that of a taxel of 0 ohm alone.
  [[nodiscard]] double share_of_most(std::size_t taxel, double ratio) const noexcept {
    return ratio / most_ratio_[taxel];
  }

  /// The largest reading of each line that has little left of the supply becomes invalid, or the largest of all; false:
  /// there is none.
  bool take_largest(std::span<const double> ratio, std::span<TaxelStatus> taxels) noexcept;

  /// All readings of these lines become invalid; false: there is no such line.
  bool take_full_lines(std::span<const double> ratio, std::span<TaxelStatus> taxels) noexcept;

  void forget() noexcept;

 private:
  /// The head of a sensed line, as its reading shows it.
  struct Head {
    double current = 0.0;    ///< of a ratio of 1
    double offset = 0.0;     ///< the current of a ratio of 0
    double ohm = 0.0;        ///< to
    double emf = 0.0;        ///< this voltage
    double short_ohm = 0.0;  ///< No taxel has less.
    double most_sum = 0.0;   ///< Sum of its readings below which none is a short.
  };

  /// Where no reading of a frame is near its limits, these suffice [sensed].
  struct Limits {
    std::vector<double> current;  ///< of a ratio of 1
    std::vector<double> offset;   ///< the current of a ratio of 0
    std::vector<double> ohm;      ///< of the head and a taxel of short_ohm
    std::vector<double> emf;
  };

  [[nodiscard]] std::size_t taxel_of(std::size_t driven, std::size_t sensed) const noexcept {
    return rows_are_driven_ ? driven * cols_ + sensed : sensed * cols_ + driven;
  }
  [[nodiscard]] double current(std::size_t sensed, double ratio) const noexcept {
    return heads_[sensed].current * ratio + heads_[sensed].offset;
  }
  [[nodiscard]] bool was_taken(std::size_t taxel) const noexcept { return last_taken_[taxel] != 0; }
  [[nodiscard]] bool any_may_exceed(std::span<const double> ratio) noexcept;
  void add_up(const double* readings) noexcept;

  /// Of the supply, at a driven line.
  struct Slack {
    double left;   ///< by the driver
    double least;  ///< and by the taxel that has least
  };
  [[nodiscard]] Slack find_slack(std::size_t driven, const double* readings) const noexcept;
  [[nodiscard]] bool is_clean(std::size_t driven, std::span<const double> ratio,
                              std::span<const ReadingVerdict> verdicts) noexcept;
  [[nodiscard]] const double* readings_of(std::size_t driven, std::span<const double> ratio) noexcept;
  void judge_joined(std::span<const double> ratio, double sigma_ratio, std::span<ReadingVerdict> verdicts) noexcept;
  [[nodiscard]] bool are_joined(std::size_t driven, std::size_t sensed, std::span<const double> ratio,
                                double sigma_ratio) const noexcept;
  [[nodiscard]] bool are_one_node(std::size_t driven, std::size_t sensed, std::span<const double> ratio,
                                  double sigma_ratio, double allowed) const noexcept;
  std::size_t judge_driven(std::size_t driven, std::span<const double> ratio, double sigma_ratio,
                           std::span<ReadingVerdict> verdicts) noexcept;
  void judge_sensed(std::size_t sensed, std::span<const double> ratio, double sigma_ratio,
                    std::span<ReadingVerdict> verdicts) const noexcept;
  void doubt_bad_lines(std::span<ReadingVerdict> verdicts) const noexcept;

  /// The rest of the slack, negative where the verdict is not `possible`, and what a drop at the driver takes of it.
  struct Margins {
    double of_short;
    double of_circuit;
    double share_of_short;
  };
  [[nodiscard]] Margins margins(std::size_t driven, std::size_t sensed, double own, double sigma_ratio) const noexcept;

  std::size_t cols_;
  bool rows_are_driven_;
  bool one_loaded_;
  bool sums_are_bounded_;           // of the readings of a column
  bool lines_may_be_joined_;        // driven with sensed ones, so that it shows
  std::vector<double> most_ratio_;  // [taxels]; infinite where nothing limits it
  std::vector<double> drive_ohm_;   // [driven]; empty: the circuit is not known
  std::vector<Head> heads_;         // [sensed]
  Limits limits_;
  std::vector<double> sums_;              // of readings [sensed]
  std::vector<Margins> margins_;          // of a driven line [sensed]
  std::vector<double> line_;              // readings of a driven line [sensed]
  std::vector<double> totals_;            // currents of the driven lines [driven]
  std::vector<ReadingVerdict> verdicts_;  // [taxels]
  std::vector<std::uint8_t> known_;       // to be shorted [taxels]
  std::vector<std::uint8_t> joined_;      // lines, by the taxels where they cross [taxels]
  std::vector<std::uint8_t> taken_;       // from this frame [taxels]
  std::vector<std::uint8_t> last_taken_;  // from the one before [taxels]
  bool any_taken_ = false;
};

}  // namespace dermis::touch::compensation
