// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/methods.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/reference_array.hpp"

namespace dermis::benchmarks {
namespace {

constexpr std::size_t kSize = 16;
constexpr int kRepeats = 20;

struct Sample {
  ArrayDescription array;
  std::vector<double> siemens;
  std::vector<double> ratio;
};

std::vector<Sample> random_samples(std::size_t count, double drive_ohm) {
  std::vector<Sample> samples(count);
  for (std::size_t k = 0; k < count; ++k) {
    Random random = Random::stream(1, k);
    Sample& sample = samples[k];
    sample.array = support::reference_circuit(kSize, kSize);
    sample.array.readout.drive_ohm.assign(kSize, drive_ohm);
    sample.siemens.resize(sample.array.taxel_count());
    for (double& value : sample.siemens) value = 1.0 / random.log_uniform(1e3, 1e5);
    sample.ratio.resize(sample.siemens.size());
    learn::simulation::ReadoutCircuit::create(sample.array)->ratios(sample.siemens, sample.ratio);
  }
  return samples;
}

using Method = std::function<void(const Sample&, std::span<double>)>;

/// Readings times the one factor that suits the array best, which nobody knows outside of a simulation.
void nothing(const Sample& sample, std::span<double> siemens) {
  std::vector<double> factors(siemens.size());
  for (std::size_t k = 0; k < siemens.size(); ++k) factors[k] = sample.siemens[k] / sample.ratio[k];
  const double factor = upper_median(std::move(factors));
  for (std::size_t k = 0; k < siemens.size(); ++k) siemens[k] = factor * sample.ratio[k];
}

void textbook(const Sample& sample, std::span<double> siemens) {
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    siemens[k] = sample.ratio[k] / (sample.array.readout.load_ohm[k % kSize] * (1.0 - sample.ratio[k]));
  }
}

/// Formula (2) of docs/reasons/derivations-circuits.md, which takes the columns as held at 0 V.
void grounded_row_formula(const Sample& sample, std::span<double> siemens) {
  for (std::size_t row = 0; row < kSize; ++row) {
    double sum = 0.0;
    for (std::size_t col = 0; col < kSize; ++col) {
      const std::size_t k = row * kSize + col;
      siemens[k] = sample.ratio[k] / sample.array.readout.load_ohm[col];
      sum += siemens[k];
    }
    const double line_ratio = 1.0 - sample.array.readout.drive_ohm[row] * sum;
    for (std::size_t col = 0; col < kSize; ++col) siemens[row * kSize + col] /= line_ratio;
  }
}

/// G <- G T / T(G), twice, from the textbook's estimate: the recursion of Hidalgo-Lopez et al. (J. Sensors 2018,
/// 9735741) as docs/reasons/derivations-circuits.md states it, for this circuit and with T(G) solved exactly.
void two_recursions(const Sample& sample, std::span<double> siemens) {
  textbook(sample, siemens);
  const auto circuit = learn::simulation::ReadoutCircuit::create(sample.array);
  std::vector<double> ratio(siemens.size());
  for (int step = 0; step < 2; ++step) {
    circuit->ratios(siemens, ratio);
    for (std::size_t k = 0; k < siemens.size(); ++k) siemens[k] *= sample.ratio[k] / ratio[k];
  }
}

Method dermis_method(const Sample& sample, std::optional<double> tolerance) {
  auto made = touch::compensation::make_crosstalk_inversion(sample.array, {tolerance});
  std::shared_ptr<touch::compensation::CrosstalkInversion> inversion = std::move(*made);
  return [inversion](const Sample& one, std::span<double> siemens) {
    inversion->forget();
    (void)inversion->invert(one.ratio, siemens);
  };
}

void print_method(const std::string& name, const Method& method, const std::vector<Sample>& samples) {
  std::vector<double> errors;
  std::vector<double> times_us;
  std::vector<double> siemens(kSize * kSize);
  for (const Sample& sample : samples) {
    method(sample, siemens);
    for (std::size_t k = 0; k < siemens.size(); ++k) errors.push_back(std::abs(siemens[k] / sample.siemens[k] - 1.0));
    const auto begin = std::chrono::steady_clock::now();
    for (int repeat = 0; repeat < kRepeats; ++repeat) method(sample, siemens);
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - begin;
    times_us.push_back(elapsed.count() / kRepeats);
  }
  const double largest = *std::max_element(errors.begin(), errors.end());
  fmt::print("{:<44}{:>12.2g} %{:>12.2g} %{:>10.2f} us\n", name, 1e2 * upper_median(errors), 1e2 * largest,
             upper_median(times_us));
}

}  // namespace

void print_methods(std::size_t arrays) {
  for (const double drive_ohm : {5.0, 25.0, 100.0}) {
    const std::vector<Sample> samples = random_samples(arrays, drive_ohm);
    fmt::print("\n{} arrays of 16x16 taxels, 1-100 kohm, drivers {} ohm, loads 200 ohm, without noise\n", arrays,
               drive_ohm);
    fmt::print("{:<44}{:>14}{:>14}{:>13}\n", "method", "median error", "largest error", "time");
    print_method("nothing (best single scale)", nothing, samples);
    print_method("textbook divider gL T / (1 - T)", textbook, samples);
    print_method("grounded-row formula (2)", grounded_row_formula, samples);
    print_method("Hidalgo-Lopez, two recursions", two_recursions, samples);
    print_method("dermis, 12 bit (0.01 count)", dermis_method(samples.front(), std::nullopt), samples);
    print_method("dermis, to rounding", dermis_method(samples.front(), 0.0), samples);
  }
}

}  // namespace dermis::benchmarks
