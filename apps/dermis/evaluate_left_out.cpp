// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "evaluate_left_out.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "calibration_input.hpp"
#include "dermis/learn/calibration/recorded_presses.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using learn::calibration::Calibration;
using learn::calibration::RecordedPress;
using live::forces::ForceTables;

/// Means over the loaded frames of a press.
struct JudgedPress {
  RecordedPress frames;
  double newtons = 0.0;
  double estimate_n = 0.0;
};

Result<JudgedPress> judge(const RecordedPress& press, std::span<const std::optional<double>> newtons,
                          const Calibration& calibration, const std::vector<RawFrame>& frames, ForceTables& tables) {
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(calibration.model);
  if (!pipeline) return pipeline.error();
  JudgedPress judged{press};
  double count = 0.0;
  ForceFrame force;
  for (std::size_t k = press.first; k < press.end; ++k) {
    pipeline->process(frames[k], force);
    if (Status written = tables.write(force); !written) return written.error();
    const double load_n = newtons[k - press.first].value_or(0.0);
    if (load_n <= 0.0) continue;
    judged.newtons += load_n;
    judged.estimate_n += force.total().newtons;
    count += 1.0;
  }
  judged.newtons /= count;
  judged.estimate_n /= count;
  return judged;
}

struct Errors {
  double rmse_n = 0.0;
  double median_relative = 0.0;
};

Errors errors_of(const std::vector<JudgedPress>& presses) {
  double square = 0.0;
  std::vector<double> relative;
  for (const JudgedPress& press : presses) {
    square += std::pow(press.estimate_n - press.newtons, 2);
    relative.push_back(std::abs(press.estimate_n / press.newtons - 1.0));
  }
  return {std::sqrt(square / static_cast<double>(presses.size())), upper_median(std::move(relative))};
}

void print_json(const std::vector<JudgedPress>& presses) {
  const Errors errors = errors_of(presses);
  nlohmann::ordered_json json = {{"rmse_n", errors.rmse_n},
                                 {"median_relative_error", errors.median_relative},
                                 {"presses", nlohmann::ordered_json::array()}};
  for (const JudgedPress& press : presses) {
    json["presses"].push_back({{"first_frame", press.frames.first},
                               {"frames", press.frames.end - press.frames.first},
                               {"newtons", press.newtons},
                               {"estimate_n", press.estimate_n}});
  }
  fmt::print("{}\n", json.dump(2));
}

void print_text(const std::vector<JudgedPress>& presses) {
  const Errors errors = errors_of(presses);
  const auto error = [](const JudgedPress& press) { return std::abs(press.estimate_n / press.newtons - 1.0); };
  const auto worst = std::max_element(presses.begin(), presses.end(),
                                      [&](const auto& a, const auto& b) { return error(a) < error(b); });
  fmt::print("{} presses, each by a calibration without it: {:.3f} N RMSE, median {:.2f} %, worst {:.2f} % ",
             presses.size(), errors.rmse_n, 100.0 * errors.median_relative, 100.0 * error(*worst));
  fmt::print("({:.3g} N, frames {} to {}); means of the loaded frames of each\n", worst->newtons, worst->frames.first,
             worst->frames.end - 1);
}

}  // namespace

void add_left_out_evaluation(Command& command, LeftOutEvaluation& evaluation) {
  command.heading("Presses left out");
  command
      .option("--leave-out", evaluation.leave_out,
              "press: judge calibrations with --frames and --loads, each without a press of theirs, on that press")
      .one_of({"press"});
  command.input_file("--array", evaluation.array, "array.toml, where something is left out");
  command.output("--out", evaluation.tables.forces, "forces.csv to write: each press as the calibration without it");
  command.output("--totals", evaluation.tables.totals, "totals.csv to write, the same");
  command.output("--contacts", evaluation.tables.contacts, "contacts.csv to write, the same");
}

Status evaluate_left_out(const LeftOutEvaluation& evaluation, const std::string& frames_path,
                         const std::string& loads_path, bool json) {
  const Result<CalibrationInput> input = CalibrationInput::read({evaluation.array, frames_path, loads_path, 0.0}, {});
  if (!input) return input.error();
  const auto& [array, settle, frames, loads] = *input;
  touch::pipeline::Model of_array;
  of_array.array = array;
  Result<ForceTables> tables = ForceTables::create(evaluation.tables, of_array);
  if (!tables) return tables.error();
  const std::vector<RecordedPress> presses = learn::calibration::recorded_presses(frames, loads);
  std::vector<JudgedPress> judged;
  Progress progress(array.name);
  progress.show("presses", 0.0);
  Status done = learn::calibration::judge_each_left_out(
      array, frames, loads, presses,
      [&](const RecordedPress& press, std::span<const std::optional<double>> newtons,
          const Calibration& without_it) -> Status {
        Result<JudgedPress> result = judge(press, newtons, without_it, frames, *tables);
        if (!result) return result.error();
        judged.push_back(*result);
        progress.show("presses", static_cast<double>(judged.size()) / static_cast<double>(presses.size()));
        return Done{};
      });
  if (!done) return done;
  if (Status committed = tables->commit(); !committed) return committed;
  json ? print_json(judged) : print_text(judged);
  return Done{};
}

}  // namespace dermis::app
