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

#include "learn/calibration/sheet/cover_shares.hpp"
#include "learn/calibration/sheet/single_presses.hpp"
#include "learn/calibration/sheet/taxel_curves.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastLines = 3;
constexpr std::size_t kFar = 3;              // lines from a press: what it raises there is no film
constexpr double kOutlier = 5.0;             // sigmas
constexpr double kLeastRelativeSigma = 1e-3; // of a taxel beside a press, in the conductance of the press
constexpr double kEvidence = 60.0;           // squares that a film must explain
constexpr double kLeastExplained = 0.3;      // of the squares beyond noise
constexpr double kLeastOhm = 100.0;
constexpr double kMostOhm = 10e6;
constexpr double kFirstFactor = 4.0;
constexpr double kLastFactor = 1.01;
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

/// What the taxels around presses show with one film undone.
class Surroundings {
 public:
  Surroundings(const ArrayDescription& array, const SinglePresses& single, bool has_cover)
      : array_(array), single_(single), curves_(single) {
    if (!curves_.any() || !has_cover) return;
    const CoverShares shares(array, single, curves_);
    corner_ = shares.at(1, 1).share;
    beside_ = std::min(shares.at(0, 1).share, shares.at(1, 0).share);
    second_ = std::min(shares.at(0, 2).share, shares.at(2, 0).share);
  }

  [[nodiscard]] Misfit misfit() const {
    Misfit misfit;
    for (const SinglePress& press : single_.presses) add(press, misfit);
    return misfit;
  }

