// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/film_fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/sheet/cover_shares.hpp"
#include "learn/calibration/sheet/predicted_presses.hpp"
#include "learn/calibration/sheet/single_presses.hpp"
#include "learn/calibration/sheet/taxel_curves.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastLines = 3;
constexpr std::size_t kFar = 3;               // lines from a press: what it raises there is no film
constexpr double kOutlier = 5.0;              // sigmas
constexpr double kLeastRelativeSigma = 3e-4;  // of a taxel beside a press, in the conductance of the press
constexpr double kCoverError = 0.01;          // of what a cover hands on
constexpr double kAllWork = 1e7;              // times taxels
constexpr double kWorkOfCurves = 50.0;        // over that of a trial
constexpr double kMostWork = 2e5;             // frames x taxels of a trial
constexpr double kMostSlowWork = 4e4;         // the same of floating lines
constexpr double kPredictedWork = 6e4;        // the same of presses that are predicted
constexpr double kFewestPresses = 200.0;      // that are predicted
constexpr double kCoarseShare = 0.2;          // of them for the first steps
constexpr double kMostLeft = 4.0;             // mean square
constexpr double kInvertible = 0.98;          // of the presses
constexpr double kMoreThanNoise = 2.0;        // mean square
constexpr double kSuspicious = 20.0;          // squares that films which hardly conduct explain, where there is one
constexpr double kEvidence = 60.0;            // squares that a film must explain
constexpr double kLeastExplained = 0.1;       // of all squares
constexpr double kLeastExplainedUnderCover = 0.3;  // no cover is quite a Gaussian
constexpr double kLeastCorner = 0.4;  // share across a corner of a cover, over the square of the one beside
constexpr double kLeastOhm = 100.0;
constexpr double kMostOhm = 10e6;
constexpr std::size_t kStarts = 6;  // from which steps go on
constexpr double kFirstFactor = 2.0;
constexpr double kNearFactor = 1.2;
constexpr double kFineFactor = 1.06;
constexpr double kLastFactor = 1.01;
constexpr double kClearlyLess = 0.9;                        // squares, for another force
constexpr std::array kForces{20.0, 5.0, 10.0, 40.0, 80.0};  // under which the film is at its least resistance [N]

/// Sum of squares in which outliers count by their first power (Huber), and how many there are.
struct Misfit {
  double squares = 0.0;
  double count = 0.0;

  void add(double sigmas) {
    const double size = std::abs(sigmas);
    squares += size <= kOutlier ? size * size : kOutlier * (2.0 * size - kOutlier);
    count += 1.0;
  }
};

std::size_t apart(std::size_t a, std::size_t b) {
  return a > b ? a - b : b - a;
}

/// The taxels around presses with one film undone.
class Surroundings {
 public:
  Surroundings(const ArrayDescription& array, const SinglePresses& single, const TaxelCurves& curves)
      : array_(array), single_(single), curves_(curves), usual_sigma_(quantile(single.sigma, 0.5)) {
    if (!curves_.any()) return;
    const CoverShares shares(array, single, curves_);
    corner_ = shares.at(1, 1).share;
    beside_ = std::min({shares.at(0, 1).share, shares.at(1, 0).share, std::sqrt(corner_ / kLeastCorner)});
    second_ = std::min({shares.at(0, 2).share, shares.at(2, 0).share, corner_});
  }

  /// Share of the taxels far from presses that would have to conduct less than nothing, by noise.
  [[nodiscard]] double held_far() const {
    Held far;
    for (const SinglePress& press : single_.presses) {
      for (std::size_t taxel = 0; taxel < array_.taxel_count(); ++taxel) {
        if (is_far(press.taxel, taxel)) far.add(press.held[taxel]);
      }
    }
    return far.count > 0.0 ? far.held / far.count : 0.0;
  }

  /// Taxels beside presses that would have to conduct less than nothing count where there are more than this share.
  [[nodiscard]] Misfit misfit(double usually_held) const {
    Misfit misfit;
    Held near;
    for (const SinglePress& press : single_.presses) add(press, misfit, near);
    misfit.squares += kOutlier * kOutlier * std::max(near.held - usually_held * near.count, 0.0);
    return misfit;
  }

