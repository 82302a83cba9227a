// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/unloaded_taxels.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/lumped_circuit.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kMostCutOff = 0.05;      // of full scale: the most that readouts send as 0
constexpr double kOneCount = 1.5;         // less is no more than one: nothing but rounding cuts off below it
constexpr double kCutOffShare = 0.15;     // of the least unloaded reading: who has sent all of them cuts off less
constexpr std::size_t kFewestLines = 3;   // of either axis: the memory of rubber may hide shorter ones
constexpr double kFadedShare = 0.7;       // of an unloaded reading: rubber that conducts less may fade further
constexpr double kMostFaded = 0.25;       // of the taxels that read
constexpr double kForgotten = 1.0 / 8.0;  // of the older frames, in each

}  // namespace

UnloadedTaxels::UnloadedTaxels(const ArrayDescription& array, std::span<const double> siemens)
    : array_(array),
      smallest_reading_(kMostCutOff),
      siemens_(siemens.begin(), siemens.end()),
      ratio_(array.taxel_count()),
      least_reading_(array.taxel_count()),
      left_(array.sensed_lines()),
      pressed_lines_{std::vector<std::uint8_t>(array.rows), std::vector<std::uint8_t>(array.cols)} {
  assert(siemens.size() == array.taxel_count());
  for (double& of_taxel : siemens_) of_taxel = std::max(of_taxel, 0.0);
  if (array.readout.circuit == Circuit::none) {
    ratio_ = siemens_;
  } else {
    LumpedCircuit(array).solve(siemens_, ratio_);
    subtract_amplifier_offsets();
  }
  sent_reading_ = least_sent_reading();
}

/// A threshold of the device hides some taxels of an array from the calibration, or none and is far below.
double UnloadedTaxels::least_sent_reading() const {
  double least = kMostCutOff;
  const bool has_offsets = !array_.readout.amplifier_offset_v.empty();  // which may take all of a reading
  if (array_.rows < kFewestLines || array_.cols < kFewestLines || has_offsets) return least;
  for (std::size_t taxel = 0; taxel < ratio_.size(); ++taxel) {
    if (array_.is_absent(taxel)) continue;
    if (!(ratio_[taxel] > 0.0)) return kMostCutOff;
    least = std::min(least, kCutOffShare * ratio_[taxel]);
  }
  return least;
}

/// An input at an offset drives current through all taxels of its column, the touched ones too.
void UnloadedTaxels::subtract_amplifier_offsets() {
  const Readout& readout = array_.readout;
  if (readout.amplifier_offset_v.empty()) return;
  taken_off_.resize(array_.cols);
  for (std::size_t col = 0; col < array_.cols; ++col) {
    const double offset = readout.amplifier_offset_v[col] / *readout.supply_v;
    double of_column = 0.0;
    for (std::size_t row = 0; row < array_.rows; ++row) {
      double& reading = ratio_[array_.index(row, col)];
      of_column += reading;
      reading = std::max(reading - offset, 0.0);
    }
    taken_off_[col] = std::max(offset, 0.0) * (1.0 + kTouchedShare * of_column);
  }
}

void UnloadedTaxels::expect(const ConditionedFrame& conditioned, const LineSums& sums, std::size_t frame,
                            bool solved) noexcept {
  if (array_.readout.circuit == Circuit::none) {
    expect_beside_no_press(conditioned);
  } else {
    expect_beside_presses(sums, conditioned.sigma_ratio, solved);
    if (!taken_off_.empty()) take_off(conditioned.sigma_ratio);
  }
  const TaxelBlock block = TaxelBlock::of_frame(frame, ratio_.size());
  follow_smallest_reading(conditioned.ratio, block);
  if (sent_reading_ < smallest_reading_) follow_fading(conditioned, block);
  forget_what_may_be_cut_off(conditioned);
}

DERMIS_PROCESSOR_CLONES void UnloadedTaxels::follow_smallest_reading(std::span<const double> ratio,
                                                                     const TaxelBlock& block) noexcept {
  const double* const readings = ratio.data();
  const double smallest = smallest_reading_;
  std::uint64_t any_is_smaller = 0;
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    any_is_smaller |= (readings[taxel] > 0.0 ? 1U : 0U) & (readings[taxel] < smallest ? 1U : 0U);
  }
  if (any_is_smaller == 0) return;
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    if (readings[taxel] > 0.0) smallest_reading_ = std::min(smallest_reading_, readings[taxel]);
  }
}

