// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/calibrate.hpp"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "calibration_input.hpp"
#include "calibration_text.hpp"
#include "commands.hpp"
#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/bytes/files/loads_csv.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/calibration/strip_training.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "dermis/touch/frames/version.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "interruption.hpp"
#include "kept_model.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using learn::calibration::Calibration;
using learn::calibration::CalibrationReport;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct CalibrateOptions {
  CalibrationFiles files;
  std::string out;
  bool json = false;
  bool is_verbose = false;
};

Status add_hashes(const CalibrateOptions& options, std::map<std::string, std::string>& provenance) {
  const Result<live::sources::SourceName> from = live::sources::SourceName::parse(options.files.frames);
  if (!from) return from.error();
  const std::string& frames = from->file;
  for (const auto& [key, path] : {std::pair{"array hash", &options.files.array}, std::pair{"frames hash", &frames},
                                  std::pair{"loads hash", &options.files.loads}}) {
    if (std::filesystem::is_directory(*path)) continue;  // of pictures
    const Result<std::string> hash = bytes::files::content_hash(*path);
    if (!hash) return hash.error();
    provenance[key] = *hash;
  }
  provenance["dermis version"] = DERMIS_VERSION;
  return Done{};
}

nlohmann::ordered_json taxel_names(const std::vector<std::size_t>& taxels, const ArrayDescription& array) {
  auto names = nlohmann::ordered_json::array();
  for (const std::size_t taxel : taxels) names.push_back(array.taxel_name(taxel));
  return names;
}

nlohmann::ordered_json circuit_json(const learn::calibration::CircuitFit& fit) {
  const Readout& readout = fit.array.readout;
  nlohmann::ordered_json json = {{"kind", to_string(readout.circuit)},
                                 {"idle_rows", to_string(readout.idle_rows)},
                                 {"idle_columns", to_string(readout.idle_columns)},
                                 {"drive_ohm", readout.drive_ohm},
                                 {"drive_relative_error", fit.drive_error},
                                 {"common_drive_relative_error", fit.common_drive_error},
                                 {"load_ohm", readout.load_ohm},
                                 {"load_relative_error", fit.load_error},
                                 {"statements", fit.statements},
                                 {"telling_presses", nlohmann::ordered_json::array()},
                                 {"candidates", nlohmann::ordered_json::array()}};
  for (const learn::calibration::PressPair& pair : fit.discriminating_presses) {
    json["telling_presses"].push_back(
        {{"taxels", {fit.array.taxel_name(pair.first), fit.array.taxel_name(pair.second)}}, {"newtons", pair.newtons}});
  }
  for (const learn::calibration::CircuitCandidate& candidate : fit.candidates) {
    json["candidates"].push_back({{"name", candidate.name},
                                  {"misfit", candidate.misfit},  // null: not possible, or not resolved
                                  {"chosen", candidate.chosen},
                                  {"indistinguishable", candidate.indistinguishable}});
  }
  return json;
}

template <typename Sigma>
void add_if_known(const char* name, const Sigma& sigma, nlohmann::ordered_json& json) {
  if (sigma) json[name] = *sigma;
}

