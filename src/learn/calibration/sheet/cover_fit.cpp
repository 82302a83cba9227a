// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/cover_fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "dermis/touch/frames/cover.hpp"
#include "dermis/touch/frames/millimetres.hpp"
#include "learn/calibration/circuit_fit/circuit_trial.hpp"
#include "learn/calibration/sheet/cover_shares.hpp"
#include "learn/calibration/sheet/single_presses.hpp"
#include "learn/calibration/sheet/taxel_curves.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastLines = 3;
constexpr std::size_t kLeastPairs = 8;
constexpr double kSigmas = 5.0;              // what must not be chance
constexpr double kOverFar = 4.0;             // of what taxels far away show
constexpr double kLeastShare = 3e-4;         // across a corner, of the centre's
constexpr double kQuestionableShare = 0.01;  // the same
constexpr double kMostScatter = 0.6;         // of pairs of taxels
constexpr double kAlike = 1.08;              // spreads along rows and columns, one over the other
constexpr double kLeastCorner = 0.4;         // of the product of both neighbours
constexpr std::size_t kMostReach = 12;
constexpr double kKeptSigmas = 3.0;
constexpr double kLeastKept = 2e-4;       // of the centre's share
constexpr double kErrorOfShares = 0.005;  // that their noise does not show
constexpr double kGaussianError = 0.012;  // of all shares together
constexpr double kErrorOfLines = 0.1;     // of all shares together, where curves are straight lines
constexpr double kGuessedDriveOhm = 30.0;
constexpr double kGuessedLoadOhm = 1000.0;

/// The described circuit, what is unknown of it guessed.
ArrayDescription guessed(ArrayDescription array) {
  Readout& readout = array.readout;
  readout.film = readout.film && readout.film->is_unknown() ? std::nullopt : readout.film;
  if (readout.circuit == Circuit::automatic) return without_circuit(array);
  for (double& ohm : readout.drive_ohm) ohm = std::isnan(ohm) ? kGuessedDriveOhm : ohm;
  for (double& ohm : readout.load_ohm) ohm = std::isnan(ohm) ? kGuessedLoadOhm : ohm;
  if (std::isnan(readout.supply_ohm.value_or(0.0))) readout.supply_ohm.reset();
  return array;
}

/// The least x of 0 ... `most` with rising(x) >= value.
template <typename Rising>
double solve(Rising rising, double value, double most) {
  constexpr int kHalvings = 40;
  double low = 0.0;
  double high = most;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (rising(middle) < value ? low : high) = middle;
  }
  return high;
}

/// Share of the neighbour of a Gaussian, over the one at the centre.
double beside(double pitches) {
  return gaussian_share(pitches, 1) / gaussian_share(pitches, 0);
}

constexpr double kMostPitches = 20.0;

double spread_m(double share_beside, double pitch_m) {
  return pitch_m * solve(beside, share_beside, kMostPitches);
}

double times(std::size_t rows, std::size_t cols) {
  return (rows > 0 ? 2.0 : 1.0) * (cols > 0 ? 2.0 : 1.0);
}

struct FoundCover {
  Cover cover;
  double error = 0.0;  // relative, of all shares together
};

/// One cover as its shares tell it.
class Evidence {
 public:
  Evidence(const ArrayDescription& array, const SinglePresses& single, const TaxelCurves& curves)
      : array_(array), shares_(array, single, curves) {
    const std::size_t rows = std::min(array.rows - 1, std::max(kLeastLines, array.rows / 2));
    const std::size_t cols = std::min(array.cols - 1, std::max(kLeastLines, array.cols / 2));
    far_ = shares_.at(rows, cols).share;
    corner_ = shares_.at(1, 1);
  }

  [[nodiscard]] const RelativeShare& corner() const noexcept { return corner_; }
  [[nodiscard]] bool has_pairs() const noexcept { return corner_.pairs >= kLeastPairs; }

  /// Taxels across the corners rise, in all directions, with nearly every press.
  [[nodiscard]] bool shows_cover() const {
    const double least = std::max({kSigmas * corner_.error, kOverFar * far_, kLeastShare});
    return has_pairs() && corner_.least > least && corner_.scatter < kMostScatter && corner_.share < 1.0;
  }