 private:
  struct Held {
    double held = 0.0;
    double count = 0.0;

    void add(bool is_held) {
      held += is_held ? 1.0 : 0.0;
      count += 1.0;
    }
  };

  [[nodiscard]] bool is_far(std::size_t pressed, std::size_t taxel) const {
    return apart(pressed / array_.cols, taxel / array_.cols) >= kFar &&
           apart(pressed % array_.cols, taxel % array_.cols) >= kFar && !array_.is_absent(taxel);
  }

  void add(const SinglePress& press, Misfit& misfit, Held& near) const {
    const std::size_t row = press.taxel / array_.cols;
    const std::size_t col = press.taxel % array_.cols;
    const double of_row =
        far_rise(press, [&](std::size_t i, std::size_t j) { return i == row && apart(j, col) >= kFar; });
    const double of_col =
        far_rise(press, [&](std::size_t i, std::size_t j) { return j == col && apart(i, row) >= kFar; });
    for (std::size_t i = row < 2 ? 0 : row - 2; i < std::min(row + 3, array_.rows); ++i) {
      for (std::size_t j = col < 2 ? 0 : col - 2; j < std::min(col + 3, array_.cols); ++j) {
        const std::size_t rows = apart(i, row);
        const std::size_t cols = apart(j, col);
        const std::size_t taxel = array_.index(i, j);
        if (rows + cols == 0 || rows + cols > 2 || array_.is_absent(taxel)) continue;
        const double of_line = rows == 0 ? of_row : cols == 0 ? of_col : 0.0;
        const double covered = curves_.any() ? curves_.siemens(taxel, share(rows, cols) * press.newtons) : 0.0;
        const double rise = press.rise[taxel] - of_line - covered;
        const double of_press = press.rise[press.taxel];
        near.add(press.held[taxel]);
        misfit.add(rise / std::hypot(std::max(single_.sigma[taxel], usual_sigma_), kLeastRelativeSigma * of_press,
                                     kCoverError * covered));
      }
    }
  }

  [[nodiscard]] double share(std::size_t rows, std::size_t cols) const {
    if (rows > 0 && cols > 0) return corner_;
    return rows + cols == 1 ? beside_ : second_;
  }

  /// Mean rise of the taxels of a press's line that are far from it; 0: there are none.
  template <typename IsFar>
  [[nodiscard]] double far_rise(const SinglePress& press, const IsFar& is_far) const {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t taxel = 0; taxel < array_.taxel_count(); ++taxel) {
      if (array_.is_absent(taxel) || !is_far(taxel / array_.cols, taxel % array_.cols)) continue;
      sum += press.rise[taxel];
      count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
  }

  const ArrayDescription& array_;
  const SinglePresses& single_;
  const TaxelCurves& curves_;
  double usual_sigma_;  // at least: readings in whole counts may scatter by none
  double corner_ = 0.0;
  double beside_ = 0.0;
  double second_ = 0.0;
};

/// Films over one recording.
class FilmSearch {
 public:
  explicit FilmSearch(const ArrayDescription& array, PredictedPresses presses)
      : array_(array), presses_(std::move(presses)) {}

  /// A film, and the cover below which it lies; infinite squares: no film is so.
  struct Candidate {
    Film film;
    std::optional<Cover> cover;
    double squares = 0.0;
  };

  /// The one of least misfit, from a net of both resistances over coarse steps to finer ones.
  [[nodiscard]] Candidate coarse() {
    std::vector<Candidate> starts;
    for (const double unloaded : {100e3, 50e3, 25e3, 12e3, 6e3, 3e3}) {
      for (const double share : {1.0, 0.5, 0.25, 0.1})
        starts.push_back(candidate({unloaded, share * unloaded, kForces.front()}, std::nullopt));
    }
    std::sort(starts.begin(), starts.end(), is_better);
    starts.resize(kStarts);
    for (Candidate& start : starts) start = improved(start, kFirstFactor, kNearFactor);
    return *std::min_element(starts.begin(), starts.end(), is_better);
  }

