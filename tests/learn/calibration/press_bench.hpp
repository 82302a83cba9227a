// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"

namespace dermis::learn::calibration {

inline constexpr double kUnloadedSiemens = 1e-5;
inline constexpr double kNoiseSiemens = 1e-8;  // of a reading: one count

/// Presses on one row of taxels whose law is a function, seen through its conductances as they are.
struct PressBench {
  std::size_t taxels;
  std::function<double(std::size_t taxel, double newtons)> law;  // excess conductance [S]
  double noise = 0.01;                                           // of it, relative
  Random random{7};

  Sample sample(std::size_t taxel, double newtons) {
    Sample sample;
    sample.sigma_ratio = kNoiseSiemens;
    sample.siemens.assign(taxels, static_cast<float>(kUnloadedSiemens));
    for (float& siemens : sample.siemens) siemens += static_cast<float>(kNoiseSiemens * random.normal());
    sample.taxels.assign(taxels, TaxelStatus::ok);
    sample.known_newtons.assign(taxels, 0.0F);
    sample.unloaded = newtons == 0.0;
    if (newtons > 0.0) {
      sample.siemens[taxel] += static_cast<float>(law(taxel, newtons) * (1.0 + noise * random.normal()));
      sample.known_newtons[taxel] = static_cast<float>(newtons);
    }
    sample.ratio = sample.siemens;  // as they are
    return sample;
  }

  SampleDatabase presses(const std::vector<double>& forces, int repeats) {
    SampleDatabase database;
    database.array.rows = 1;
    database.array.cols = taxels;
    database.array.readout.circuit = Circuit::none;
    database.siemens_per_count = kNoiseSiemens;
    for (int k = 0; k < 20; ++k) database.samples.push_back(sample(0, 0.0));
    for (int repeat = 0; repeat < repeats; ++repeat) {
      for (const double newtons : forces) {
        for (std::size_t taxel = 0; taxel < taxels; ++taxel) database.samples.push_back(sample(taxel, newtons));
      }
    }
    for (std::size_t k = 0; k < database.samples.size(); ++k) database.samples[k].frame = k;
    return database;
  }
};

/// In equal ratios, both ends included.
inline std::vector<double> forces_between(double lightest, double heaviest, std::size_t count) {
  std::vector<double> forces;
  for (std::size_t k = 0; k < count; ++k) {
    forces.push_back(lightest * std::pow(heaviest / lightest, static_cast<double>(k) / static_cast<double>(count - 1)));
  }
  return forces;
}

/// What networks make of new presses.
class BenchForces {
 public:
  BenchForces(const touch::fusion::ForceNetworks& networks, PressBench bench)
      : bench_(std::move(bench)), fusion_(networks) {}

  /// Of the taxel pressed with `newtons`; the frame holds until the next call.
  const ForceFrame& press(std::size_t taxel, double newtons) {
    const Sample sample = bench_.sample(taxel, newtons);
    ConductanceFrame conductance;
    conductance.siemens.assign(sample.siemens.begin(), sample.siemens.end());
    conductance.sigma_siemens.assign(bench_.taxels, kNoiseSiemens);
    conductance.taxels = sample.taxels;
    fusion_.process(conductance, force_);
    return force_;
  }

 private:
  PressBench bench_;
  touch::fusion::ForceFusion fusion_;
  ForceFrame force_;
};

}  // namespace dermis::learn::calibration
