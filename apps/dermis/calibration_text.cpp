// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration_text.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace dermis::app {
namespace {

using learn::calibration::CalibrationReport;
using learn::calibration::TrainingReport;

constexpr double kPoorFit = 0.1;       // relative error
constexpr std::size_t kMostNamed = 5;  // taxels
// Single presses hide what is wrong with circuit and ADC: each law takes it in.
constexpr const char* kProofPresses =
    "fewer than eight presses on two to six taxels: whether circuit and ADC are as described is not told";
constexpr const char* kMoreProof =
    "to be sure, add twenty presses of a known weight over two to four taxels of a row, and calibrate again";

bool is_poor(const TrainingReport& training) {
  return std::max(training.median_fit_error, training.shared_leave_one_out_error) > kPoorFit;
}

std::string ranges_of(const TrainingReport& training) {
  std::string text = fmt::format("loads {:.3g} to {:.3g} N", training.lightest_newtons, training.heaviest_newtons);
  if (training.uses_temperature) {
    text += fmt::format(", {:.1f} to {:.1f} C", training.lowest_celsius, training.highest_celsius);
  }
  return text;
}

std::string laws_of(const TrainingReport& training) {
  if (training.is_one_load) return "a straight line through the one load";
  if (training.shared_networks == 0)
    return fmt::format("a law of its own for each of {} taxels", training.own_networks);
  if (training.own_networks == 0) return fmt::format("one law for {} taxels", training.shared_networks);
  return fmt::format("a law of its own for {} taxels, one for the other {}", training.own_networks,
                     training.shared_networks);
}

std::string fitted(const CalibrationText& text) {
  const CalibrationReport& report = text.calibration.report;
  std::string line = fmt::format("{}, from {} labelled frames: {}", laws_of(report.training), report.frames,
                                 ranges_of(report.training));
  const Readout& readout = text.calibration.model.array.readout;
  if (!report.circuit.empty() && readout.circuit != Circuit::none) {
    line += fmt::format("; circuit: {}", to_string(readout.circuit));
    if (readout.circuit == Circuit::divider) line += fmt::format(", idle rows {}", to_string(readout.idle_rows));
  }
  if (const auto& strip = text.calibration.model.strip) {
    line += fmt::format("; positions along the strip \u00b1 {:.2f} mm, from {} touches", 1e3 * strip->sigma_m,
                        text.touches);
  }
  return line;
}

std::string unseen(const CalibrationReport& report) {
  if (report.training.is_one_load || !report.unseen) {
    return "not told: it takes loads of different weights, several of them on the same taxels";
  }
  std::string line = fmt::format("half of them within {:.2g} %, 19 of 20 within {:.2g} %",
                                 100.0 * report.unseen->median, 100.0 * report.unseen->p95);
  const auto& unpressed = report.uncertainty.relative_sigma_of_unpressed;
  if (unpressed) {
    line += fmt::format("; \u00b1 {:.0f} % on the {} taxels that were not pressed",
                        100.0 * *std::min_element(unpressed->begin(), unpressed->end()),
                        report.uncertainty.unpressed_taxels);
  }
  return line;
}

std::string dead_taxels(const TrainingReport& training, const ArrayDescription& array) {
  std::string names;
  for (const std::size_t taxel : training.dead_taxels) {
    if (&taxel - training.dead_taxels.data() == kMostNamed) return names + " ...";
    names += (names.empty() ? "" : ", ") + array.taxel_name(taxel);
  }
  return names;
}

std::vector<std::string> doubts_of(const CalibrationReport& report, const ArrayDescription& array) {
  std::vector<std::string> doubts;
  if (is_poor(report.training)) doubts.emplace_back("a poor fit");
  doubts.insert(doubts.end(), report.doubts.begin(), report.doubts.end());
  if (!report.discriminating_presses.empty()) doubts.emplace_back("the circuit: these frames fit several");
  if (!report.driver_presses.empty())
    doubts.emplace_back("the resistance of the drivers, which these frames leave uncertain");
  if (!report.circuit.empty() && array.readout.circuit == Circuit::none) {
    doubts.emplace_back("the circuit: none explains the frames, so crosstalk stays in the forces");
  }
  if (!report.training.dead_taxels.empty()) {
    doubts.push_back("dead, as they do not answer to their loads: " + dead_taxels(report.training, array));
  }
  if (report.frames_rejected > 0) {
    doubts.push_back(fmt::format("{} frames were rejected ({})", report.frames_rejected, report.first_rejection));
  }
  doubts.insert(doubts.end(), report.remarks.begin(), report.remarks.end());
  if (report.lacks_proof && report.doubts.empty()) doubts.emplace_back(kProofPresses);
  return doubts;
}

/// A line each: who has several doubts wants to read them all.
std::string doubted(const std::vector<std::string>& doubts) {
  return doubts.empty() ? "nothing" : fmt::format("{}", fmt::join(doubts, "\n          "));
}

std::string next(const CalibrationText& text) {
  const CalibrationReport& report = text.calibration.report;
  const ArrayDescription& array = text.calibration.model.array;
  if (is_poor(report.training))
    return "see whether frames and loads belong together, and circuit and polarity are right";
  const auto& pairs = report.discriminating_presses.empty() ? report.driver_presses : report.discriminating_presses;
  if (!pairs.empty()) return describe(pairs, array) + ", add these frames, and calibrate again";
  if (!report.training.dead_taxels.empty()) return "look at the lines of the dead taxels";
  if (2 * report.uncertainty.unpressed_taxels >= array.taxel_count()) {
    return "press the other taxels, too, or all at once by an air bladder with five loads, and calibrate again";
  }
  if (report.lacks_proof && report.doubts.empty()) return kMoreProof;
  return fmt::format("judge it on a second recording: dermis evaluate --model {} --frames TEST --loads TEST_LOADS",
                     text.model_file);
}

}  // namespace

void CalibrationText::print_summary() const {
  const CalibrationReport& report = calibration.report;
  fmt::print("fitted    {}\n", fitted(*this));
  fmt::print("unseen    loads left out of the fit: {}\n", unseen(report));
  fmt::print("doubted   {}\n", doubted(doubts_of(report, calibration.model.array)));
  fmt::print("next      {}\n", next(*this));
  fmt::print("model     {}\n", model_file);
}

void CalibrationText::print_details() const {
  const CalibrationReport& report = calibration.report;
  const TrainingReport& training = report.training;
  const ArrayDescription& array = calibration.model.array;
  fmt::print("\n{} labelled frames, {} rejected{}\n", report.frames, report.frames_rejected,
             report.frames_rejected > 0 ? " (" + report.first_rejection + ")" : "");
  for (const auto* sentences : {&report.remarks, &report.doubts, &report.circuit}) {
    for (const std::string& sentence : *sentences) fmt::print("{}\n", sentence);
  }
  fmt::print("{}\n", training.choice);
  if (!report.memory.empty()) fmt::print("{}\n", report.memory);
  fmt::print("{}\n", ranges_of(training));
  fmt::print("fit: {}\n", learn::calibration::describe_fit(training, array));
  fmt::print("1-sigma: {}\n", learn::calibration::describe(report.uncertainty, array));
  for (const std::size_t taxel : training.dead_taxels) {
    fmt::print("dead taxel {}: it does not answer to its loads\n", array.taxel_name(taxel));
  }
  fmt::print("time:");
  for (const auto& stage : report.stages) fmt::print(" {} {:.2f} s", stage.stage, stage.seconds);
  fmt::print("\n");
}

}  // namespace dermis::app
