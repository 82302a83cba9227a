// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/felt_loads.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>

#include "dermis/touch/frames/cover.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastShare = 1e-4;      // of the heaviest force of a frame
constexpr double kWellKnownShare = 0.02;  // the same
constexpr double kRounding = 0.999;

/// The taxels that feel a force on `region`.
TaxelRegion felt_region(const TaxelRegion& region, const ArrayDescription& array, const CoverKernel& kernel) {
  return {region.first_row - std::min(region.first_row, kernel.row_reach()),
          region.first_col - std::min(region.first_col, kernel.col_reach()),
          std::min(region.last_row + kernel.row_reach(), array.rows - 1),
          std::min(region.last_col + kernel.col_reach(), array.cols - 1)};
}

TaxelRegion both(const TaxelRegion& a, const TaxelRegion& b) {
  return {std::min(a.first_row, b.first_row), std::min(a.first_col, b.first_col), std::max(a.last_row, b.last_row),
          std::max(a.last_col, b.last_col)};
}

bool is_shared(const Load& load) {
  return load.kind == LoadKind::force && load.where.taxel_count() > 1;
}

/// The loads of one frame after another.
class FeltFrame {
 public:
  explicit FeltFrame(const ArrayDescription& array)
      : array_(array), kernel_(array), surface_(array.taxel_count()), felt_(array.taxel_count()) {}

  void add_each(std::span<const Load> loads, std::vector<Load>& felt) {
    for (const Load& load : loads) {
      if (load.value == 0.0) felt.push_back(load);
      if (load.value > 0.0 && is_shared(load)) felt.push_back(total({&load, 1}));
    }
    spread(loads, [](const Load& load) { return !is_shared(load); });
    append(loads.front().frame, felt);
  }

  /// As far as it does not fall beyond the rim, were each load alike on all its taxels.
  [[nodiscard]] Load total(std::span<const Load> loads) {
    spread(loads, [](const Load&) { return true; });
    TaxelRegion where = felt_region(loads.front().where, array_, kernel_);
    for (const Load& load : loads) where = both(where, felt_region(load.where, array_, kernel_));
    return {loads.front().frame, LoadKind::force, where, std::reduce(felt_.begin(), felt_.end())};
  }

 private:
  /// Spreads some of the loads into `felt_`.
  template <typename Predicate>
  void spread(std::span<const Load> loads, Predicate counts) {
    std::fill(surface_.begin(), surface_.end(), 0.0);
    for (const Load& load : loads) {
      if (!counts(load)) continue;
      const double newtons = total_newtons(load, array_) / static_cast<double>(load.where.taxel_count());
      for (const std::size_t taxel : taxel_indices(load.where, array_.cols)) surface_[taxel] = newtons;
    }
    for (const std::size_t taxel : array_.absent) surface_[taxel] = 0.0;
    kernel_.spread(std::span<const double>(surface_), std::span<double>(felt_));
  }

  void append(std::size_t frame, std::vector<Load>& felt) const {
    const double most = *std::max_element(felt_.begin(), felt_.end());
    for (std::size_t taxel = 0; taxel < felt_.size(); ++taxel) {
      if (!(felt_[taxel] > kLeastShare * most)) continue;
      const std::size_t row = taxel / array_.cols;
      const std::size_t col = taxel % array_.cols;
      felt.push_back({frame, LoadKind::force, {row, col, row, col}, felt_[taxel]});
    }
  }

  const ArrayDescription& array_;
  CoverKernel kernel_;
  std::vector<double> surface_;  // [taxels]
  std::vector<double> felt_;     // [taxels]
};

std::map<std::size_t, std::vector<Load>> by_frame(std::span<const Load> loads) {
  std::map<std::size_t, std::vector<Load>> frames;
  for (const Load& load : loads) frames[load.frame].push_back(load);
  return frames;
}

}  // namespace

std::vector<Load> felt_loads(const ArrayDescription& array, std::span<const Load> loads) {
  if (!array.cover) return {loads.begin(), loads.end()};
  FeltFrame frame(array);
  std::vector<Load> felt;
  for (const auto& [index, of_frame] : by_frame(loads)) frame.add_each(of_frame, felt);
  return felt;
}

std::vector<Load> well_felt_loads(const ArrayDescription& array, std::span<const Load> loads) {
  std::vector<Load> felt = felt_loads(array, loads);
  if (!array.cover) return felt;
  double lightest = std::numeric_limits<double>::infinity();
  for (const Load& load : loads) {
    if (load.value > 0.0 && !is_shared(load)) lightest = std::min(lightest, total_newtons(load, array));
  }
  lightest *= CoverKernel(array).share(0, 0);
  std::map<std::size_t, double> most;
  for (const Load& load : felt) most[load.frame] = std::max(most[load.frame], load.value);
  for (Load& load : felt) {
    if (load.value == 0.0 || is_shared(load)) continue;
    const double least = std::max(kRounding * lightest, kWellKnownShare * most[load.frame]);
    if (load.value < least) load.value = std::numeric_limits<double>::quiet_NaN();
  }
  return felt;
}

std::vector<Load> felt_totals(const ArrayDescription& array, std::span<const Load> loads) {
  if (!array.cover) return {loads.begin(), loads.end()};
  FeltFrame frame(array);
  std::vector<Load> felt;
  for (const auto& [index, of_frame] : by_frame(loads)) felt.push_back(frame.total(of_frame));
  return felt;
}

}  // namespace dermis::learn::calibration
