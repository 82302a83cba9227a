// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>

#include "commands.hpp"
#include "dermis/bytes/files/output_place.hpp"
#include "dermis/paper/bank_reproduction.hpp"
#include "dermis/paper/paper_report.hpp"
#include "dermis/paper/peaks_reproduction.hpp"
#include "paper_commands.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using paper::HiddenLayerFit;
using paper::PaperReproduction;

struct PaperOptions {
  std::string report;
  bool json = false;
  bool quick = false;
};

/// Enough to see that everything works, not enough for the figures.
constexpr paper::PeaksEffort kQuickPeaks{2, 200, 8, 2, 2, 7, 30};
constexpr paper::BankEffort kQuickBank{10, 20};
constexpr std::size_t kQuickSide = 4;
constexpr std::size_t kPaperSide = 16;

double max_relative_error(const learn::calibration::Evaluation& evaluation, const std::string& estimator) {
  for (const learn::calibration::EstimatorResult& result : evaluation.estimators) {
    if (result.name == estimator) return result.relative_error.max.value_or(NAN);
  }
  return NAN;
}

nlohmann::ordered_json to_json(const std::optional<std::size_t>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const paper::TrainingCurve& curve) {
  return {{"first", curve.value.empty() ? NAN : curve.value.front()},
          {"last", curve.value.empty() ? NAN : curve.value.back()},
          {"steps", curve.step.empty() ? 0.0 : curve.step.back()}};
}

nlohmann::ordered_json peaks_json(const paper::PeaksReproduction& peaks) {
  nlohmann::ordered_json json = {{"goal", peaks.goal}, {"variance", peaks.variance}, {"range", peaks.range}};
  for (const HiddenLayerFit& fit : peaks.by_hidden) {
    json["hidden_" + std::to_string(fit.hidden)] = {
        {"best_mse", fit.best_mse}, {"best_mse_normalised", fit.best_mse_normalised}, {"starts", fit.starts}};
  }
  json["smallest_hidden"] = {{"raw", to_json(peaks.smallest_hidden_raw)},
                             {"normalised", to_json(peaks.smallest_hidden_normalised)}};
  json["adaptive_rate"] = {{"best_mse", peaks.adaptive_rate_best_mse},
                           {"starts", peaks.adaptive_rate_starts},
                           {"epochs", peaks.adaptive_rate_epochs}};
  return json;
}

void print_json(const PaperReproduction& found) {
  nlohmann::ordered_json json = {{"unknowns", found.unknowns}, {"peaks", peaks_json(found.peaks)}};
  for (const paper::TrainingCurve& curve : found.convergence) json["convergence"][curve.name] = to_json(curve);
  json["bank_training"] = to_json(found.bank_training);
  for (const auto& [key, name] : {std::pair{"bank", paper::kPaperBankName}, std::pair{"dermis", "dermis"}}) {
    json["points"][key] = {{"max_relative_error", max_relative_error(found.evaluation, name)}};
  }
  for (const auto& [part, seconds] : found.seconds) json["seconds"][part] = seconds;
  fmt::print("{}\n", json.dump(2));
}

void print_text(const PaperReproduction& found) {
  const paper::PeaksReproduction& peaks = found.peaks;
  const HiddenLayerFit& paper_size = peaks.by_hidden.front();
  fmt::print("Peaks, eq. (1), (2): goal {}\n", peaks.goal);
  fmt::print("  2-5-1, best of {} starts: {:.4g} (targets scaled to [0, 1]: {:.4g})\n", paper_size.starts,
             paper_size.best_mse, paper_size.best_mse_normalised);
  fmt::print("  2-5-1, adaptive rate, {} epochs, best of {} starts: {:.4g}\n", peaks.adaptive_rate_epochs,
             peaks.adaptive_rate_starts, peaks.adaptive_rate_best_mse);
  const auto smallest = [&](const std::optional<std::size_t>& hidden) {
    return hidden ? fmt::format("2-{}-1", *hidden) : fmt::format("none up to 2-{}-1", peaks.by_hidden.back().hidden);
  };
  fmt::print("  smallest network that reaches the goal: {} (targets scaled to [0, 1]: {})\n",
             smallest(peaks.smallest_hidden_raw), smallest(peaks.smallest_hidden_normalised));
  fmt::print("bank of {} networks: {} unknowns\n", found.rows * found.cols, found.unknowns);
  for (const paper::TrainingCurve& curve : found.convergence) {
    fmt::print("  {} steps of gradient descent from {}: error {:.3g} -> {:.3g}\n", curve.step.size(), curve.name,
               curve.value.front(), curve.value.back());
  }
  fmt::print("Fig. 11 to 13, {} points: largest error {:.2f} % (the paper's bank), {:.2f} % (dermis); the paper: 5 %\n",
             found.points.size(), 100.0 * max_relative_error(found.evaluation, paper::kPaperBankName),
             100.0 * max_relative_error(found.evaluation, "dermis"));
}

/// A folder that cannot be written is an error before minutes of work, not after them.
Status check_folder(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failed("cannot make the directory '" + directory + "': " + error.message());
  return bytes::files::claim_output(directory + "/index.html", bytes::files::EarlierFile::may_be_read);
}

Status paper(const PaperOptions& options) {
  if (!options.report.empty()) {
    if (Status writable = check_folder(options.report); !writable) return writable;
  }
  using Clock = std::chrono::steady_clock;
  PaperReproduction found;
  Progress progress;
  auto start = Clock::now();
  const auto note_time = [&](const char* part) {
    found.seconds.emplace_back(part, std::chrono::duration<double>(Clock::now() - start).count());
    start = Clock::now();
  };
  found.peaks = paper::reproduce_peaks(options.quick ? kQuickPeaks : paper::PeaksEffort{},
                                       [&](double share) { progress.show("peaks", share); });
  note_time("Peaks");
  const std::size_t side = options.quick ? kQuickSide : kPaperSide;
  const auto show = [&](const std::string& part, double share) { progress.show(part, share); };
  Status done = paper::reproduce_bank(paper::paper_array(side, side), options.quick ? kQuickBank : paper::BankEffort{},
                                      show, found);
  if (!done) return done;
  note_time("the paper's bank");
  if (!options.report.empty()) {
    if (Status written = paper::write_paper_report(options.report, found); !written) return written;
  }
  options.json ? print_json(found) : print_text(found);
  return Done{};
}

}  // namespace

void add_paper(Command& command) {
  auto options = std::make_shared<PaperOptions>();
  command.output_folder("--report", options->report, {"index.html"}, "Folder for an HTML report with pictures");
  command.flag("--json", options->json, "Print the result as JSON");
  command.flag("--quick", options->quick,
               "A 4x4 array and few steps: it shows that everything works, not what the paper says");
  command.action([options] { return paper(*options); });
  Command calibrate = command.subcommand("calibrate", "Train the paper's bank of N-N-N-1 networks on known loads");
  add_paper_calibrate(calibrate);
  Command evaluate =
      command.subcommand("evaluate", "Measure the bank's accuracy on known loads, beside that of dermis");
  add_paper_evaluate(evaluate);
  Command learn = command.subcommand("learn", "Compare a BP network with dermis on examples of poses or gestures");
  add_paper_learn(learn);
}

}  // namespace dermis::app
