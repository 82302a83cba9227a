// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/cover.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::support {

/// Presses of each weight, 0.4 to 40 N, on each taxel alone of a sheet, with its cover and its film, labelled as they
/// stand on it.
struct SheetPresses {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;

  SheetPresses(const ArrayDescription& array, std::uint64_t seed,
               const std::vector<double>& weights = {0.4, 1.0, 2.5, 6.0, 15.0, 40.0})
      : random_(seed), adc_(array.readout, 0.8), array_(array) {
    for (std::size_t taxel = 0; taxel < array_.taxel_count(); ++taxel)
      ohm_.push_back(900.0 * std::exp(0.15 * random_.normal()));
    for (int k = 0; k < 20; ++k) {
      loads.push_back({frames.size(), LoadKind::force, all_taxels(array_), 0.0});
      press(0, 0.0);
    }
    for (std::size_t taxel = 0; taxel < array_.taxel_count(); ++taxel) {
      for (const double newtons : weights) {
        const std::size_t row = taxel / array_.cols;
        const std::size_t col = taxel % array_.cols;
        loads.push_back({frames.size(), LoadKind::force, {row, col, row, col}, newtons});
        press(taxel, newtons);
      }
    }
  }

 private:
  void press(std::size_t taxel, double newtons) {
    std::vector<double> surface(array_.taxel_count());
    surface[taxel] = newtons;
    std::vector<double> felt(surface.size());
    CoverKernel(array_).spread(std::span<const double>(surface), std::span<double>(felt));
    std::vector<double> siemens(surface.size(), 1.0 / 300e3);
    for (std::size_t k = 0; k < felt.size(); ++k) {
      if (felt[k] > 1e-6)
        siemens[k] += std::exp(0.004 * random_.normal()) / (60.0 + ohm_[k] * std::pow(10.0 / felt[k], 0.9));
    }
    RawFrame frame;
    frame.time = std::chrono::milliseconds(500 * frames.size());
    frame.counts.resize(siemens.size());
    std::vector<double> ratio(siemens.size());
    learn::simulation::ReadoutCircuit::create(array_)->ratios(siemens, felt, ratio);
    adc_.convert(ratio, 5.0, random_, frame.counts);
    frames.push_back(std::move(frame));
  }

  Random random_;
  learn::simulation::Adc adc_;
  ArrayDescription array_;
  std::vector<double> ohm_;
};

}  // namespace dermis::support
