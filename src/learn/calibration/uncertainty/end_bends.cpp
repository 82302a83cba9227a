// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/uncertainty/end_bends.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

/// A known force of a taxel.
struct LawPoint {
  std::size_t taxel = 0;
  double log_newtons = 0.0;
  double log_siemens = 0.0;  // of the excess conductance
  double variance = 0.0;     // of log_siemens
};

std::vector<LawPoint> law_points(const SampleDatabase& database, const touch::fusion::ForceNetworks& networks) {
  constexpr double kLeastSignal = 5.0;      // an excess over its noise
  constexpr double kRepeatability = 0.005;  // of rubber
  std::vector<LawPoint> points;
  for (const Sample& sample : database.samples) {
    const TemperatureSpan& temperature = networks.unloaded.temperature;
    for (std::size_t taxel = 0; taxel < sample.known_newtons.size(); ++taxel) {
      const float share = sample.material_share.empty() ? 1.0F : sample.material_share[taxel];
      const float newtons = share * sample.known_newtons[taxel];
      if (!(newtons > 0.0F) || networks.dead[taxel] != 0) continue;
      const double offset = sample.taxel_celsius.empty()
                                ? temperature.offset(sample.temperature_celsius)
                                : temperature.offset(static_cast<double>(sample.taxel_celsius[taxel]));
      const double excess = networks.unloaded.excess(taxel, static_cast<double>(sample.siemens[taxel]), offset);
      const double sigma = sample.sigma_siemens.empty() ? 0.0 : static_cast<double>(sample.sigma_siemens[taxel]);
      if (!(excess > kLeastSignal * sigma)) continue;
      points.push_back({taxel, std::log(static_cast<double>(newtons)), std::log(excess),
                        std::pow(sigma / excess, 2) + kRepeatability * kRepeatability});
    }
  }
  return points;
}

/// A parabola ln e = level + slope v + bend v^2, v = ln(force / force at the end), with a level for each taxel.
struct EndParabola {
  double slope = 0.0;
  double bend = 0.0;
  double bend_sigma = 0.0;
};

/// By weighted least squares; the levels are eliminated.
EndParabola fit_parabola(const std::vector<LawPoint>& points, std::size_t taxels) {
  std::vector<Eigen::Matrix4d> sums(taxels, Eigen::Matrix4d::Zero());
  for (const LawPoint& point : points) {
    const double v = point.log_newtons;
    const Eigen::Vector4d row(1.0, v, v * v, point.log_siemens);
    sums[point.taxel] += row * row.transpose() / point.variance;
  }
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  double freedom = static_cast<double>(points.size()) - 2.0;
  for (const Eigen::Matrix4d& of_taxel : sums) {
    if (of_taxel(0, 0) == 0.0) continue;
    const Eigen::Vector3d first = of_taxel.col(0).tail<3>();
    normal += of_taxel.bottomRightCorner<3, 3>() - first * first.transpose() / of_taxel(0, 0);
    freedom -= 1.0;
  }
  constexpr double kLeastDeterminant = 1e-6;  // of that of independent columns: fewer loads than terms
  const Eigen::Matrix2d matrix = normal.topLeftCorner<2, 2>();
  const bool is_determined = matrix.determinant() > kLeastDeterminant * matrix(0, 0) * matrix(1, 1);
  if (!is_determined || freedom < 1.0) return {1.0, 0.0, std::numeric_limits<double>::infinity()};
  const Eigen::Matrix2d inverse = matrix.inverse();
  const Eigen::Vector2d right = normal.col(2).head<2>();
  const Eigen::Vector2d solution = inverse * right;
  const double scatter = std::max(1.0, (normal(2, 2) - solution.dot(right)) / freedom);
  return {solution(0), solution(1), std::sqrt(scatter * inverse(1, 1))};
}

/// The points at most so far from the end of their taxel, with forces over those at the end.
std::vector<LawPoint> points_near(const std::vector<LawPoint>& points, const std::vector<double>& log_end,
                                  double reach) {
  std::vector<LawPoint> near;
  for (LawPoint point : points) {
    point.log_newtons -= log_end[point.taxel];
    if (std::abs(point.log_newtons) <= reach) near.push_back(point);
  }
  return near;
}

