// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/shared_loads.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "learn/calibration/labels/press_numbers.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostPresses = 12;  // of one taxel alone; more are little evidence on all

}  // namespace

SharedLoads::SharedLoads(const SampleDatabase& database, const SampleTemperatures& temperatures,
                         const UnloadedFit& unloaded, const std::vector<bool>& dead)
    : database_(database), temperatures_(temperatures), unloaded_(unloaded), dead_(dead) {
  std::map<std::vector<std::size_t>, PressNumbers> numbers;
  for (std::size_t k = 0; k < database.samples.size(); ++k) {
    for (const TotalForce& total : database.samples[k].totals) {
      add({k, total.newtons, numbers[total.taxels].next(database.samples[k], k, total.newtons).touch}, total.taxels,
          total.material_share);
    }
  }
  add_presses();
}

/// At most kMostPresses of the presses on each taxel alone, evenly.
void SharedLoads::add_presses() {
  std::vector<std::vector<Press>> presses(dead_.size());
  std::vector<PressNumbers> numbers(dead_.size());
  for (std::size_t k = 0; k < database_.samples.size(); ++k) {
    for (std::size_t taxel = 0; taxel < dead_.size(); ++taxel) {
      const double newtons = database_.samples[k].known_newtons[taxel];
      if (newtons > 0.0)
        presses[taxel].push_back({k, newtons, numbers[taxel].next(database_.samples[k], k, newtons).touch});
    }
  }
  for (std::size_t taxel = 0; taxel < dead_.size(); ++taxel) {
    const std::vector<Press>& of_taxel = presses[taxel];
    const std::size_t count = std::min(of_taxel.size(), kMostPresses);
    for (std::size_t k = 0; k < count; ++k) {
      const Press& press = of_taxel[k * of_taxel.size() / count];
      const std::vector<float>& material_share = database_.samples[press.sample].material_share;
      add(press, {taxel}, material_share.empty() ? 1.0 : static_cast<double>(material_share[taxel]));
    }
  }
}

/// As an input of a network.
double SharedLoads::mean_temperature(const Sample& sample, const std::vector<std::size_t>& taxels) const {
  if (sample.taxel_celsius.empty()) return normalised_temperature(sample, taxels.front(), temperatures_);
  double sum = 0.0;
  for (const std::size_t taxel : taxels) sum += normalised_temperature(sample, taxel, temperatures_);
  return sum / static_cast<double>(taxels.size());
}

void SharedLoads::add(const Press& press, const std::vector<std::size_t>& taxels, double material_share) {
  if (std::isnan(material_share)) return;
  const Sample& sample = database_.samples[press.sample];
  MeasuredLoad load;
  load.sample = press.sample;
  load.newtons = material_share * press.newtons;
  load.load_newtons = press.newtons;
  load.touch = press.touch;
  load.temperature = mean_temperature(sample, taxels);
  bool is_measurable = false;
  for (const std::size_t taxel : taxels) {
    if (dead_[taxel]) continue;
    const double excess = excess_siemens(sample, taxel, unloaded_, temperatures_);
    if (excess <= 0.0) continue;
    load.excess.emplace_back(taxel, excess);
    is_measurable = is_measurable || excess > kMeasurableSigmas * unloaded_.noise_siemens[taxel];
  }
  if (is_measurable) loads_.push_back(std::move(load));
}

std::vector<MeasuredLoad> SharedLoads::loads(std::size_t most_shares) const {
  std::size_t shares = 0;
  for (const MeasuredLoad& load : loads_) shares += load.excess.size();
  if (shares <= most_shares) return loads_;
  const std::size_t count = std::max<std::size_t>(loads_.size() * most_shares / shares, 1);
  std::vector<MeasuredLoad> kept;
  for (std::size_t k = 0; k < count; ++k) kept.push_back(loads_[k * loads_.size() / count]);
  return kept;
}

}  // namespace dermis::learn::calibration
