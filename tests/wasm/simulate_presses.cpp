// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: simulate_presses CIRCUIT PRESSES >presses
// The frames of a guided calibration, for calibrate_presses: the array at rest, then five weights on taxels all over
// it.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "circuits.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/touch/frames/random.hpp"

namespace {

constexpr std::array kWeightsN = {1.0, 2.0, 5.0, 10.0, 20.0};
constexpr std::size_t kUnloadedFrames = 20;
constexpr std::size_t kFramesOfPress = 2;
constexpr int kReadings = 50;  // of which a frame is the mean
constexpr double kReadingSeconds = 0.01;
constexpr double kCelsius = 22.0;
constexpr double kSupplyV = 5.0;

class Bench {
 public:
  explicit Bench(const dermis::ArrayDescription& array)
      : rubber_(dermis::learn::simulation::ConductiveRubber::create({}, array.rows, array.cols, 1).value()),
        circuit_(dermis::learn::simulation::ReadoutCircuit::create(array).value()),
        adc_(array.readout, 1.0),
        siemens_(array.taxel_count()),
        ratio_(array.taxel_count()),
        force_n_(array.taxel_count()) {}

  void write(std::size_t taxel, double newtons) {
    force_n_.assign(force_n_.size(), 0.0);
    force_n_[taxel] = newtons;
    std::vector<float> sum(force_n_.size());
    std::vector<float> counts(force_n_.size());
    for (int reading = 0; reading < kReadings; ++reading) {
      rubber_.press(force_n_, kReadingSeconds);
      rubber_.read(kCelsius, siemens_);
      circuit_.ratios(siemens_, ratio_);
      adc_.convert(ratio_, kSupplyV, random_, counts);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += counts[k];
    }
    std::vector<float> numbers{static_cast<float>(taxel), static_cast<float>(newtons)};
    for (const float counts_of_all : sum) numbers.push_back(counts_of_all / static_cast<float>(kReadings));
    std::fwrite(numbers.data(), sizeof(float), numbers.size(), stdout);
  }

 private:
  dermis::learn::simulation::ConductiveRubber rubber_;
  dermis::learn::simulation::ReadoutCircuit circuit_;
  dermis::learn::simulation::Adc adc_;
  dermis::Random random_{1};
  std::vector<double> siemens_;
  std::vector<double> ratio_;
  std::vector<double> force_n_;
};

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  const auto array = dermis::wasm::described_array(arguments[1]);
  if (!array) return 2;
  const std::size_t presses = std::strtoul(arguments[2], nullptr, 10);
  const std::size_t taxels = presses / kWeightsN.size();
  if (taxels == 0) return 2;
  Bench bench(*array);
  for (std::size_t frame = 0; frame < kUnloadedFrames; ++frame) bench.write(0, 0.0);
  for (std::size_t press = 0; press < taxels * kWeightsN.size(); ++press) {
    const std::size_t taxel = (press % taxels) * array->taxel_count() / taxels;
    for (std::size_t frame = 0; frame < kFramesOfPress; ++frame) bench.write(taxel, kWeightsN[press / taxels]);
  }
  return 0;
}
