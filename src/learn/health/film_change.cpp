// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/film_change.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dermis/touch/compensation/circuit_model.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestPresses = 2;
constexpr std::size_t kMostPresses = 16;  // that are looked at
constexpr double kClearChange = 1.25;     // a factor: less may be the calibration's own error
constexpr double kClearSigmas = 3.0;      // of the mean of the presses
constexpr double kFurthest = 10.0;        // factor that is tried
constexpr double kTrialFactor = 1.05;     // for the slope
constexpr int kFactorSteps = 8;           // of Gauss and Newton
constexpr double kFactorEnough = 1e-3;    // of its logarithm
constexpr int kOwnSteps = 12;             // of Newton for the pressed taxel
constexpr double kOwnEnough = 1e-9;       // of the supply
constexpr double kMostOwnSiemens = 1.0;   // of a pressed taxel
constexpr double kCountShare = 0.3;       // of the noise of a reading, that its mean keeps
constexpr double kReadingError = 5e-4;    // of the reading of the press
constexpr double kUnexplained = 0.02;     // of the squares that a changed film explains
constexpr double kNoise = 9.0;            // mean square that is the readings' own

/// The readings around a press, under films that are tried.
class PressUnderFilm {
 public:
  PressUnderFilm(const ArrayDescription& array, touch::compensation::CircuitModel& model,
                 const std::vector<double>& idle_siemens, const WeighedPress& press, double weight_n)
      : array_(array),
        model_(model),
        idle_siemens_(idle_siemens),
        film_(array.rows, array.cols),
        nothing_(idle_siemens.size()),
        slopes_(idle_siemens.size()),
        loads_(press.readings.newtons) {
    for (double& load : loads_) load *= weight_n / press.newtons;
    for (std::size_t k = 0; k < loads_.size(); ++k) rise_.push_back(press.readings.ratio[k] - press.readings.idle[k]);
    pressed_ = static_cast<std::size_t>(std::max_element(rise_.begin(), rise_.end()) - rise_.begin());
    own_siemens_ = idle_siemens_[pressed_];
    find_around();
    const double noise = kCountShare * array.readout.adc_noise_counts / array.readout.full_scale_counts();
    sigma_ = std::hypot(noise, kReadingError * rise_[pressed_]);
  }

  [[nodiscard]] bool is_inside() const { return around_.size() == 8; }

  /// Readings around the press above those of the film that conducts so many times as much, in standard deviations.
  [[nodiscard]] std::vector<double> left(double factor) {
    Film film = *array_.readout.film;
    film.unloaded_ohm /= factor;
    film.loaded_ohm /= factor;
    const std::vector<double> idle = solve_idle(film);
    film_.set(film, loads_);
    model_.set_film(film_);
    find_own(idle[pressed_] + rise_[pressed_]);
    std::vector<double> left;
    for (const std::size_t k : around_) left.push_back((rise_[k] - (model_.ratio()[k] - idle[k])) / sigma_);
    return left;
  }

 private:
  void find_around() {
    const std::size_t row = pressed_ / array_.cols;
    const std::size_t col = pressed_ % array_.cols;
    for (std::size_t i = row - std::min<std::size_t>(row, 1); i < std::min(row + 2, array_.rows); ++i) {
      for (std::size_t j = col - std::min<std::size_t>(col, 1); j < std::min(col + 2, array_.cols); ++j) {
        const std::size_t taxel = i * array_.cols + j;
        if (taxel != pressed_ && !array_.is_absent(taxel) && std::isfinite(rise_[taxel])) around_.push_back(taxel);
      }
    }
  }

  std::vector<double> solve_idle(const Film& film) {
    film_.set(film, nothing_);
    model_.set_film(film_);
    model_.solve(idle_siemens_);
    return {model_.ratio().begin(), model_.ratio().end()};
  }

