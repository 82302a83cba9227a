// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "calibration_input.hpp"
#include "dermis/paper/bank_training.hpp"
#include "dermis/paper/paper_bank_file.hpp"
#include "interruption.hpp"
#include "kept_model.hpp"
#include "paper_commands.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using learn::calibration::SampleDatabase;
using paper::BankTrainingReport;
using paper::Ranks;

struct PaperCalibrateOptions {
  CalibrationFiles files;
  std::string bank;
  paper::BankTrainingOptions training;
  bool json = false;
};

void print_text(const BankTrainingReport& report, const ArrayDescription& array) {
  fmt::print("the paper's bank: {} unknowns, error {:.2g} after {} steps\n", report.unknowns, report.curve.back(),
             report.steps);
  if (report.resumed_at > 0) fmt::print("the training went on from step {} of its checkpoint\n", report.resumed_at);
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
                                       {"resumed_at", report.resumed_at},
                                       {"last_error", report.curve.back()},
                                       {"never_loaded", names_of(report.never_loaded)},
                                       {"constant_readings", names_of(report.constant_readings)}};
  fmt::print("{}\n", json.dump(2));
}

/// On rank 0, which alone reads; the others get the samples of it.
Result<SampleDatabase> read_samples(const PaperCalibrateOptions& options) {
  if (Status valid = options.training.validate(); !valid) return valid.error();
  const std::string& checkpoint = options.training.checkpoint;
  if (Status claimed = checkpoint.empty() ? Done{} : claim_model(checkpoint); !claimed) return claimed.error();
  const Result<CalibrationInput> input = CalibrationInput::read(options.files, options.bank);
  if (!input) return input.error();
  Progress progress(input->array.name);
  return learn::calibration::build_sample_database(input->array, input->frames, input->loads, input->settle,
                                                   [&](double share) { progress.show("circuit", share); });
}

/// The most memory that this process has had [bytes].
std::size_t peak_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

void say_memory(const PaperCalibrateOptions& options, const SampleDatabase& database, Ranks& ranks) {
  std::vector<std::size_t> bytes(ranks.count());
  bytes[ranks.rank()] = peak_bytes() + paper::bank_training_bytes(database, options.training.batch, ranks);
  paper::gather(ranks, std::span(bytes));
  if (ranks.rank() > 0) return;
  constexpr std::size_t kMegabyte = 1'000'000;
  print_notice(fmt::format("each of {} ranks takes at most {} MB of memory", ranks.count(),
                           *std::max_element(bytes.begin(), bytes.end()) / kMegabyte + 1));
}

Status calibrate(const PaperCalibrateOptions& options, Ranks& ranks) {
  const bool is_first = ranks.rank() == 0;
  Result<SampleDatabase> database = is_first ? read_samples(options) : SampleDatabase{};
  if (Status read = paper::agreed(ranks, database ? Status(Done{}) : database.error()); !read) return read;
  paper::broadcast_samples(*database, ranks);
  if (ranks.count() > 1) say_memory(options, *database, ranks);
  Progress progress(database->array.name);
  paper::BankTrainingOptions training = options.training;
  if (is_first) training.progress = [&](double share) { progress.show("bank", share); };
  const Result<paper::TrainedBank> trained = paper::train_paper_bank(*database, training, ranks);
  if (!trained) return trained.error();
  const Status kept = is_first ? keep_earlier_model(options.bank) : Done{};
  if (Status all = paper::agreed(ranks, kept); !all) return all;
  if (Status written = paper::write_paper_bank(options.bank, trained->bank, ranks); !written) return written;
  if (!is_first) return Done{};
  if (!training.checkpoint.empty()) std::remove(training.checkpoint.c_str());
  options.json ? print_json(trained->report, database->array) : print_text(trained->report, database->array);
  return Done{};
}

/// An error is that of all ranks, and the first says it.
Status calibrate_on_ranks(const PaperCalibrateOptions& options) {
  const Result<std::unique_ptr<Ranks>> ranks = paper::open_ranks();
  if (!ranks) return ranks.error();
  const bool is_first = (*ranks)->rank() == 0;
  if (!options.training.checkpoint.empty()) say_when_interrupted("interrupted; the last checkpoint stands");
  if (!is_first) say_when_interrupted("");
  Status done = calibrate(options, **ranks);
  return is_first ? done : Done{};
}

}  // namespace

void add_paper_calibrate(Command& command) {
  auto options = std::make_shared<PaperCalibrateOptions>();
  options->files.add(command);
  command.output_model("--bank", options->bank, "Bank to write (safetensors; 16x16: minutes, 135 MB)").required();
  command.option("--steps", options->training.steps, "Steps of the training; with fewer, it is less exact")
      .shows_default();
  command.option("--batch", options->training.batch, "Samples that each network draws for a step").shows_default();
  command.output_model("--checkpoint", options->training.checkpoint,
                       "File from which the same command goes on if it was ended; removed when the bank is there");
  command.option("--interval", options->training.interval, "Steps from one checkpoint to the next").shows_default();
  command.flag("--json", options->json, "Print the report as JSON");
  command.action([options] {
    end_when_interrupted();
    return calibrate_on_ranks(*options);
  });
}

}  // namespace dermis::app
