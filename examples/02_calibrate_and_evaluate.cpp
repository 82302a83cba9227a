// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: 02_calibrate_and_evaluate MODEL
// Calibrates a simulated array of 6 x 8 taxels with single presses, writes the model, and judges it on frames of
// several contacts that it has not seen.
#include <cstdio>
#include <string_view>
#include <vector>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace {

struct Recording {
  std::vector<dermis::RawFrame> frames;
  std::vector<dermis::Load> loads;
};

int fail(const dermis::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

dermis::ArrayDescription make_array() {
  dermis::ArrayDescription array;
  array.name = "example";
  array.rows = 6;
  array.cols = 8;
  array.readout.circuit = dermis::Circuit::divider;
  array.readout.drive_ohm.assign(array.rows, 20.0);
  array.readout.load_ohm.assign(array.cols, 200.0);
  array.readout.adc_bits = 12;
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

dermis::Result<Recording> record(const dermis::ArrayDescription& array, std::string_view scene, std::uint64_t seed) {
  const auto simulator = dermis::learn::simulation::Simulator::create(array, {}, scene, seed);
  if (!simulator) return simulator.error();
  Recording recording;
  dermis::RawFrame frame;
  for (;;) {
    const auto more = (*simulator)->next(frame);
    if (!more) return more.error();
    if (!*more) return recording;
    recording.frames.push_back(frame);
    recording.loads.insert(recording.loads.end(), (*simulator)->loads().begin(), (*simulator)->loads().end());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return fail(dermis::bad_input("usage: 02_calibrate_and_evaluate MODEL"));
  const dermis::ArrayDescription array = make_array();

  const auto presses = record(array, "calibration", 1);
  if (!presses) return fail(presses.error());
  const auto calibration = dermis::learn::calibration::calibrate(array, presses->frames, presses->loads);
  if (!calibration) return fail(calibration.error());
  std::printf("%s\n", calibration->report.training.choice.c_str());
  if (const auto written = dermis::bytes::models::write_model(argv[1], calibration->model); !written) {
    return fail(written.error());
  }

  const auto contacts = record(array, "multitouch", 2);
  if (!contacts) return fail(contacts.error());
  const auto evaluation = dermis::learn::calibration::evaluate(calibration->model, contacts->frames, contacts->loads);
  if (!evaluation) return fail(evaluation.error());
  for (const dermis::learn::calibration::EstimatorResult& result : evaluation->estimators) {
    std::printf("%-20s median %6.2f %%  p99 %6.2f %%\n", result.name.c_str(),
                100.0 * result.relative_error.median.value_or(0.0), 100.0 * result.relative_error.p99.value_or(0.0));
  }
  return 0;
}