  /// Neighbours in rows and columns are as the corners say, alike in both.
  [[nodiscard]] bool lines_agree() const {
    const double down = shares_.at(1, 0).share;
    const double right = shares_.at(0, 1).share;
    if (!(down > corner_.share && right > corner_.share && down < 1.0 && right < 1.0)) return false;
    const double ratio = spread_m(down, array_.row_pitch_m) / spread_m(right, array_.col_pitch_m);
    const double pitches = array_.row_pitch_m / array_.col_pitch_m;
    const double alike = kAlike * std::sqrt(std::max(pitches, 1.0 / pitches));  // no cover is quite a Gaussian
    return ratio < alike && ratio > 1.0 / alike && corner_.share > kLeastCorner * down * right;
  }

  [[nodiscard]] Cover by_corner() const { return {spread_by_corner(corner_.share, array_), {}}; }

  /// All shares that stand out; a Gaussian where it explains them.
  [[nodiscard]] FoundCover by_all() const {
    std::vector<CoverShare> found{{0, 0, 1.0}};
    Sum sum{1.0, 0.0};
    std::vector<double> rings;
    const std::size_t most = std::min({kMostReach, array_.rows - 1, array_.cols - 1});
    for (std::size_t ring = 1; ring <= most; ++ring) {
      const Sum of_ring = add_ring(ring, found);
      if (of_ring.shares == 0.0) break;
      rings.push_back(of_ring.shares);
      sum = {sum.shares + of_ring.shares, sum.variance + of_ring.variance};
    }
    const double beyond = beyond_last(rings);
    for (CoverShare& share : found) share.share /= sum.shares + beyond;
    const double error = std::sqrt(sum.variance) / sum.shares;
    Cover cover{std::numeric_limits<double>::quiet_NaN(), std::move(found)};
    if (const std::optional<double> spread = gaussian(cover.shares)) return {{*spread, {}}, error};
    return {std::move(cover), std::hypot(error, kErrorOfShares, 0.5 * beyond / sum.shares)};
  }

 private:
  /// Over the share of the centre.
  struct Sum {
    double shares = 0.0;
    double variance = 0.0;
  };

  /// Adds the shares whose larger distance is `ring`; their sum is 0 where none stands out.
  Sum add_ring(std::size_t ring, std::vector<CoverShare>& found) const {
    Sum sum;
    for (std::size_t k = 0; k <= ring; ++k) {
      for (const auto& [rows, cols] : {std::pair{ring, k}, std::pair{k, ring}}) {
        if (k == ring && any_at(found, rows, cols)) continue;
        const RelativeShare share = shares_.at(rows, cols);
        const std::size_t pairs = k == 0 ? kLeastPairs / 2 : kLeastPairs;  // along lines there are half as many
        if (share.pairs < pairs || !stands_out(share) || share.share > most_at(found, rows, cols)) continue;
        found.push_back({rows, cols, share.share});
        sum.shares += times(rows, cols) * share.share;
        sum.variance += std::pow(times(rows, cols) * share.error, 2);
      }
    }
    return sum;
  }

  /// The shares beyond the rings that stand out, were each ring the same share of the one before.
  static double beyond_last(const std::vector<double>& rings) {
    constexpr double kMostRatio = 0.5;
    if (rings.size() < 2) return 0.0;
    const double ratio = std::min(kMostRatio, rings.back() / rings[rings.size() - 2]);
    return rings.back() * ratio / (1.0 - ratio);
  }

  [[nodiscard]] bool stands_out(const RelativeShare& share) const {
    return share.share > std::max({kKeptSigmas * share.error, 2.0 * far_, kLeastKept});
  }

  /// The least of the shares of taxels that are nearer.
  static double most_at(const std::vector<CoverShare>& found, std::size_t rows, std::size_t cols) {
    double most = 1.0;
    for (const CoverShare& nearer : found) {
      if (nearer.rows <= rows && nearer.cols <= cols) most = std::min(most, nearer.share);
    }
    return most;
  }

  static bool any_at(const std::vector<CoverShare>& found, std::size_t rows, std::size_t cols) {
    return std::any_of(found.begin(), found.end(),
                       [&](const CoverShare& share) { return share.rows == rows && share.cols == cols; });
  }

  [[nodiscard]] double misfit(double metres, const std::vector<CoverShare>& shares) const {
    double misfit = 0.0;
    double rest = 1.0;
    for (const auto& [rows, cols, share] : shares) {
      const double gaussian =
          gaussian_share(metres / array_.row_pitch_m, rows) * gaussian_share(metres / array_.col_pitch_m, cols);
      misfit += times(rows, cols) * std::abs(share - gaussian);
      rest -= times(rows, cols) * gaussian;
    }
    return misfit + rest;
  }

