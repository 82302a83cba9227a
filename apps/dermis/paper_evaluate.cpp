// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>

#include "dermis/paper/paper_bank_file.hpp"
#include "evaluate_forces.hpp"
#include "interruption.hpp"
#include "paper_commands.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

struct PaperEvaluateOptions {
  ForceEvaluation forces;
  std::string bank;
};

Status evaluate(const PaperEvaluateOptions& options) {
  if (const auto note = bytes::files::checksum_note(options.bank, paper::kPaperBankFormat)) print_notice(*note);
  Result<paper::PaperBank> bank = paper::read_paper_bank(options.bank);
  if (!bank) return bank.error();
  return evaluate_forces(options.forces, &*bank);
}

}  // namespace

void add_paper_evaluate(Command& command) {
  auto options = std::make_shared<PaperEvaluateOptions>();
  add_force_evaluation(command, options->forces);
  command.input_file("--bank", options->bank, "The bank of 'dermis paper calibrate'").required();
  command.action([options] {
    end_when_interrupted();
    return evaluate(*options);
  });
}

}  // namespace dermis::app
