// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "commands.hpp"
#include "dermis/health/examination.hpp"
#include "dermis/operation/operation.hpp"
#include "process_all.hpp"
#include "source_options.hpp"

namespace dermis::app {
namespace {

using health::Diagnosis;
using operation::Operation;
using Json = nlohmann::ordered_json;

struct DoctorOptions {
  std::string model;
  std::string in;
  bool json = false;
};

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json fault_json(const health::FaultHistory& history, const ArrayDescription& array) {
  const compensation::LineFault& fault = history.fault;
  Json json = {{"kind", to_string(fault.kind)},
               {"place", place_name(fault, array)},
               {"since_frame", fault.frame},
               {"until_frame", or_null(history.until)},
               {"grounded", fault.grounded}};
  if (fault.kind == compensation::LineFaultKind::drifting_driver) json["drive_ohm"] = fault.drive_ohm;
  return json;
}

void print_json(const Diagnosis& diagnosis, const ArrayDescription& array) {
  const auto& temperature = diagnosis.temperature;
  Json json = {{"healthy", diagnosis.is_healthy()},
               {"frames", diagnosis.frames},
               {"frames_rejected", diagnosis.frames_rejected},
               {"seconds", diagnosis.seconds},
               {"noise_counts", or_null(diagnosis.noise_counts)},
               {"calibrated_noise_counts", array.readout.adc_noise_counts},
               {"saturated_share", diagnosis.saturated_share},
               {"offset_drift", or_null(diagnosis.offset_drift)},
               {"offset_spread", or_null(diagnosis.offset_spread)},
               {"gain_spread", or_null(diagnosis.ageing.gain_spread)},
               {"gain_spread_sigma", diagnosis.ageing.gain_spread ? Json(diagnosis.ageing.spread_sigma) : Json()},
               {"coldest_celsius", temperature ? Json(temperature->coldest_celsius) : Json()},
               {"hottest_celsius", temperature ? Json(temperature->hottest_celsius) : Json()},
               {"frames_unsolved", diagnosis.frames_unsolved},
               {"worst_misfit_sigma", diagnosis.worst_misfit_sigma},
               {"blind_lines", diagnosis.blind_lines},
               {"faults", Json::array()},
               {"problems", diagnosis.findings},
               {"remarks", diagnosis.remarks}};
  for (const health::FaultHistory& history : diagnosis.faults) json["faults"].push_back(fault_json(history, array));
  fmt::print("{}\n", json.dump(2));
}

Result<Diagnosis> examine(Operation& operation) {
  health::Examination examination(operation.model);
  const Status done = process_all(operation, [&](const RawFrame& raw, const ForceFrame& force) {
    examination.add(raw, force, operation.pipeline);
  });
  if (!done) return done.error();
  return examination.diagnosis(operation.pipeline);
}

Status doctor(const DoctorOptions& options) {
  const Result<std::unique_ptr<Operation>> operation =
      operation::open_operation(options.model, options.in, source_options());
  if (!operation) return operation.error();
  const Result<Diagnosis> diagnosis = examine(**operation);
  if (!diagnosis) return diagnosis.error();
  const pipeline::Model& model = (*operation)->model;
  options.json ? print_json(*diagnosis, model.array) : fmt::print("{}", health::describe(*diagnosis, model));
  if (diagnosis->is_healthy()) return Done{};
  const std::size_t findings = diagnosis->findings.size();
  return failed(fmt::format("the array is not healthy: {} finding{}", findings, findings == 1 ? "" : "s"));
}

}  // namespace

void add_doctor(Command& command) {
  auto options = std::make_shared<DoctorOptions>();
  command
      .input_file("--model", options->model,
                  "Model file of 'dermis calibrate', or array.toml where readings are forces")
      .required();
  command.input("--in", options->in, "Raw counts: frames.csv, a recording, or the URI of a device").required();
  command.flag("--json", options->json, "Print the result as JSON");
  command.action([options] { return doctor(*options); });
}

}  // namespace dermis::app
