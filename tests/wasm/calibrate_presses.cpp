// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: calibrate_presses CIRCUIT <presses >model
// A press is its taxel, its newtons and the counts of its frame, all in single precision. The circuit is known, or
// "auto": found among all. stdout gets the model file. stderr gets the times of two calibrations [s]: as WebAssembly,
// the first is compiled while it runs.
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "circuits.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/calibration/calibrate.hpp"

namespace {

dermis::ArrayDescription array_of(const std::string& circuit) {
  if (circuit != "auto") return dermis::wasm::described_array(circuit).value();
  dermis::ArrayDescription array = dermis::wasm::described_array("grounded_rows").value();
  array.readout.circuit = dermis::Circuit::automatic;
  array.readout.drive_ohm = {dermis::kFitOhm};
  array.readout.load_ohm = {dermis::kFitOhm};
  return array;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  const dermis::ArrayDescription array = array_of(arguments[1]);
  std::vector<dermis::RawFrame> frames;
  std::vector<dermis::Load> loads;
  std::vector<float> numbers(2 + array.taxel_count());
  while (std::fread(numbers.data(), sizeof(float), numbers.size(), stdin) == numbers.size()) {
    const auto newtons = static_cast<double>(numbers[1]);
    const auto taxel = static_cast<std::size_t>(numbers[0]);
    const std::size_t row = taxel / array.cols;
    const std::size_t col = taxel % array.cols;
    const dermis::TaxelRegion where = newtons > 0.0 ? dermis::TaxelRegion{row, col, row, col} : all_taxels(array);
    loads.push_back({frames.size(), dermis::LoadKind::force, where, newtons});
    dermis::RawFrame frame;
    frame.time = std::chrono::milliseconds(500 * frames.size());
    frame.temperature_celsius = 22.0;
    frame.supply_v = 5.0;
    frame.counts.assign(numbers.begin() + 2, numbers.end());
    frames.push_back(frame);
  }
  std::optional<dermis::Result<dermis::learn::calibration::Calibration>> calibration;
  for (int k = 0; k < 2; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    calibration = dermis::learn::calibration::calibrate(array, frames, loads);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    std::fprintf(stderr, "%.3f\n", taken.count());
  }
  if (!*calibration) return 1;
  const auto bytes = dermis::bytes::models::model_to_bytes((*calibration)->model);
  if (!bytes) return 1;
  std::fwrite(bytes->data(), 1, bytes->size(), stdout);
  return 0;
}
