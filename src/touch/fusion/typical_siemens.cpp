// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/typical_siemens.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::touch::fusion {
namespace {

constexpr double kFirstFactor = 8.0;        // of the search for a conductance
constexpr double kLastFactor = 1.0 + 1e-6;  // and how finely it ends

/// The array with excess conductances that are shares of the references.
class PressedArray {
 public:
  explicit PressedArray(const ForceNetworks& networks) : networks_(networks), fusion_(networks) {
    const std::size_t taxels = networks.taxel_count();
    conductance_.temperature_celsius = networks.unloaded.temperature.centre_celsius;
    conductance_.siemens.resize(taxels);
    conductance_.sigma_siemens.assign(taxels, 0.0);
    conductance_.taxels.assign(taxels, TaxelStatus::ok);
  }

  /// So many times what a taxel conducts above its unloaded conductance where it conducts `siemens`.
  void press(double times, std::span<const double> siemens) {
    std::vector<double> share(siemens.size());
    for (std::size_t taxel = 0; taxel < share.size(); ++taxel) {
      const double excess = siemens[taxel] - networks_.unloaded.offset_siemens[taxel];
      share[taxel] = times * excess / static_cast<double>(networks_.reference_siemens[taxel]);
    }
    press(share);
  }
  void press(std::span<const double> share) {
    for (std::size_t taxel = 0; taxel < share.size(); ++taxel) {
      conductance_.siemens[taxel] = networks_.unloaded.offset_siemens[taxel] +
                                    share[taxel] * static_cast<double>(networks_.reference_siemens[taxel]);
    }
    fusion_.process(conductance_, force_);
  }
  [[nodiscard]] const std::vector<float>& newtons() const { return force_.newtons; }
  [[nodiscard]] const std::vector<double>& siemens() const { return conductance_.siemens; }

 private:
  const ForceNetworks& networks_;
  ForceFusion fusion_;
  ConductanceFrame conductance_;
  ForceFrame force_;
};

/// Empty where all are NaN.
std::optional<float> median_of_finite(const std::vector<float>& values) {
  std::vector<float> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](float value) { return std::isfinite(value); });
  if (finite.empty()) return std::nullopt;
  return upper_median(std::move(finite));
}

/// Forces rise with conductance: each taxel goes up or down by factors that shrink.
void search(float newtons, PressedArray& array) {
  std::vector<double> share(array.newtons().size(), 1.0);
  for (double factor = kFirstFactor; factor > kLastFactor; factor = std::sqrt(factor)) {
    array.press(share);
    for (std::size_t taxel = 0; taxel < share.size(); ++taxel) {
      share[taxel] *= array.newtons()[taxel] < newtons ? factor : 1.0 / factor;
    }
  }
  array.press(share);
}

}  // namespace

std::vector<double> typical_siemens(const ForceNetworks& networks) {
  const std::size_t taxels = networks.taxel_count();
  PressedArray array(networks);
  array.press(std::vector<double>(taxels, 1.0));
  const std::optional<float> newtons = median_of_finite(array.newtons());
  if (!newtons) return std::vector<double>(taxels, 1.0);
  search(*newtons, array);
  std::vector<double> siemens = array.siemens();
  const auto is_found = [&](std::size_t taxel) {
    return std::isfinite(array.newtons()[taxel]) && siemens[taxel] > 0.0;
  };
  std::vector<double> found;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    if (is_found(taxel)) found.push_back(siemens[taxel]);
  }
  if (found.empty()) return std::vector<double>(taxels, 1.0);
  const double median = upper_median(std::move(found));
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    if (!is_found(taxel)) siemens[taxel] = median;
  }
  return siemens;
}

std::vector<LoadPoint> load_points(const ForceNetworks& networks, std::span<const double> typical) {
  constexpr double kFirst = 1.0 / 16.0;
  constexpr double kLast = 20.0;
  constexpr double kStep = 2.2;
  std::vector<LoadPoint> points;
  PressedArray array(networks);
  for (double share = kFirst; share < kLast; share *= kStep) {
    array.press(share, typical);
    const auto newtons = static_cast<double>(median_of_finite(array.newtons()).value_or(0.0F));
    if (newtons > (points.empty() ? 0.0 : points.back().newtons)) points.push_back({share, newtons});
  }
  return points;
}

}  // namespace dermis::touch::fusion
