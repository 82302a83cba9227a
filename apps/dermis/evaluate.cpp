// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "commands.hpp"
#include "dermis/calibration/evaluation.hpp"
#include "dermis/paper/paper_bank_file.hpp"
#include "dermis/report/evaluation_report.hpp"
#include "dermis/report/wording.hpp"
#include "evaluate_classes.hpp"
#include "example_options.hpp"
#include "interruption.hpp"
#include "labelled_recording.hpp"
#include "report_origin.hpp"

namespace dermis::app {
namespace {

using calibration::Evaluation;

struct EvaluateOptions {
  std::string model;
  std::string frames;
  std::string loads;
  std::string report;
  std::string bank;
  std::string classes;
  recognising::ExampleOptions examples;  // of the classes; --model and --frames are above
  bool json = false;
};

std::string percent(const std::optional<double>& share) {
  if (!share) return "-";
  return std::isfinite(*share) ? fmt::format("{:.2f} %", 100.0 * *share) : "no force";
}

std::string newtons(const std::optional<double>& value) {
  if (!value) return "-";
  return std::isfinite(*value) ? fmt::format("{:.3f} N", *value) : "no force";
}

void print_sums(const calibration::SumErrors& sums) {
  if (sums.untouched > 0) {
    fmt::print("sums of {} untouched frames: mean {:+.4f} N, {:.1f} % within 2 sigma\n", sums.untouched,
               *sums.untouched_mean_n, 100.0 * *sums.untouched_within_2_sigma);
  }
  if (sums.touched > 0) {
    fmt::print(
        "sums of {} touched frames: bias {:+.3f} %, within the 68 % interval in {:.1f} %, the 95 % interval in {:.1f} "
        "%\n",
        sums.touched, 100.0 * *sums.relative_bias, 100.0 * *sums.share_68, 100.0 * *sums.share_95);
  }
}

void print_text(const Evaluation& evaluation) {
  const auto& first = evaluation.estimators.front();
  fmt::print("{} labelled frames ({} rejected), {} taxels of at least {:.3g} N, {} unloaded, {} totals\n\n",
             evaluation.frames, evaluation.frames_rejected, first.relative_error.count, evaluation.judged_from_n,
             first.ghost_n.count, first.totals_judged);
  fmt::print("{:<20}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "estimator", "median", "p95", "p99", "max", "ghost p99",
             "total rmse");
  for (const calibration::EstimatorResult& result : evaluation.estimators) {
    fmt::print("{:<20}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", report::estimator_words(result.name),
               percent(result.relative_error.median), percent(result.relative_error.p95),
               percent(result.relative_error.p99), percent(result.relative_error.max), newtons(result.ghost_n.p99),
               newtons(result.total_rmse_n));
  }
  if (evaluation.coverage.count > 0) {
    fmt::print(
        "\n1-sigma: of {} taxels, the true force is within the 68 % interval in {:.1f} %, the 95 % interval in {:.1f} "
        "%\n",
        evaluation.coverage.count, 100.0 * *evaluation.coverage.share_68, 100.0 * *evaluation.coverage.share_95);
  }
  print_sums(evaluation.sums);
  const calibration::BoundComparison& bound = evaluation.bound;
  if (bound.frames > 0) {
    fmt::print("Cramer-Rao bound of the ADC noise: {:.2f} % of the force (median of {} taxels); dermis {:.2f} %\n",
               100.0 * bound.median_bound, bound.taxels, 100.0 * bound.median_deviation);
  }
}

/// Checks the options for an evaluation of forces.
Status check_needed(const EvaluateOptions& options) {
  if (options.model.empty()) return bad_input("--model is required");
  if (options.frames.empty()) return bad_input("--frames is required");
  if (options.loads.empty()) return bad_input("--loads is required");
  if (!options.examples.data.labels.empty()) return bad_input("--labels: needs --classes");
  return Done{};
}

Status evaluate_forces(const EvaluateOptions& options) {
  if (Status checked = check_needed(options); !checked) return checked;
  const Result<LabelledRecording> recording = LabelledRecording::read(options.model, options.frames, options.loads);
  if (!recording) return recording.error();
  const auto& [model, frames, loads] = *recording;
  std::optional<paper::PaperBank> bank;
  if (!options.bank.empty()) {
    Result<paper::PaperBank> read = paper::read_paper_bank(options.bank);
    if (!read) return read.error();
    bank = std::move(*read);
  }
  const Result<Evaluation> evaluation = calibration::evaluate(model, frames, loads, bank ? &*bank : nullptr);
  if (!evaluation) return evaluation.error();
  if (!options.report.empty()) {
    const report::Origin origin = report_origin({options.frames, options.loads, options.model}, frames);
    Status written = report::write_evaluation_report(options.report, *evaluation, model, origin);
    if (!written) return written;
  }
  options.json ? fmt::print("{}\n", calibration::to_json(*evaluation)) : print_text(*evaluation);
  if (evaluation->most_have_forces) return Done{};
  return failed(options.frames + ": " + evaluation->most_have_forces.error().message);
}

Status evaluate(const EvaluateOptions& options) {
  if (options.classes.empty()) return evaluate_forces(options);
  if (!options.loads.empty() || !options.bank.empty() || !options.report.empty()) {
    return bad_input("--classes: excludes --loads, --bank and --report, which are of forces");
  }
  recognising::ExampleOptions examples = options.examples;
  examples.model = options.model;
  examples.data.frames = options.frames;
  return evaluate_classes(options.classes, examples, options.json);
}

}  // namespace

void add_evaluate(Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  command.input_file("--model", options->model,
                     "Model file of 'dermis calibrate', or array.toml where readings are forces");
  command.input("--frames", options->frames, "Raw counts: frames.csv, a recording or another file of frames");
  command.input("--loads", options->loads, "loads.csv: the true loads");
  command.input_file("--bank", options->bank, "The paper's bank, of 'dermis calibrate --bank', as one more estimator");
  command.flag("--json", options->json, "Print the result as JSON");
  command.output_folder("--report", options->report, {"index.html"}, "Folder for an HTML report with pictures");
  command.input_file(
      "--classes", options->classes,
      "Judge the classes of 'dermis learn', not forces, on labelled examples: --in, or --frames of tared frames.npy");
  add_example_options(command, options->examples);
  command.option("--rate", options->examples.data.rate_hz,
                 "Frames a second, if they differ from those of the examples [Hz]");
  command.action([options] {
    end_when_interrupted();
    return evaluate(*options);
  });
}

}  // namespace dermis::app