  /// The same film may end at another force.
  [[nodiscard]] Candidate finer(const Candidate& start) {
    Candidate best = improved(start, kNearFactor, kLastFactor);
    if (best.film.is_constant()) return best;
    const Film at_first = best.film;
    const double unloaded = 1.0 / at_first.unloaded_ohm;
    for (std::size_t k = 1; k < kForces.size(); ++k) {
      const double above = (1.0 / at_first.loaded_ohm - unloaded) * kForces[k] / at_first.loaded_newtons;
      const Film film{at_first.unloaded_ohm, std::max(1.0 / (unloaded + above), kLeastOhm), kForces[k]};
      const Candidate other = improved({film, best.cover}, kNearFactor, kLastFactor);
      if (other.squares < kClearlyLess * best.squares) best = other;
    }
    return best;
  }
  [[nodiscard]] Candidate fine(const Candidate& start) { return improved(start, kFineFactor, kLastFactor); }

 private:
  static bool is_better(const Candidate& a, const Candidate& b) { return a.squares < b.squares; }

  [[nodiscard]] Candidate candidate(const Film& film, const std::optional<Cover>& start) {
    if (film.loaded_ohm > film.unloaded_ohm || film.loaded_ohm < kLeastOhm || film.unloaded_ohm > kMostOhm)
      return {film, {}, std::numeric_limits<double>::infinity()};
    const SinglePresses single = presses_.under(film, start);
    return {film, presses_.cover(), Surroundings(array_, single, presses_.curves()).misfit(0.0).squares};
  }

  [[nodiscard]] Candidate improved(const Candidate& start, double first_factor, double last_factor) {
    Candidate best = candidate(start.film, start.cover);
    for (double factor = first_factor; factor > last_factor; factor = std::sqrt(factor)) {
      while (improve(factor, start.cover, best)) {
      }
    }
    return best;
  }

  /// A step along one of the resistances, or both, that lowers the misfit.
  bool improve(double factor, const std::optional<Cover>& start, Candidate& best) {
    const double back = 1.0 / factor;
    const std::array<std::pair<double, double>, 6> steps{
        {{factor, 1.0}, {back, 1.0}, {1.0, factor}, {1.0, back}, {factor, factor}, {back, back}}};
    for (const auto& [unloaded, loaded] : steps) {
      const Film film{best.film.unloaded_ohm * unloaded, best.film.loaded_ohm * loaded, best.film.loaded_newtons};
      const Candidate found = candidate(film, start);
      if (!is_better(found, best)) continue;
      best = found;
      return true;
    }
    return false;
  }

  ArrayDescription array_;
  PredictedPresses presses_;
};

/// Films by what the inversion leaves around presses.
class FilmJudge {
 public:
  FilmJudge(const ArrayDescription& array, LabelledPresses presses, const TaxelCurves& curves)
      : array_(array), presses_(std::move(presses)), curves_(curves) {}

  /// Empty: the circuit cannot be so.
  [[nodiscard]] std::optional<Misfit> misfit(const std::optional<Film>& film, const std::optional<Cover>& cover,
                                             const TaxelCurves& curves) {
    ArrayDescription array = array_;
    array.readout.film = film;
    array.cover = cover;
    const std::optional<SinglePresses> single = presses_.invert(array);
    if (!single) return std::nullopt;
    most_presses_ = std::max(most_presses_, single->presses.size());
    if (kInvertible * static_cast<double>(most_presses_) > static_cast<double>(single->presses.size()))
      return std::nullopt;
    const Surroundings surroundings(array_, *single, curves);
    if (!film) usually_held_ = surroundings.held_far();
    return surroundings.misfit(usually_held_);
  }

  /// Infinite: the circuit cannot be so.
  [[nodiscard]] double squares(const Film& film, const std::optional<Cover>& cover, const TaxelCurves& curves) {
    const std::optional<Misfit> found = misfit(film, cover, curves);
    return found ? found->squares : std::numeric_limits<double>::infinity();
  }

