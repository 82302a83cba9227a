// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/learn/calibration/turned_lines.hpp"
#include "dermis/learn/health/examination.hpp"
#include "dermis/learn/health/raw_examination.hpp"
#include "dermis/live/forces/operation.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "labelled_recording.hpp"
#include "process_all.hpp"
#include "source_options.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using learn::health::Diagnosis;
using live::forces::Operation;
using Json = nlohmann::ordered_json;

struct DoctorOptions {
  std::string model;
  std::string array;
  std::string loads;
  std::string in;
  bool json = false;
};

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json fault_json(const learn::health::FaultHistory& history, const ArrayDescription& array) {
  const touch::compensation::LineFault& fault = history.fault;
  Json json = {{"kind", to_string(fault.kind)},
               {"place", place_name(fault, array)},
               {"since_frame", fault.frame},
               {"until_frame", or_null(history.until)},
               {"grounded", fault.grounded}};
  if (fault.kind == touch::compensation::LineFaultKind::drifting_driver) json["drive_ohm"] = fault.drive_ohm;
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
  for (const learn::health::FaultHistory& history : diagnosis.faults)
    json["faults"].push_back(fault_json(history, array));
  fmt::print("{}\n", json.dump(2));
}

Result<Diagnosis> examine(Operation& operation) {
  learn::health::Examination examination(operation.model);
  const Status done = process_all(operation, [&](const RawFrame& raw, const ForceFrame& force) {
    examination.add(raw, force, operation.pipeline);
  });
  if (!done) return done.error();
  return examination.diagnosis(operation.pipeline);
}

Status result_of(const std::vector<std::string>& findings, const char* what) {
  if (findings.empty()) return Done{};
  return failed(fmt::format("{}: {} finding{}", what, findings.size(), findings.size() == 1 ? "" : "s"));
}

void print_json(const learn::health::RawDiagnosis& diagnosis) {
  Json remarks = Json::array();
  if (diagnosis.remark) remarks.push_back(*diagnosis.remark);
  const Json json = {{"healthy", diagnosis.problems().empty()},
                     {"frames", diagnosis.frames},
                     {"seconds", diagnosis.seconds},
                     {"least_counts", diagnosis.least_counts},
                     {"most_counts", diagnosis.most_counts},
                     {"problems", diagnosis.problems()},
                     {"remarks", remarks}};
  fmt::print("{}\n", json.dump(2));
}

/// A description that takes any count, where only the shape is known.
ArrayDescription of_shape(FrameShape shape) {
  ArrayDescription array;
  array.rows = shape.rows;
  array.cols = shape.cols;
  array.readout.circuit = Circuit::none;
  array.readout.adc_bits = 24;
  return array;
}

struct ExaminedCounts {
  FrameShape shape;
  learn::health::RawDiagnosis diagnosis;
  std::vector<RawFrame> frames;  ///< Where they are kept.
};

Result<ExaminedCounts> examine_counts(const std::string& from, const ArrayDescription* array, bool keeps_frames) {
  const auto source = live::sources::open_source(from, source_options(array));
  if (!source) return source.error();
  std::optional<learn::health::RawExamination> examination;
  ExaminedCounts examined;
  RawFrame raw;
  while (!stop_flag().load()) {
    const Result<bool> more = (*source)->next(raw);
    if (!more) return more.error();
    if (!*more) break;
    if (!examination) {
      examined.shape = (*source)->shape().value();
      examination.emplace(examined.shape, array != nullptr ? std::optional(array->readout) : std::nullopt);
    }
    examination->add(raw);
    if (keeps_frames) examined.frames.push_back(raw);
  }
  if (!examination) return bad_input(from + ": has no frame");
  examined.diagnosis = examination->diagnosis();
  return examined;
}

/// Whether the taxels answer that were pressed.
Status examine_places(const std::string& path, const ArrayDescription& array, ExaminedCounts& examined) {
  const Result<std::vector<Load>> loads = read_told_loads(path, array, examined.frames.size());
  if (!loads) return loads.error();
  auto turned = learn::calibration::find_turned_lines(array, examined.frames, *loads);
  if (turned) examined.diagnosis.findings.push_back(*std::move(turned));
  return Done{};
}

/// By the counts alone.
Status doctor_without_model(const DoctorOptions& options) {
  std::optional<ArrayDescription> array;
  if (!options.array.empty()) {
    Result<ArrayDescription> read = bytes::files::read_array(options.array);
    if (!read) return read.error();
    array = *std::move(read);
  }
  Result<ExaminedCounts> examined = examine_counts(options.in, array ? &*array : nullptr, !options.loads.empty());
  if (!examined) return examined.error();
  if (!options.loads.empty()) {
    const ArrayDescription known = array.value_or(of_shape(examined->shape));
    if (Status done = examine_places(options.loads, known, *examined); !done) return done;
  }
  const learn::health::RawDiagnosis& diagnosis = examined->diagnosis;
  options.json ? print_json(diagnosis) : fmt::print("{}", learn::health::describe(diagnosis, examined->shape));
  return result_of(diagnosis.problems(), "the readings are doubtful");
}

Status doctor(const DoctorOptions& options) {
  if (options.model.empty()) return doctor_without_model(options);
  const Result<std::unique_ptr<Operation>> operation =
      live::forces::open_operation(options.model, options.in, source_options());
  if (!operation) return operation.error();
  const Result<Diagnosis> diagnosis = examine(**operation);
  if (!diagnosis) return diagnosis.error();
  const touch::pipeline::Model& model = (*operation)->model;
  options.json ? print_json(*diagnosis, model.array) : fmt::print("{}", learn::health::describe(*diagnosis, model));
  return result_of(diagnosis->findings, "the array is not healthy");
}

}  // namespace

void add_doctor(Command& command) {
  auto options = std::make_shared<DoctorOptions>();
  const Option model =
      command.input_file("--model", options->model,
                         "Model file of 'dermis calibrate', or array.toml where readings are forces; without one, the "
                         "counts alone are examined");
  command.input_file("--array", options->array, "array.toml, where there is no model").excludes(model);
  command
      .input_file("--loads", options->loads,
                  "loads.csv of a file, where there is no model: whether the taxels answer that it names")
      .excludes(model);
  command.input("--in", options->in, "Raw counts: frames.csv, a recording, or the URI of a device").required();
  command.flag("--json", options->json, "Print the result as JSON");
  command.action([options] { return doctor(*options); });
  Command check = command.subcommand("check", "Weigh a known object: has the calibration aged?");
  add_check(check);
  Command mend =
      command.subcommand("recalibrate", "Mend the gains of a model by known weights, of which one is enough");
  add_recalibrate(mend);
}

}  // namespace dermis::app
