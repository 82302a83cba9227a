// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/paper/network_bank.hpp"
#include "dermis/paper/ranks.hpp"

namespace dermis::paper {

/// The name of the bank among the estimators of an evaluation.
inline constexpr const char* kPaperBankName = "paper_bank";

/// The shape of the paper's networks (Fig. 8), N-N-N-1 for N taxels, log-sigmoid in all layers. There are N inputs, N
/// neurons in both hidden layers and one output. If temperature is an input, there is one input more.
[[nodiscard]] NetworkShape paper_network_shape(std::size_t taxels, bool with_temperature);

/// Unknowns of the whole bank for N taxels, without temperature: 2 N^3 + N^2 connections and 2 N^2 + N thresholds;
/// 33,751,296 for 16 x 16.
[[nodiscard]] constexpr std::size_t paper_bank_unknowns(std::size_t taxels) noexcept {
  return taxels * (2 * taxels * taxels + taxels) + taxels * (2 * taxels + 1);
}

/// The largest bank that is trained or read: 2 GiB of weights, 25 x 25 taxels.
inline constexpr std::size_t kMostUnknowns = std::size_t{1} << 29U;

/// The paper's estimator (Fig. 7): a bank of N-N-N-1 BP networks, one a taxel. Each sees the readings of the whole
/// array and gives the force on its own taxel. Crosstalk, material and temperature are all left to the networks.
///
/// All values are normalised to the range of the calibration. Inputs become [0, 1]. A force of 0 ... heaviest_newtons
/// becomes an output of 0.25 ... 0.75, where the paper starts its output neurons (eq. (13), (14)). Supply fluctuation
/// is divided out of the readings before (unit 2), so that the voltage is the ratio of the reading to the supply.
class PaperBank : public learn::calibration::FurtherEstimator {
 public:
  struct Range {
    double low = 0.0;
    double high = 1.0;  ///< > low
  };

  /// All parameters 0. `ratio` [taxels]; a temperature range makes temperature an input. With the networks of some
  /// taxels alone, it cannot estimate.
  PaperBank(std::vector<Range> ratio, std::optional<Range> celsius, double heaviest_newtons,
            std::optional<Part> taxels = {});

  [[nodiscard]] std::string name() const override { return kPaperBankName; }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] std::size_t taxel_count() const noexcept override { return ratio_.size(); }
  [[nodiscard]] const std::vector<Range>& ratio() const noexcept { return ratio_; }
  [[nodiscard]] const std::optional<Range>& celsius() const noexcept { return celsius_; }
  [[nodiscard]] double heaviest_newtons() const noexcept { return heaviest_newtons_; }
  /// The taxels whose networks it has.
  [[nodiscard]] Part part() const noexcept { return part_; }
  [[nodiscard]] NetworkBank& networks() noexcept { return networks_; }
  [[nodiscard]] const NetworkBank& networks() const noexcept { return networks_; }

  /// Network inputs [inputs] of a frame: ratio = reading / supply [taxels]. Without a temperature the middle of the
  /// range is taken.
  void normalise(std::span<const double> ratio, std::optional<double> temperature_celsius,
                 std::span<float> inputs) const noexcept;
  /// Network output of a force [N].
  [[nodiscard]] float target(double newtons) const noexcept;

  /// ratio [taxels] -> newtons [taxels], not below 0. Not thread-safe.
  void estimate(std::span<const double> ratio, std::optional<double> temperature_celsius,
                std::span<float> newtons) override;

 private:
  std::vector<Range> ratio_;
  std::optional<Range> celsius_;
  double heaviest_newtons_;
  Part part_;
  NetworkBank networks_;
  std::vector<float> inputs_;
};

}  // namespace dermis::paper