  [[nodiscard]] std::optional<double> gaussian(const std::vector<CoverShare>& shares) const {
    constexpr int kSteps = 60;
    const double middle = spread_by_corner(corner_.share, array_);
    double best = middle;
    for (int step = -kSteps; step <= kSteps; ++step) {
      const double trial = middle * std::exp(0.2 * step / kSteps);
      if (misfit(trial, shares) < misfit(best, shares)) best = trial;
    }
    if (misfit(best, shares) < kGaussianError) return best;
    return std::nullopt;
  }

  const ArrayDescription& array_;
  CoverShares shares_;
  double far_ = 0.0;
  RelativeShare corner_;
};

std::string sentence(ArrayDescription array, const Cover& cover) {
  array.cover = cover;
  const CoverKernel kernel(array);
  const auto percent = [&](std::size_t rows, std::size_t cols) { return 100.0 * kernel.share(rows, cols); };
  const double right = percent(0, 1);
  const double down = percent(1, 0);
  const bool are_alike = std::abs(right - down) < 0.15 * (right + down);
  const std::string shares = are_alike
                                 ? fmt::format("{:.2g} % beside it", 0.5 * (right + down))
                                 : fmt::format("{:.2g} % beside it in its row, {:.2g} % in its column", right, down);
  const std::string key = cover.shares.empty()
                              ? fmt::format("cover_spread_mm = {:.2f}", cover.spread_m * kMillimetresPerMetre)
                              : std::string("cover_shares");
  return fmt::format(
      "your sheet spreads a press over its neighbours: {}, {:.2g} % across the corner; labels are taken "
      "for what stood on the cover ({})",
      shares, percent(1, 1), key);
}

/// Asked for in vain, or raised by too few presses; else nothing is said.
std::string question(const ArrayDescription& array, const Evidence& evidence, const SinglePresses& single) {
  const bool is_asked = array.cover.has_value();
  if (evidence.has_pairs()) {
    return is_asked ? "no cover: presses do not raise the taxels across the corners (cover)" : std::string{};
  }
  if (!is_asked && !(evidence.corner().share > kQuestionableShare)) return {};
  const std::size_t taxel = single.presses.front().taxel;
  const std::size_t beside = taxel % array.cols + 1 < array.cols ? taxel + 1 : taxel - 1;
  return fmt::format(
      "whether a cover spreads presses is not told by so few: press {} and {} each alone with three known "
      "weights, and the taxels around them, or press between {} and {}",
      array.taxel_name(taxel), array.taxel_name(beside), array.taxel_name(taxel), array.taxel_name(beside));
}

}  // namespace

double spread_by_corner(double share, const ArrayDescription& array) {
  const auto corner = [&](double metres) {
    return beside(metres / array.row_pitch_m) * beside(metres / array.col_pitch_m);
  };
  return solve(corner, share, kMostPitches * std::min(array.row_pitch_m, array.col_pitch_m));
}

CoverFit fit_cover(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
                   Nanos settle_time) {
  if (array.rows < kLeastLines || array.cols < kLeastLines) return {};
  const bool is_guessed = array.has_unknown_circuit();
  const ArrayDescription known = is_guessed ? guessed(array) : array;
  const std::optional<SinglePresses> single = single_presses(known, frames, loads, settle_time);
  if (!single) return {};
  const TaxelCurves curves(*single);
  if (!curves.any()) return {};
  const Evidence evidence(known, *single, curves);
  if (!evidence.shows_cover()) return {.cover = {}, .sentence = question(array, evidence, *single)};
  CoverFit fit;
  if (is_guessed) {
    fit.is_guessed = true;
    fit.cover = evidence.by_corner();
  } else if (evidence.lines_agree()) {
    FoundCover found = evidence.by_all();
    fit.cover = std::move(found.cover);
    fit.error = curves.are_straight() ? std::max(found.error, kErrorOfLines) : found.error;
  }
  if (!fit.cover) return fit;
  fit.sentence = sentence(array, *fit.cover);
  if (curves.are_straight()) fit.sentence += "; one weight tells that roughly: press some taxels with three";
  return fit;
}

}  // namespace dermis::learn::calibration
