// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/tables/baselines.hpp"

#include <algorithm>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "learn/calibration/samples/unloaded_fit.hpp"
#include "learn/calibration/tables/level_table.hpp"

namespace dermis::learn::calibration {
namespace {

double signal_of(const SampleDatabase& database, const Sample& sample, std::size_t taxel,
                 touch::fusion::LookUpSignal signal) {
  return signal == touch::fusion::LookUpSignal::reading ? bare_reading(database, sample, taxel) : sample.siemens[taxel];
}

/// The loaded points of a taxel and those of frames without any load, sorted by force.
std::vector<LevelPoint> known_points(const SampleDatabase& database, std::size_t taxel,
                                     touch::fusion::LookUpSignal signal, const SampleTemperatures& temperatures) {
  std::vector<LevelPoint> points;
  for (const Sample& sample : database.samples) {
    const double newtons = sample.known_newtons[taxel];
    const bool is_unloaded = sample.unloaded && newtons == 0.0;
    if (!(newtons > 0.0) && !is_unloaded) continue;  // NaN: unknown, or the reading is saturated
    points.push_back({newtons, signal_of(database, sample, taxel, signal), temperature_offset(sample, temperatures)});
  }
  std::sort(points.begin(), points.end(),
            [](const LevelPoint& a, const LevelPoint& b) { return a.newtons < b.newtons; });
  return points;
}

/// Straight lines for taxels that are only known through totals: newtons = slope * (signal - unloaded signal), with the
/// slope and the temperature coefficient in common.
class SharedLine {
 public:
  SharedLine(const SampleDatabase& database, touch::fusion::LookUpSignal signal, const SampleTemperatures& temperatures,
             bool with_temperature)
      : unloaded_(database.array.taxel_count()), highest_(database.array.taxel_count()) {
    find_range(database, signal);
    fit(database, signal, temperatures, with_temperature);
  }

  [[nodiscard]] double coefficient() const { return coefficient_; }

  [[nodiscard]] std::vector<Knot> table(std::size_t taxel) const {
    const double rise = std::max(highest_[taxel] - unloaded_[taxel], 1e-12);
    return {{0.0, unloaded_[taxel], 1.0}, {slope_ * rise, unloaded_[taxel] + rise, 1.0}};
  }

 private:
  void find_range(const SampleDatabase& database, touch::fusion::LookUpSignal signal) {
    std::vector<double> frames(unloaded_.size());
    for (const Sample& sample : database.samples) {
      for (std::size_t taxel = 0; taxel < unloaded_.size(); ++taxel) {
        const double value = signal_of(database, sample, taxel, signal);
        highest_[taxel] = std::max(highest_[taxel], value);
        if (!sample.unloaded || sample.known_newtons[taxel] != 0.0F) continue;
        unloaded_[taxel] += value;
        frames[taxel] += 1.0;
      }
    }
    for (std::size_t taxel = 0; taxel < unloaded_.size(); ++taxel) {
      if (frames[taxel] > 0.0) unloaded_[taxel] /= frames[taxel];
    }
  }

  /// Least squares of total = a * s + b * s dT over all totals, s the sum of the signals above the unloaded ones.
  void fit(const SampleDatabase& database, touch::fusion::LookUpSignal signal, const SampleTemperatures& temperatures,
           bool with_temperature) {
    double ss = 0.0;
    double st = 0.0;
    double tt = 0.0;
    double sy = 0.0;
    double ty = 0.0;
    for (const Sample& sample : database.samples) {
      for (const TotalForce& total : sample.totals) {
        double s = 0.0;
        for (const std::size_t taxel : total.taxels) s += signal_of(database, sample, taxel, signal) - unloaded_[taxel];
        const double t = s * temperature_offset(sample, temperatures);
        ss += s * s;
        st += s * t;
        tt += t * t;
        sy += s * total.newtons;
        ty += t * total.newtons;
      }
    }
    const double determinant = ss * tt - st * st;
    const double slope_at_centre = sy * tt - ty * st;
    if (with_temperature && determinant > 1e-9 * ss * tt && slope_at_centre > 0.0) {
      slope_ = slope_at_centre / determinant;
      coefficient_ = (ty * ss - sy * st) / slope_at_centre;
    } else if (ss > 0.0) {
      slope_ = std::max(sy / ss, 0.0);
    }
  }

  std::vector<double> unloaded_;
  std::vector<double> highest_;
  double slope_ = 0.0;
  double coefficient_ = 0.0;
};

touch::fusion::LookUpTables make_tables(const SampleDatabase& database, const char* name,
                                        touch::fusion::LookUpSignal signal, bool with_temperature) {
  const SampleTemperatures temperatures = sample_temperatures(database);
  const SharedLine shared(database, signal, temperatures, with_temperature);
  const std::size_t taxels = database.array.taxel_count();
  touch::fusion::LookUpTables tables;
  tables.name = name;
  tables.signal = signal;
  tables.reference_celsius = temperatures.span.centre_celsius;
  tables.temperature_coefficient.resize(taxels);
  std::vector<std::vector<Knot>> knots(taxels);
  parallel_for(taxels, [&](std::size_t taxel) {
    std::vector<LevelPoint> points = known_points(database, taxel, signal, temperatures);
    const bool is_known = !points.empty() && points.back().newtons > 0.0;
    double& coefficient = tables.temperature_coefficient[taxel];
    if (with_temperature) coefficient = is_known ? temperature_coefficient(points) : shared.coefficient();
    knots[taxel] = is_known ? level_table(std::move(points), coefficient) : shared.table(taxel);
  });
  tables.knots = 2;
  for (const std::vector<Knot>& table : knots) tables.knots = std::max(tables.knots, table.size());
  for (std::vector<Knot>& table : knots) {
    table.resize(tables.knots, table.back());  // repeated last knots: the table is clamped there
    for (const Knot& knot : table) {
      tables.knot_signal.push_back(knot.y);
      tables.knot_newtons.push_back(knot.x);
    }
  }
  return tables;
}

}  // namespace

std::vector<touch::fusion::LookUpTables> make_baselines(const SampleDatabase& database) {
  return {make_tables(database, "raw_lookup", touch::fusion::LookUpSignal::reading, false),
          make_tables(database, "temperature_lookup", touch::fusion::LookUpSignal::reading, true),
          make_tables(database, "crosstalk_lookup", touch::fusion::LookUpSignal::conductance, true)};
}

}  // namespace dermis::learn::calibration
