// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "calibration_input.hpp"
#include "dermis/paper/bank_training.hpp"
#include "dermis/paper/paper_bank_file.hpp"
#include "interruption.hpp"
#include "kept_model.hpp"
#include "paper_commands.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using paper::BankTrainingReport;

constexpr std::uint64_t kSeed = 1;

struct PaperCalibrateOptions {
  CalibrationFiles files;
  std::string bank;
  bool json = false;
};

void print_text(const BankTrainingReport& report, const ArrayDescription& array) {
  fmt::print("the paper's bank: {} unknowns, error {:.2g} after {} steps\n", report.unknowns, report.curve.back(),
             report.steps);
  for (const std::size_t taxel : report.never_loaded) {
    fmt::print("taxel {} is never loaded: the bank knows no force on it\n", array.taxel_name(taxel));
  }
  for (const std::size_t taxel : report.constant_readings) {
    fmt::print("taxel {} always reads the same: the bank learns nothing from it\n", array.taxel_name(taxel));
  }
}

void print_json(const BankTrainingReport& report, const ArrayDescription& array) {
  const auto names_of = [&](const std::vector<std::size_t>& taxels) {
    auto names = nlohmann::ordered_json::array();
    for (const std::size_t taxel : taxels) names.push_back(array.taxel_name(taxel));
    return names;
  };
  const nlohmann::ordered_json json = {{"unknowns", report.unknowns},
                                       {"steps", report.steps},
                                       {"last_error", report.curve.back()},
                                       {"never_loaded", names_of(report.never_loaded)},
                                       {"constant_readings", names_of(report.constant_readings)}};
  fmt::print("{}\n", json.dump(2));
}

Status calibrate(const PaperCalibrateOptions& options) {
  const Result<CalibrationInput> input = CalibrationInput::read(options.files, options.bank);
  if (!input) return input.error();
  const auto& [array, settle, frames, loads] = *input;
  Progress progress(array.name);
  const auto database = calibration::build_sample_database(array, frames, loads, settle,
                                                           [&](double share) { progress.show("circuit", share); });
  if (!database) return database.error();
  const Result<paper::TrainedBank> trained =
      paper::train_paper_bank(*database, paper::kBankSteps, kSeed, [&](double share) { progress.show("bank", share); });
  if (!trained) return trained.error();
  if (Status kept = keep_earlier_model(options.bank); !kept) return kept;
  if (Status written = paper::write_paper_bank(options.bank, trained->bank); !written) return written;
  options.json ? print_json(trained->report, array) : print_text(trained->report, array);
  return Done{};
}

}  // namespace

void add_paper_calibrate(Command& command) {
  auto options = std::make_shared<PaperCalibrateOptions>();
  options->files.add(command);
  command.output_model("--bank", options->bank, "Bank to write (safetensors; 16x16: minutes, 135 MB)").required();
  command.flag("--json", options->json, "Print the report as JSON");
  command.action([options] {
    end_when_interrupted();
    return calibrate(*options);
  });
}

}  // namespace dermis::app