  /// More than noise is left, or a film that conducts little already explains some of it.
  [[nodiscard]] bool is_suspicious(const Misfit& without) {
    if (without.squares > kMoreThanNoise * without.count) return true;
    const double weak = std::min(squares({200e3, 200e3, kForces.front()}, array_.cover, curves_),
                                 squares({2e6, 20e3, kForces.front()}, array_.cover, curves_));
    return without.squares - weak > kSuspicious;
  }

 private:
  const ArrayDescription& array_;
  LabelledPresses presses_;
  const TaxelCurves& curves_;     // of the taxels without a film
  std::size_t most_presses_ = 0;  // that the circuit can give with any film
  double usually_held_ = 0.0;     // by the circuit without a film, which is to be tried first
};

std::string ohm_text(double ohm) {
  return ohm < 1000.0 ? fmt::format("{:.0f} ohm", ohm) : fmt::format("{:.3g} kohm", 1e-3 * ohm);
}

std::string sentence(const Film& film) {
  const std::string loaded = film.is_constant() ? ""
                                                : fmt::format(", {} where {:.0f} N press on both",
                                                              ohm_text(film.loaded_ohm), film.loaded_newtons);
  return fmt::format(
      "your sheet is one film: it also conducts between neighbouring lines, {}{}; this is undone (film_ohm)",
      ohm_text(film.unloaded_ohm), loaded);
}

/// The middle of a sheet, where a film conducts to both sides.
std::string question(const ArrayDescription& array) {
  const std::string one = array.taxel_name(array.index(array.rows / 2, array.cols / 2));
  const std::string next = array.taxel_name(array.index(array.rows / 2, array.cols / 2 + 1));
  return fmt::format(
      "whether your sheet is one film is not told by so few presses of single taxels: press {} and {} each alone with "
      "three known weights and nothing before, or press between {} and {}",
      one, next, one, next);
}

/// Much is explained, and little more than noise is left.
bool explains(double with, const Misfit& without, bool has_cover) {
  const double least = has_cover ? kLeastExplainedUnderCover : kLeastExplained;
  return without.squares - with > std::max(kEvidence, least * without.squares) && with < kMostLeft * without.count;
}

}  // namespace

FilmFit fit_film(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
                 Nanos settle_time) {
  if (array.rows < kLeastLines || array.cols < kLeastLines) return {};
  const auto presses = LabelledPresses::create(array, frames, loads, settle_time, kAllWork);
  if (!presses) return {.film = {}, .cover = {}, .sentence = question(array)};
  const double work = is_inverted_slowly(array) ? kMostSlowWork : kMostWork;
  const double most = std::max(kPredictedWork, kFewestPresses * static_cast<double>(array.taxel_count()));
  const std::optional<SinglePresses> single = presses->some(kWorkOfCurves * work).invert(array);
  if (!single) return {.film = {}, .cover = {}, .sentence = question(array)};
  const TaxelCurves curves(*single);
  FilmJudge judge(array, presses->some(work), curves);
  std::optional<Misfit> without = judge.misfit(std::nullopt, array.cover, curves);
  if (!without || !judge.is_suspicious(*without)) return {};
  const auto search = [&](double share, const TaxelCurves& near) {
    auto predicted = PredictedPresses::create(array, presses->some(share * most), near);
    return predicted ? std::optional(FilmSearch(array, *std::move(predicted))) : std::nullopt;
  };
  auto coarse = search(kCoarseShare, curves);
  auto all = PredictedPresses::create(array, presses->some(kWorkOfCurves * work), curves);
  if (!coarse || !all) return {};
  const FilmSearch::Candidate nearly = coarse->coarse();
  const TaxelCurves bent(all->under(nearly.film, nearly.cover));
  const auto [film, cover, squares] = search(1.0, bent)->fine(search(kCoarseShare, bent)->finer(nearly));
  // The inversion under a film takes noise in another way than the one without.
  without->squares = std::min(without->squares, judge.squares({kMostOhm, kMostOhm}, array.cover, curves));
  if (!explains(judge.squares(film, cover, bent), *without, cover.has_value())) return {};
  return {film, cover, sentence(film)};
}

}  // namespace dermis::learn::calibration