 private:
  void add(const SinglePress& press, Misfit& misfit) const {
    const std::size_t row = press.taxel / array_.cols;
    const std::size_t col = press.taxel % array_.cols;
    const double of_row = far_rise(press, [&](std::size_t i, std::size_t j) { return i == row && apart(j, col) >= kFar; });
    const double of_col = far_rise(press, [&](std::size_t i, std::size_t j) { return j == col && apart(i, row) >= kFar; });
    for (std::size_t i = row < 2 ? 0 : row - 2; i < std::min(row + 3, array_.rows); ++i) {
      for (std::size_t j = col < 2 ? 0 : col - 2; j < std::min(col + 3, array_.cols); ++j) {
        const std::size_t rows = apart(i, row);
        const std::size_t cols = apart(j, col);
        const std::size_t taxel = array_.index(i, j);
        if (rows + cols == 0 || rows + cols > 2 || array_.is_absent(taxel)) continue;
        const double of_line = rows == 0 ? of_row : cols == 0 ? of_col : 0.0;
        const double covered = curves_.any() ? curves_.siemens(taxel, share(rows, cols) * press.newtons) : 0.0;
        const double rise = press.siemens[taxel] - single_.unloaded[taxel] - of_line - covered;
        const double of_press = press.siemens[press.taxel] - single_.unloaded[press.taxel];
        misfit.add(rise / std::hypot(single_.sigma[taxel], kLeastRelativeSigma * of_press, 0.03 * covered));
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
      sum += press.siemens[taxel] - single_.unloaded[taxel];
      count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
  }

  const ArrayDescription& array_;
  const SinglePresses& single_;
  TaxelCurves curves_;
  double corner_ = 0.0;
  double beside_ = 0.0;
  double second_ = 0.0;
};

/// Films over one recording.
class FilmSearch {
 public:
  FilmSearch(ArrayDescription array, std::span<const RawFrame> frames, std::span<const Load> loads, Nanos settle_time)
      : array_(std::move(array)), frames_(frames), loads_(loads), settle_time_(settle_time) {}

  /// Empty: the circuit cannot be so.
  [[nodiscard]] std::optional<Misfit> misfit(const std::optional<Film>& film, bool has_cover) {
    array_.readout.film = film;
    const std::optional<SinglePresses> single = single_presses(array_, frames_, loads_, settle_time_);
    if (!single) return std::nullopt;
    return Surroundings(array_, *single, has_cover).misfit();
  }

  /// The film of least misfit, from coarse steps of both resistances to fine ones.
  [[nodiscard]] std::optional<Film> best(bool has_cover) {
    Film film{50e3, 10e3, kForces.front()};
    double least = squares(film, has_cover);
    for (double factor = kFirstFactor; factor > kLastFactor; factor = std::sqrt(factor)) {
      while (improve(factor, has_cover, film, least)) {}
    }
    for (const double newtons : kForces) {
      Film other{film.unloaded_ohm, film.loaded_ohm, newtons};
      double of_other = squares(other, has_cover);
      for (double factor = 1.5; factor > kLastFactor; factor = std::sqrt(factor)) {
        while (improve(factor, has_cover, other, of_other)) {}
      }
      if (of_other < 0.98 * least) std::tie(film, least) = std::pair(other, of_other);
    }
    if (!std::isfinite(least)) return std::nullopt;
    return film;
  }

 private:
  [[nodiscard]] double squares(const Film& film, bool has_cover) {
    const bool is_possible = film.loaded_ohm <= film.unloaded_ohm && film.loaded_ohm >= kLeastOhm && film.unloaded_ohm <= kMostOhm;
    const std::optional<Misfit> found = is_possible ? misfit(film, has_cover) : std::nullopt;
    return found ? found->squares : std::numeric_limits<double>::infinity();
  }

  /// A step along one of the resistances, or both, that lowers the misfit.
  bool improve(double factor, bool has_cover, Film& film, double& least) {
    for (const auto& [unloaded, loaded] : {std::pair{factor, 1.0}, {1.0 / factor, 1.0}, {1.0, factor}, {1.0, 1.0 / factor}, {factor, factor}, {1.0 / factor, 1.0 / factor}}) {
      const Film trial{film.unloaded_ohm * unloaded, film.loaded_ohm * loaded, film.loaded_newtons};
      const double found = squares(trial, has_cover);
      if (!(found < least)) continue;
      film = trial;
      least = found;
      return true;
    }
    return false;
  }

  ArrayDescription array_;
  std::span<const RawFrame> frames_;
  std::span<const Load> loads_;
  Nanos settle_time_;
};

std::string ohm_text(double ohm) {
  return ohm < 1000.0 ? fmt::format("{:.0f} ohm", ohm) : fmt::format("{:.3g} kohm", 1e-3 * ohm);
}

std::string sentence(const Film& film) {
  const std::string loaded = film.is_constant() ? "" : fmt::format(", {} under {:.0f} N", ohm_text(film.loaded_ohm), film.loaded_newtons);
  return fmt::format("your sheet is one film: it also conducts between neighbouring lines, {} from taxel to taxel{}; this is undone (film_ohm)",
                     ohm_text(film.unloaded_ohm), loaded);
}

bool explains(const Misfit& with, const Misfit& without) {
  const double excess = without.squares - without.count;
  const double explained = without.squares - with.squares;
  return explained > kEvidence && explained > kLeastExplained * excess;
}

}  // namespace

FilmFit fit_film(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
                 Nanos settle_time) {
  if (array.rows < kLeastLines || array.cols < kLeastLines) return {};
  FilmSearch search(array, frames, loads, settle_time);
  const std::optional<Misfit> plain = search.misfit(std::nullopt, false);
  if (!plain) return {};
  const std::optional<Misfit> covered = search.misfit(std::nullopt, true);
  const std::optional<Film> film = search.best(false);
  if (!film) return {};
  const std::optional<Misfit> with = search.misfit(film, false);
  fmt::print(stderr, "plain {:.1f}/{} covered {:.1f} film {:.1f} un {} lo {} F {}\n", plain->squares, plain->count, covered->squares, with->squares, film->unloaded_ohm, film->loaded_ohm, film->loaded_newtons);
  const std::optional<Film> film2 = search.best(true);
  const std::optional<Misfit> with2 = search.misfit(film2, true);
  fmt::print(stderr, "  with cover: film {:.1f} un {} lo {} F {}\n",  with2->squares, film2->unloaded_ohm, film2->loaded_ohm, film2->loaded_newtons);
  if (!explains(*with, *plain)) return {};
  return {film, sentence(*film)};
}

}  // namespace dermis::learn::calibration
