// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: calibrate_presses CIRCUIT <presses >model
// A press is its taxel, its newtons and the counts of its frame, all in single precision. The circuit is known, or
// "auto": found among all. stdout gets the model file, stderr the time of each stage [s].
#include <chrono>
#include <cstdio>
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
  const auto calibration = dermis::learn::calibration::calibrate(array, frames, loads);
  if (!calibration) {
    std::fprintf(stderr, "%s\n", calibration.error().message.c_str());
    return 1;
  }
  const auto bytes = dermis::bytes::models::model_to_bytes(calibration->model);
  if (!bytes) return 1;
  std::fwrite(bytes->data(), 1, bytes->size(), stdout);
  for (const auto& stage : calibration->report.stages) std::fprintf(stderr, "%s %.3f\n", stage.stage.c_str(), stage.seconds);
  return 0;
}
