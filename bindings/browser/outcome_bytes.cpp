// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bindings/browser/outcome_bytes.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "dermis/bytes/models/model_file.hpp"

namespace dermis::browser {
namespace {

using learn::calibration::Calibration;
using learn::calibration::CalibrationReport;
using learn::calibration::FitOutcome;
using nlohmann::json;

json to_json(const std::optional<double>& number) {
  return number ? json(*number) : json();
}

std::optional<double> number_of(const json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

json to_json(const CalibrationReport& report) {
  json pairs = json::array();
  for (const auto& pair : report.discriminating_presses) pairs.push_back({pair.first, pair.second, pair.newtons});
  const learn::calibration::TrainingReport& training = report.training;
  return {{"pairs", std::move(pairs)},
          {"doubts", report.doubts},
          {"dead", training.dead_taxels},
          {"newtons", {training.lightest_newtons, training.heaviest_newtons}},
          {"uses_temperature", training.uses_temperature},
          {"celsius", {training.lowest_celsius, training.highest_celsius}}};
}

void from_json(const json& value, CalibrationReport& report) {
  for (const json& pair : value.at("pairs")) report.discriminating_presses.push_back({pair[0], pair[1], pair[2]});
  value.at("doubts").get_to(report.doubts);
  learn::calibration::TrainingReport& training = report.training;
  value.at("dead").get_to(training.dead_taxels);
  training.lightest_newtons = value.at("newtons")[0];
  training.heaviest_newtons = value.at("newtons")[1];
  value.at("uses_temperature").get_to(training.uses_temperature);
  training.lowest_celsius = value.at("celsius")[0];
  training.highest_celsius = value.at("celsius")[1];
}

json to_json(const Result<Calibration>& calibration) {
  if (!calibration) return {{"failure", calibration.error().message}};
  const Result<std::string> model = bytes::models::model_to_bytes(calibration->model);
  if (!model) return {{"failure", model.error().message}};
  return {{"model", json::binary({model->begin(), model->end()})}, {"report", to_json(calibration->report)}};
}

Result<Calibration> calibration_of(const json& value) {
  if (const auto failure = value.find("failure"); failure != value.end()) return failed(failure->get<std::string>());
  const std::vector<std::uint8_t>& bytes = value.at("model").get_binary();
  Result<touch::pipeline::Model> model =
      bytes::models::model_from_bytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "the model");
  if (!model) return model.error();
  Calibration calibration{*std::move(model), {}};
  from_json(value.at("report"), calibration.report);
  return calibration;
}

}  // namespace

std::string outcome_to_bytes(const FitOutcome& outcome) {
  json value{{"error", to_json(outcome.error)}, {"unpressed_error", to_json(outcome.unpressed_error)}};
  if (outcome.calibration) value["calibration"] = to_json(*outcome.calibration);
  std::string bytes;
  json::to_cbor(value, bytes);
  return bytes;
}

Result<FitOutcome> outcome_from_bytes(std::string_view bytes) {
  const json value = json::from_cbor(bytes, true, false);
  if (!value.is_object()) return failed("the fit has handed back what is no outcome");
  FitOutcome outcome;
  outcome.error = number_of(value.at("error"));
  outcome.unpressed_error = number_of(value.at("unpressed_error"));
  if (const auto calibration = value.find("calibration"); calibration != value.end()) {
    outcome.calibration = calibration_of(*calibration);
  }
  return outcome;
}

}  // namespace dermis::browser