void print_json(const CalibrationReport& report, const ArrayDescription& array,
                const std::optional<learn::calibration::CircuitFit>& circuit) {
  const learn::calibration::TrainingReport& training = report.training;
  nlohmann::ordered_json json = {{"frames", report.frames},
                                 {"frames_rejected", report.frames_rejected},
                                 {"remarks", report.remarks},
                                 {"doubts", report.doubts},
                                 {"lacks_proof", report.lacks_proof},
                                 {"networks", training.choice},
                                 {"own_networks", training.own_networks},
                                 {"shared_networks", training.shared_networks},
                                 {"hidden_units", training.hidden_units},
                                 {"groups", training.groups},
                                 {"groups_on_tables", training.groups_on_tables},
                                 {"table_taxels", taxel_names(training.table_taxels, array)},
                                 {"uses_temperature", training.uses_temperature},
                                 {"lightest_newtons", training.lightest_newtons},
                                 {"heaviest_newtons", training.heaviest_newtons},
                                 {"median_fit_error", training.median_fit_error},
                                 {"worst_fit_error", training.worst_fit_error},
                                 {"shared_leave_one_out_error", training.shared_leave_one_out_error},
                                 {"supply_noise", report.uncertainty.supply_noise},
                                 {"temperature_sigma_celsius", report.uncertainty.temperature_sigma_celsius},
                                 {"dead_taxels", taxel_names(training.dead_taxels, array)},
                                 {"seconds", nlohmann::ordered_json::object()}};
  if (circuit) json["circuit"] = circuit_json(*circuit);
  for (const learn::calibration::StageTime& stage : report.stages) json["seconds"][stage.stage] = stage.seconds;
  const learn::calibration::UncertaintyReport& uncertainty = report.uncertainty;
  json["adc_noise_counts"] = uncertainty.adc_noise_counts.value_or(array.readout.adc_noise_counts);
  if (report.unseen) json["unseen"] = {{"median", report.unseen->median}, {"p95", report.unseen->p95}};
  add_if_known("relative_sigma", uncertainty.relative_sigma, json);
  add_if_known("relative_sigma_of_shared", uncertainty.relative_sigma_of_shared, json);
  if (!report.memory.empty()) json["memory"] = report.memory;
  add_if_known("relative_sigma_of_tables", uncertainty.relative_sigma_of_tables, json);
  add_if_known("relative_sigma_of_unpressed", uncertainty.relative_sigma_of_unpressed, json);
  fmt::print("{}\n", json.dump(2));
}

Status calibrate(const CalibrateOptions& options) {
  auto start = Clock::now();
  const Result<CalibrationInput> input = CalibrationInput::read(options.files, options.out);
  if (!input) return input.error();
  const auto& [array, settle, frames, loads] = *input;
  const auto positions = bytes::files::read_touch_positions(options.files.loads, array, frames.size());
  if (!positions) return positions.error();
  const double read_s = seconds_since(start);

  Progress progress(array.name);
  progress.show("circuit", 0.0);
  start = Clock::now();
  const auto database = learn::calibration::build_sample_database(
      array, frames, loads, settle, [&](double share) { progress.show("circuit", share); });
  if (!database) return database.error();
  const double circuit_s = seconds_since(start);
  progress.show("circuit", 1.0);
  Result<Calibration> calibration = learn::calibration::calibrate(
      *database, frames, [&](const std::string& stage, double share) { progress.show(stage, share); });
  if (!calibration) return calibration.error();
  if (!positions->empty()) {
    Result<touch::contacts::StripTable> strip = learn::calibration::train_strip(calibration->model, frames, *positions);
    if (!strip) return strip.error();
    calibration->model.strip = *std::move(strip);
  }
  std::vector<learn::calibration::StageTime>& stages = calibration->report.stages;
  stages.insert(stages.begin(), {{"reading", read_s}, {"circuit", circuit_s}});
  if (Status hashed = add_hashes(options, calibration->model.provenance); !hashed) return hashed;
  if (Status kept = keep_earlier_model(options.out); !kept) return kept;
  if (Status written = bytes::models::write_model(options.out, calibration->model); !written) return written;
  if (options.json) {
    print_json(calibration->report, array, database->circuit_fit);
    return Done{};
  }
  const CalibrationText text{*calibration, options.out, positions->size()};
  text.print_summary();
  if (options.is_verbose) text.print_details();
  return Done{};
}

}  // namespace

void add_calibrate(Command& command) {
  auto options = std::make_shared<CalibrateOptions>();
  options->files.add(command);
  command.output_model("--out", options->out, "Model file to write (safetensors)").required();
  command.flag("--json", options->json, "Print the report as JSON");
  command.flag("--verbose", options->is_verbose, "Print also how labels, circuit, networks and noise were judged");
  command.action([options] {
    end_when_interrupted();
    return calibrate(*options);
  });
}

}  // namespace dermis::app
