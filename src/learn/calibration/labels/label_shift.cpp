// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/label_shift.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace dermis::learn::calibration {
namespace {

constexpr std::ptrdiff_t kMostShift = 10;
constexpr std::size_t kLeastForShift = 20;  // frames
constexpr double kClearCorrelation = 0.5;
constexpr double kPoorCorrelation = 0.9;
constexpr std::size_t kLeastMended = 10;  // frames whose label a shift makes right

/// Places of the values when they rise, from -1 to 1; equal values share theirs.
template <typename Value>
std::vector<double> ranks(std::span<const FrameSum> sums, Value value) {
  std::vector<std::uint32_t> order(sums.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return value(sums[a]) < value(sums[b]); });
  std::vector<double> rank(sums.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last < order.size() && value(sums[order[last]]) == value(sums[order[first]])) ++last;
    const double place = static_cast<double>(first + last) / static_cast<double>(order.size()) - 1.0;
    for (; first < last; ++first) rank[order[first]] = place;
  }
  return rank;
}

/// visit(k) for all labelled frames k that have a frame `shift` later.
template <typename Visit>
void for_each_labelled(std::span<const FrameSum> sums, std::ptrdiff_t shift, Visit visit) {
  const auto size = static_cast<std::ptrdiff_t>(sums.size());
  for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(-shift, 0); k < std::min(size, size - shift); ++k) {
    if (sums[static_cast<std::size_t>(k)].is_labelled()) visit(static_cast<std::size_t>(k));
  }
}

std::size_t later(std::size_t frame, std::ptrdiff_t shift) {
  return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(frame) + shift);
}

struct Shift {
  std::ptrdiff_t frames = 0;  // that the readings are later
  double score = 0.0;
};

/// The shift of the highest score; of equal ones the smallest.
template <typename Score>
Shift best_shift(Score score) {
  Shift best{0, score(0)};
  for (std::ptrdiff_t distance = 1; distance <= kMostShift; ++distance) {
    for (const std::ptrdiff_t shift : {-distance, distance}) {
      const double shifted = score(shift);
      if (shifted > best.score) best = {shift, shifted};
    }
  }
  return best;
}

std::string sentence(const Shift& shift, const std::string& evidence) {
  return fmt::format("the loads fit the readings {} frame{} {} ({}): check them", std::abs(shift.frames),
                     std::abs(shift.frames) == 1 ? "" : "s", shift.frames > 0 ? "later" : "earlier", evidence);
}

// ------------------------------------------------------------------------------------------------------------ forces

/// Rank correlation of loads and readings.
class ForceAgreement {
 public:
  explicit ForceAgreement(std::span<const FrameSum> sums)
      : sums_(sums),
        readings_(ranks(sums, [](const FrameSum& sum) { return sum.ratio; })),
        loads_(ranks(sums, [](const FrameSum& sum) { return sum.is_labelled() ? sum.newtons : -1.0; })) {}

  [[nodiscard]] double at(std::ptrdiff_t shift) const {
    double count = 0.0;
    double x = 0.0;
    double y = 0.0;
    for_each_labelled(sums_, shift, [&](std::size_t k) {
      count += 1.0;
      x += loads_[k];
      y += readings_[later(k, shift)];
    });
    if (count < static_cast<double>(kLeastForShift)) return 0.0;
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    for_each_labelled(sums_, shift, [&](std::size_t k) {
      const double dx = loads_[k] - x / count;
      const double dy = readings_[later(k, shift)] - y / count;
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    });
    return xx * yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
  }

 private:
  std::span<const FrameSum> sums_;
  std::vector<double> readings_;
  std::vector<double> loads_;
};

std::optional<std::string> remark_by_force(std::span<const FrameSum> sums) {
  const ForceAgreement agreement(sums);
  const double now = agreement.at(0);
  if (now > kPoorCorrelation) return std::nullopt;
  const Shift best = best_shift([&](std::ptrdiff_t shift) { return agreement.at(shift); });
  if (best.score < kClearCorrelation || 2.0 * (1.0 - best.score) > 1.0 - now) return std::nullopt;
  return sentence(best, fmt::format("rank correlation {:.2f}, as labelled {:.2f}", best.score, now));
}

// ------------------------------------------------------------------------------------------------------------ places

/// Frames whose strongest taxel is in a region that their load names.
class PlaceAgreement {
 public:
  PlaceAgreement(std::span<const FrameSum> sums, const LoadsOfFrames& loads, const ArrayDescription& array)
      : sums_(sums), loads_(loads), array_(array) {}

  struct Frames {
    std::size_t right = 0;
    std::size_t wrong = 0;
    [[nodiscard]] double share_right() const {
      return static_cast<double>(right) / static_cast<double>(std::max<std::size_t>(right + wrong, 1));
    }
  };

  [[nodiscard]] Frames at(std::ptrdiff_t shift) const {
    Frames frames;
    for_each_labelled(sums_, shift, [&](std::size_t k) {
      if (!tells_place(sums_[k].frame)) return;
      ++(is_pressed_at(sums_[k].frame, sums_[later(k, shift)].strongest) ? frames.right : frames.wrong);
    });
    return frames;
  }

 private:
  [[nodiscard]] bool tells_place(std::size_t frame) const {
    bool is_loaded = false;
    for (const Load& load : loads_[frame]) {
      if (load.where == all_taxels(array_)) return false;
      is_loaded = is_loaded || load.value > 0.0;
    }
    return is_loaded;
  }

  [[nodiscard]] bool is_pressed_at(std::size_t frame, std::size_t taxel) const {
    const std::size_t row = taxel / array_.cols;
    const std::size_t col = taxel % array_.cols;
    const std::span<const Load> loads = loads_[frame];
    return std::any_of(loads.begin(), loads.end(), [&](const Load& load) {
      const TaxelRegion& where = load.where;
      return load.value > 0.0 && where.first_row <= row && row <= where.last_row && where.first_col <= col &&
             col <= where.last_col;
    });
  }

  std::span<const FrameSum> sums_;
  const LoadsOfFrames& loads_;
  const ArrayDescription& array_;
};

std::optional<std::string> remark_by_place(std::span<const FrameSum> sums, const LoadsOfFrames& loads,
                                           const ArrayDescription& array) {
  const PlaceAgreement agreement(sums, loads, array);
  const PlaceAgreement::Frames now = agreement.at(0);
  if (now.wrong < kLeastMended) return std::nullopt;
  const Shift best = best_shift([&](std::ptrdiff_t shift) { return agreement.at(shift).share_right(); });
  const PlaceAgreement::Frames shifted = agreement.at(best.frames);
  if (now.wrong < shifted.wrong + kLeastMended || 2 * shifted.wrong > now.wrong) return std::nullopt;
  return sentence(best, fmt::format("{} of {} then press where the array feels it, as labelled {} of {}", shifted.right,
                                    shifted.right + shifted.wrong, now.right, now.right + now.wrong));
}

}  // namespace

std::optional<std::string> remark_on_shift(std::span<const FrameSum> sums, const LoadsOfFrames& loads,
                                           const ArrayDescription& array) {
  auto remark = remark_by_place(sums, loads, array);
  return remark ? remark : remark_by_force(sums);
}

}  // namespace dermis::learn::calibration
