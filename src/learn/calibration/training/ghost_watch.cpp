// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/ghost_watch.hpp"

#include <cmath>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "learn/calibration/even_choice.hpp"
#include "learn/calibration/samples/unloaded_fit.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostUnloaded = 2000;  // samples to see ghosts in

}  // namespace

GhostWatch::GhostWatch(const SampleDatabase& database, const SampleTemperatures& temperatures,
                       std::span<const std::vector<TaxelPoint>> points, const TableMaker& maker)
    : database_(database), temperatures_(temperatures), points_(points), tables_(points.size()) {
  parallel_for(points.size(), [&](std::size_t taxel) {
    TaxelTable table = maker.fit(by_force(points[taxel]));
    if (!table.knots.empty()) tables_[taxel] = assemble_tables({std::move(table)}, {taxel});
  });
}

void GhostWatch::watch(const touch::fusion::ForceNetworks& networks, std::vector<ComparedTaxel>& judged) const {
  std::vector<const Sample*> unloaded;
  for (const Sample& sample : database_.samples) {
    if (sample.unloaded) unloaded.push_back(&sample);
  }
  touch::fusion::ForceFusion fusion(networks);
  ConductanceFrame conductance;
  ForceFrame force;
  for (const std::size_t k : even_choice(unloaded.size(), kMostUnloaded)) {
    const Sample& sample = *unloaded[k];
    conductance.temperature_celsius = sample.temperature_celsius;
    conductance.taxel_celsius = sample.taxel_celsius;
    conductance.siemens.assign(sample.siemens.begin(), sample.siemens.end());
    conductance.sigma_siemens.assign(sample.siemens.size(), 0.0);
    conductance.taxels.assign(sample.siemens.size(), TaxelStatus::ok);
    fusion.process(conductance, force);
    for (std::size_t taxel = 0; taxel < judged.size(); ++taxel) {
      if (!follows_a_press(taxel, sample) || std::isnan(force.newtons[taxel])) continue;
      judged[taxel].ghosts.of_network.push_back(force.newtons[taxel]);
      judged[taxel].ghosts.of_table.push_back(of_table(networks, taxel, sample));
    }
  }
}

bool GhostWatch::follows_a_press(std::size_t taxel, const Sample& sample) const {
  return !tables_[taxel].taxels.empty() && sample.known_newtons[taxel] == 0.0F &&
         sample.frame > database_.samples[points_[taxel].front().sample].frame;
}

float GhostWatch::of_table(const touch::fusion::ForceNetworks& networks, std::size_t taxel,
                           const Sample& sample) const {
  const double offset = temperature_offset(sample, taxel, temperatures_);
  const auto excess = static_cast<float>(networks.unloaded.excess(taxel, sample.siemens[taxel], offset));
  if (excess <= 0.0F) return 0.0F;
  return std::exp(tables_[taxel].at(0, excess, static_cast<float>(offset)).log_newtons);
}

}  // namespace dermis::learn::calibration
