// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/taxel_block.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::recognition {

std::size_t taxels_of(const Layout& layout) {
  std::size_t taxels = 0;
  for (const SensedArray& array : layout.arrays) taxels += array.taxel_count();
  return taxels;
}

TaxelBlock::TaxelBlock(const SensedArray& examples, const Lattice& lattice)
    : taxels_(examples.taxel_count()),
      regrid_({.rows = lattice.rows, .cols = lattice.cols}, {.rows = examples.rows, .cols = examples.cols}),
      sum_(lattice.taxels()),
      squares_(lattice.taxels()),
      moment_(lattice.taxels()),
      image_(lattice.taxels()) {}

std::vector<FeatureGroup> TaxelBlock::course_groups(const Layout& layout, bool moving) {
  const std::size_t taxels = taxels_of(layout);
  std::vector<FeatureGroup> groups{{"mean of each taxel", FeatureAspect::place, taxels}};
  if (!moving) return groups;
  groups.push_back({"deviation of each taxel", FeatureAspect::time, taxels});
  groups.push_back({"mean change of each taxel", FeatureAspect::time, taxels});
  return groups;
}

void TaxelBlock::begin() {
  frames_ = 0;
  std::fill(sum_.begin(), sum_.end(), 0.0);
  std::fill(squares_.begin(), squares_.end(), 0.0);
}

void TaxelBlock::add(std::span<const double> frame) {
  ++frames_;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    sum_[i] += frame[i];
    squares_[i] += frame[i] * frame[i];
  }
}

void TaxelBlock::write_roots(std::span<const double> image, std::span<double> out) {
  std::transform(image.begin(), image.end(), image_.begin(), [](double value) { return static_cast<float>(value); });
  regrid_.apply(image_, out);
  for (double& value : out) value = std::sqrt(value);
}

void TaxelBlock::write_mean(std::span<double> out) {
  const auto count = static_cast<double>(frames_);
  std::transform(sum_.begin(), sum_.end(), moment_.begin(), [&](double sum) { return sum / count; });
  write_roots(moment_, out);
}

void TaxelBlock::write_deviation(std::span<double> out) {
  const auto count = static_cast<double>(frames_);
  std::transform(sum_.begin(), sum_.end(), squares_.begin(), moment_.begin(), [&](double sum, double squares) {
    const double mean = sum / count;
    return std::sqrt(std::max(squares / count - mean * mean, 0.0));
  });
  write_roots(moment_, out);
}

}  // namespace dermis::learn::recognition
