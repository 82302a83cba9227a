// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/instrument_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dermis/touch/preprocessing/adc_correction.hpp"
#include "learn/calibration/mean.hpp"

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kCurvePoints = 33;
constexpr double kMost = 3.0;  // of what is usual

Index parameters_of(InstrumentPart part, const ArrayDescription& array) {
  return part == InstrumentPart::drivers ? static_cast<Index>(array.driven_lines()) : 1;
}

double step_of(InstrumentPart part) {
  switch (part) {
    case InstrumentPart::offset: return 1.0;
    case InstrumentPart::curve: return 1e-3;
    default: return 0.01;
  }
}

/// A bow: 0 at both ends of the ADC, 1 in its middle.
double bow(double share) {
  return 4.0 * share * (1.0 - share);
}

/// Slope of a bowed curve at the readings of idle taxels: the noise there follows it.
double idle_slope(double height, const Readout& readout) {
  constexpr double kSlopeOfBow = 4.0;  // at its ends
  return std::abs(1.0 - (readout.pressure_raises_reading ? kSlopeOfBow : -kSlopeOfBow) * height);
}

std::vector<AdcPoint> bowed_curve(double height, double full_scale) {
  std::vector<AdcPoint> curve;
  for (int k = 0; k < kCurvePoints; ++k) {
    const double sent = static_cast<double>(k) / (kCurvePoints - 1);
    curve.push_back({sent * full_scale, (sent - height * bow(sent)) * full_scale});
  }
  return curve;
}

}  // namespace

InstrumentParameters::InstrumentParameters(const ArrayDescription& array, std::vector<InstrumentPart> parts)
    : array_(array), parts_(std::move(parts)), load_ohm_(mean_of(array.readout.load_ohm)) {
  for (const InstrumentPart part : parts_) count_ += parameters_of(part, array_);
}

/// visit(part, place of its first parameter, their number)
template <typename Visit>
void InstrumentParameters::visit_parts(const Visit& visit) const {
  for (std::size_t place = 0; place < parts_.size(); ++place) visit(parts_[place], first_of(place), size_of(place));
}

Index InstrumentParameters::size_of(std::size_t place) const {
  return parameters_of(parts_[place], array_);
}

Index InstrumentParameters::first_of(std::size_t place) const {
  Index first = 0;
  for (std::size_t k = 0; k < place; ++k) first += size_of(k);
  return first;
}

VectorXd InstrumentParameters::steps() const {
  VectorXd steps(count_);
  visit_parts(
      [&](InstrumentPart part, Index first, Index size) { steps.segment(first, size).setConstant(step_of(part)); });
  return steps;
}

VectorXd InstrumentParameters::usual() const {
  const auto usual_of = [&](InstrumentPart part) {
    switch (part) {
      case InstrumentPart::offset: return 0.01 * array_.readout.full_scale_counts();
      case InstrumentPart::supply: return 0.1;
      case InstrumentPart::curve: return 0.01;
      case InstrumentPart::drivers: return 0.5;
    }
    return 1.0;
  };
  VectorXd usual(count_);
  visit_parts(
      [&](InstrumentPart part, Index first, Index size) { usual.segment(first, size).setConstant(usual_of(part)); });
  return usual;
}

VectorXd InstrumentParameters::possible(VectorXd values) const {
  const VectorXd most = kMost * usual();
  visit_parts([&](InstrumentPart part, Index first, Index size) {
    if (part != InstrumentPart::drivers) values[first] = std::clamp(values[first], -most[first], most[first]);
    if (part == InstrumentPart::supply) values[first] = std::max(values[first], 0.0);
    if (part != InstrumentPart::drivers) return;
    for (Index k = 0; k < size; ++k) {
      const double least = -array_.readout.drive_ohm[static_cast<std::size_t>(k)] / load_ohm_;
      values[first + k] = std::max(values[first + k], least);
    }
  });
  return values;
}

bool InstrumentParameters::are_within_bounds(const VectorXd& values) const {
  const VectorXd most = kMost * usual();
  bool are_within = true;
  visit_parts([&](InstrumentPart part, Index first, Index) {
    are_within = are_within && (part == InstrumentPart::drivers || std::abs(values[first]) < most[first]);
  });
  return are_within;
}

ArrayDescription InstrumentParameters::array_at(const VectorXd& values) const {
  ArrayDescription array = array_;
  Readout& readout = array.readout;
  visit_parts([&](InstrumentPart part, Index first, Index size) {
    const double value = values[first];
    if (part == InstrumentPart::offset) readout.adc_errors.offset_counts = value;
    if (part == InstrumentPart::supply) readout.supply_ohm = value * load_ohm_;
    if (part == InstrumentPart::curve) readout.adc_errors.curve = bowed_curve(value, readout.full_scale_counts());
    if (part != InstrumentPart::drivers) return;
    for (Index k = 0; k < size; ++k) readout.drive_ohm[static_cast<std::size_t>(k)] += values[first + k] * load_ohm_;
  });
  return array;
}

CircuitFrame InstrumentParameters::corrected(const CircuitFrame& frame, const VectorXd& values) const {
  const Readout& readout = array_.readout;
  const double noise_counts = readout.adc_noise_counts * touch::preprocessing::noise_gain(readout.adc_errors);
  const double per_count = frame.described_sigma / noise_counts;
  const double full_ratio = per_count * readout.full_scale_counts();
  CircuitFrame result = frame;
  visit_parts([&](InstrumentPart part, Index first, Index) {
    const bool is_of_adc = part == InstrumentPart::offset || part == InstrumentPart::curve;
    if (!is_of_adc) return;
    if (part == InstrumentPart::curve) result.sigma_ratio *= idle_slope(values[first], readout);
    for (std::size_t taxel = 0; taxel < frame.ratio.size(); ++taxel) {
      const double share =
          (readout.pressure_raises_reading ? frame.ratio[taxel] : 1.0 - frame.ratio[taxel]) / full_ratio;
      const double counts =
          part == InstrumentPart::offset ? values[first] : values[first] * bow(share) * readout.full_scale_counts();
      result.ratio[taxel] -= (readout.pressure_raises_reading ? counts : -counts) * per_count;
    }
  });
  return result;
}

Result<InvertedFrames> InstrumentParameters::invert(const std::vector<const CircuitFrame*>& frames,
                                                    const VectorXd& values) const {
  std::vector<CircuitFrame> changed;
  std::vector<const CircuitFrame*> pointers;
  changed.reserve(frames.size());
  for (const CircuitFrame* const frame : frames) {
    changed.push_back(corrected(*frame, values));
    pointers.push_back(&changed.back());
  }
  return invert_frames(array_at(values), pointers);
}

}  // namespace dermis::learn::calibration