/// The median over the taxels of p / p_law - 1, without its sign: p of the networks at their ends, p_law of the
/// parabola.
double exponent_error(const touch::fusion::ForceNetworks& networks, const std::vector<LawPoint>& near, double slope) {
  constexpr double kStep = 0.25;  // of ln e
  const std::size_t taxels = networks.taxel_count();
  std::vector<double> log_siemens(taxels, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> distance(taxels, std::numeric_limits<double>::infinity());
  for (const LawPoint& point : near) {
    if (!(std::abs(point.log_newtons) < distance[point.taxel])) continue;
    distance[point.taxel] = std::abs(point.log_newtons);
    log_siemens[point.taxel] = point.log_siemens;
  }
  touch::fusion::ForceFusion fusion(networks);
  std::vector<double> log_newtons(taxels);
  std::vector<double> errors;
  for (const double step : {0.0, kStep}) {
    ConductanceFrame frame;
    frame.temperature_celsius = networks.unloaded.temperature.centre_celsius;
    frame.taxels.assign(taxels, TaxelStatus::ok);
    frame.sigma_siemens.assign(taxels, 0.0);
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
      frame.siemens.push_back(networks.unloaded.at(taxel, 0.0) + std::exp(log_siemens[taxel] - step));
    }
    ForceFrame force;
    fusion.process(frame, force);
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
      const double logarithm = std::log(static_cast<double>(force.newtons[taxel]));
      const double error = (log_newtons[taxel] - logarithm) / kStep * slope - 1.0;
      log_newtons[taxel] = logarithm;
      if (step > 0.0 && std::isfinite(error)) errors.push_back(error);
    }
  }
  return errors.empty() ? 0.0 : std::abs(upper_median(std::move(errors)));
}

/// From the narrowest surroundings of the end that tell it. A wrong exponent counts as the bend that errs as much at
/// twice or half the force at the end. Laws that saturate bend the more, the further they are followed.
double bend_at(const touch::fusion::ForceNetworks& networks, const std::vector<LawPoint>& points,
               const std::vector<double>& log_end) {
  constexpr double kSure = 0.25;
  constexpr double kMost = 10.0;
  constexpr double kGrowth = 2.0;
  for (const double factor : {4.0, 8.0, 16.0}) {
    const std::vector<LawPoint> near = points_near(points, log_end, std::log(factor));
    const EndParabola parabola = fit_parabola(near, log_end.size());
    const double slope = std::max(parabola.slope, 2.0 * std::abs(parabola.bend) / kMost);
    const double sigma = 2.0 * parabola.bend_sigma / slope;
    if (sigma > kSure) continue;
    const double bend = std::max(0.0, 2.0 * std::abs(parabola.bend) / slope - sigma);
    const double of_exponent = 2.0 * exponent_error(networks, near, slope) / std::numbers::ln2;
    return std::min(kGrowth * bend + of_exponent, kMost);
  }
  return 0.0;
}

}  // namespace

std::array<float, 2> find_end_bends(const SampleDatabase& database, touch::fusion::ForceNetworks networks) {
  const std::vector<LawPoint> points = law_points(database, networks);
  const std::size_t taxels = networks.taxel_count();
  const double lightest = std::log(static_cast<double>(networks.sigma_knots_newtons[0]));
  std::vector<double> heaviest(taxels, -std::numeric_limits<double>::infinity());
  for (const LawPoint& point : points) heaviest[point.taxel] = std::max(heaviest[point.taxel], point.log_newtons);
  std::fill(networks.relative_sigma.begin(), networks.relative_sigma.end(), 1e-6F);
  std::fill(networks.heaviest_newtons.begin(), networks.heaviest_newtons.end(), std::numeric_limits<float>::infinity());
  return {static_cast<float>(bend_at(networks, points, std::vector<double>(taxels, lightest))),
          static_cast<float>(bend_at(networks, points, heaviest))};
}

}  // namespace dermis::learn::calibration