  /// The pressed taxel reads what it did.
  void find_own(double ratio) {
    std::vector<double> siemens = idle_siemens_;
    for (int step = 0; step < kOwnSteps; ++step) {
      siemens[pressed_] = own_siemens_;
      model_.solve(siemens);
      const double missing = ratio - model_.ratio()[pressed_];
      if (std::abs(missing) < kOwnEnough) return;
      model_.own_derivatives(slopes_);
      own_siemens_ = std::clamp(own_siemens_ + missing / slopes_[pressed_], 0.0, kMostOwnSiemens);
    }
  }

  const ArrayDescription& array_;
  touch::compensation::CircuitModel& model_;
  const std::vector<double>& idle_siemens_;
  FilmConductances film_;
  std::vector<double> nothing_;
  std::vector<double> slopes_;
  std::vector<double> loads_;
  std::vector<double> rise_;
  std::vector<std::size_t> around_;
  std::size_t pressed_ = 0;
  double own_siemens_ = 0.0;
  double sigma_ = 0.0;
};

double squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

/// Logarithm of the factor by which the film conducts more, by one press, and its variance.
struct LogFactor {
  double value = 0.0;
  double variance = 0.0;
};

/// Empty: no film explains the press, or it tells nothing of it.
std::optional<LogFactor> fit(PressUnderFilm& press) {
  const double furthest = std::log(kFurthest);
  const std::vector<double> unchanged = press.left(1.0);
  std::vector<double> left = unchanged;
  LogFactor found;
  for (int step = 0; step < kFactorSteps; ++step) {
    const std::vector<double> trial = press.left(kTrialFactor * std::exp(found.value));
    double slope_squares = 0.0;
    double product = 0.0;
    for (std::size_t k = 0; k < left.size(); ++k) {
      const double slope = (trial[k] - left[k]) / std::log(kTrialFactor);
      slope_squares += slope * slope;
      product += slope * left[k];
    }
    if (!(slope_squares > 0.0) || !std::isfinite(product)) return std::nullopt;
    const double before = found.value;
    found = {std::clamp(before - product / slope_squares, -furthest, furthest), 1.0 / slope_squares};
    left = press.left(std::exp(found.value));
    if (std::abs(found.value - before) < kFactorEnough) break;
  }
  const double most = kUnexplained * squares(unchanged);
  const bool is_explained = squares(left) <= std::max(most, kNoise * static_cast<double>(left.size()));
  if (!is_explained || found.variance > std::pow(std::log(kClearChange), 2)) return std::nullopt;
  return found;
}

/// That of the mean of several presses, where it is beyond doubt; else 1.
double clear_factor(const std::vector<LogFactor>& factors) {
  const auto count = static_cast<double>(factors.size());
  double mean = 0.0;
  for (const LogFactor& factor : factors) mean += factor.value / count;
  double seen = 0.0;
  double modelled = 0.0;
  for (const LogFactor& factor : factors) {
    seen += std::pow(factor.value - mean, 2) / (count - 1.0);
    modelled += factor.variance / count;
  }
  const double sigma = std::sqrt(std::max(seen, modelled) / count);
  return std::abs(mean) > std::max(std::log(kClearChange), kClearSigmas * sigma) ? std::exp(mean) : 1.0;
}

}  // namespace

double film_change(const ArrayDescription& array, const std::vector<double>& idle_siemens, double weight_n,
                   const std::vector<WeighedPress>& presses) {
  auto model = touch::compensation::CircuitModel::create(array);
  if (!model) return 1.0;
  std::vector<LogFactor> factors;
  std::size_t looked_at = 0;
  for (const WeighedPress& press : presses) {
    if (press.readings.idle.empty() || looked_at == kMostPresses) continue;
    PressUnderFilm under(array, *model, idle_siemens, press, weight_n);
    if (!under.is_inside()) continue;
    ++looked_at;
    if (const auto factor = fit(under)) factors.push_back(*factor);
  }
  const bool are_enough = factors.size() >= kFewestPresses && 2 * factors.size() >= looked_at;
  return are_enough ? clear_factor(factors) : 1.0;
}

}  // namespace dermis::learn::health
