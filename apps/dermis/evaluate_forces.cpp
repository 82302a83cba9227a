// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "evaluate_forces.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "dermis/out/report/evaluation_report.hpp"
#include "dermis/out/report/wording.hpp"
#include "labelled_recording.hpp"
#include "report_origin.hpp"

namespace dermis::app {
namespace {

using learn::calibration::Evaluation;

std::string percent(const std::optional<double>& share) {
  if (!share) return "-";
  return std::isfinite(*share) ? fmt::format("{:.2f} %", 100.0 * *share) : "no force";
}

std::string newtons(const std::optional<double>& value) {
  if (!value) return "-";
  return std::isfinite(*value) ? fmt::format("{:.3f} N", *value) : "no force";
}

void print_sums(const learn::calibration::SumErrors& sums) {
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
  for (const learn::calibration::EstimatorResult& result : evaluation.estimators) {
    fmt::print("{:<20}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", out::report::estimator_words(result.name),
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
  const learn::calibration::BoundComparison& bound = evaluation.bound;
  if (bound.frames > 0) {
    fmt::print("Cramer-Rao bound of the ADC noise: {:.2f} % of the force (median of {} taxels); dermis {:.2f} %\n",
               100.0 * bound.median_bound, bound.taxels, 100.0 * bound.median_deviation);
  }
}

Status check_needed(const ForceEvaluation& evaluation) {
  if (evaluation.model.empty()) return bad_input("--model is required");
  if (evaluation.frames.empty()) return bad_input("--frames is required");
  if (evaluation.loads.empty()) return bad_input("--loads is required");
  return Done{};
}

}  // namespace

void add_force_evaluation(Command& command, ForceEvaluation& evaluation) {
  command.input_file("--model", evaluation.model,
                     "Model file of 'dermis calibrate', or array.toml where readings are forces");
  command.input("--frames", evaluation.frames, "Raw counts: frames.csv, a recording or another file of frames");
  command.input("--loads", evaluation.loads, "loads.csv: the true loads");
  command.flag("--json", evaluation.json, "Print the result as JSON");
  command.output_folder("--report", evaluation.report, {"index.html"}, "Folder for an HTML report with pictures");
}

Status evaluate_forces(const ForceEvaluation& options, learn::calibration::FurtherEstimator* further) {
  if (Status checked = check_needed(options); !checked) return checked;
  const Result<LabelledRecording> recording = LabelledRecording::read(options.model, options.frames, options.loads);
  if (!recording) return recording.error();
  const auto& [model, frames, loads] = *recording;
  const Result<Evaluation> evaluation = learn::calibration::evaluate(model, frames, loads, further);
  if (!evaluation) return evaluation.error();
  if (!options.report.empty()) {
    const out::report::Origin origin = report_origin({options.frames, options.loads, options.model}, frames);
    Status written = out::report::write_evaluation_report(options.report, *evaluation, model, origin);
    if (!written) return written;
  }
  options.json ? fmt::print("{}\n", learn::calibration::to_json(*evaluation)) : print_text(*evaluation);
  if (evaluation->most_have_forces) return Done{};
  return failed(options.frames + ": " + evaluation->most_have_forces.error().message);
}

}  // namespace dermis::app