/// Counts the readings that are there and lower than the loads of the frame explain.
DERMIS_PROCESSOR_CLONES void UnloadedTaxels::follow_fading(const ConditionedFrame& conditioned,
                                                           const TaxelBlock& block) noexcept {
  const double* const readings = conditioned.ratio.data();
  const float* const least = least_reading_.data();
  const double expected = kFadedShare / kUnloadedShare * conditioned.sigma_ratio;
  std::uint64_t reading = 0;
  std::uint64_t faded = 0;
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    const std::uint64_t is_reading = readings[taxel] > 0.0 ? 1U : 0U;
    reading += is_reading;
    faded += is_reading & (readings[taxel] < expected * static_cast<double>(least[taxel]) ? 1U : 0U);
  }
  if (reading == 0) return;
  faded_share_ += kForgotten * (static_cast<double>(faded) / static_cast<double>(reading) - faded_share_);
}

/// An offset takes as much from a conductance that has faded as from one that has not.
void UnloadedTaxels::take_off(double sigma_ratio) noexcept {
  for (std::size_t taxel = 0; taxel < least_reading_.size(); ++taxel) {
    least_reading_[taxel] -= static_cast<float>(taken_off(taxel) / sigma_ratio);
  }
}

DERMIS_PROCESSOR_CLONES void UnloadedTaxels::forget_what_may_be_cut_off(const ConditionedFrame& conditioned) noexcept {
  const Readout& readout = array_.readout;
  const double count_ratio = conditioned.sigma_ratio / (conditioned.noise_growth * readout.adc_noise_counts);
  const double sent = faded_share_ > kMostFaded ? smallest_reading_ : std::min(sent_reading_, smallest_reading_);
  const bool sends_one_count = readout.quantity == Quantity::counts && sent < kOneCount * count_ratio;
  const double most_cut_off = sends_one_count ? kRoundedToNone * count_ratio : sent;
  const auto cut_off =
      static_cast<float>(std::max(most_cut_off / conditioned.sigma_ratio, hum_sigmas(conditioned.noise_growth)));
  for (float& least : least_reading_) least = least > cut_off ? least : 0.0F;
}

/// Pressed taxels on the sensed line of an unloaded one take the share of the supply that they read themselves. Pressed
/// taxels on its driven line pull the line down.
DERMIS_PROCESSOR_CLONES void UnloadedTaxels::expect_beside_presses(const LineSums& sums, double sigma_ratio,
                                                                   bool solved) noexcept {
  const Readout& readout = array_.readout;
  const Axis driven = driven_axis(array_);
  const bool shares = readout.circuit == Circuit::divider || readout.circuit == Circuit::flexitac;
  const std::span<const double> taken = sums.ratio(crossing(driven));
  for (std::size_t line = 0; line < left_.size(); ++line) {
    left_[line] = shares ? std::clamp(1.0 - taken[line], 0.0, 1.0) : 1.0;
  }
  const std::span<const double> line_siemens = sums.driven_siemens();
  const auto sag = [&](std::size_t line) {
    return solved ? 1.0 / (1.0 + readout.drive_ohm[line] * line_siemens[line]) : kUnloadedShare;
  };
  const double scale = kUnloadedShare / sigma_ratio;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const double* const unloaded = &ratio_[row * array_.cols];
    float* const least = &least_reading_[row * array_.cols];
    if (driven == Axis::row) {
      const double factor = scale * sag(row);
      for (std::size_t col = 0; col < array_.cols; ++col) {
        least[col] = static_cast<float>(factor * unloaded[col] * left_[col]);
      }
    } else {
      const double factor = scale * left_[row];
      for (std::size_t col = 0; col < array_.cols; ++col) {
        least[col] = static_cast<float>(factor * unloaded[col] * sag(col));
      }
    }
  }
}

/// In an unknown circuit the effect of a press on the taxels of its lines is unknown.
void UnloadedTaxels::expect_beside_no_press(const ConditionedFrame& conditioned) noexcept {
  find_pressed_lines(conditioned);
  for (std::size_t taxel = 0; taxel < ratio_.size(); ++taxel) {
    const bool beside = pressed_lines_.row[taxel / array_.cols] != 0 || pressed_lines_.column[taxel % array_.cols] != 0;
    const double expected = beside ? 0.0 : kUnloadedShare * ratio_[taxel];
    least_reading_[taxel] = static_cast<float>(expected / conditioned.sigma_ratio);
  }
}

void UnloadedTaxels::find_pressed_lines(const ConditionedFrame& conditioned) noexcept {
  for (const Axis axis : kAxes) std::fill(pressed_lines_[axis].begin(), pressed_lines_[axis].end(), std::uint8_t{0});
  for (std::size_t taxel = 0; taxel < ratio_.size(); ++taxel) {
    const double most = touched_above(ratio_[taxel], conditioned.sigma_ratio, kMostSigmas);
    if (conditioned.ratio[taxel] <= most) continue;
    pressed_lines_.row[taxel / array_.cols] = 1;
    pressed_lines_.column[taxel % array_.cols] = 1;
  }
}

}  // namespace dermis::touch::compensation
