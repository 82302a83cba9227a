// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>

#include "commands.hpp"
#include "evaluate_classes.hpp"
#include "evaluate_forces.hpp"
#include "example_options.hpp"
#include "interruption.hpp"

namespace dermis::app {
namespace {

struct EvaluateOptions {
  ForceEvaluation forces;
  std::string classes;
  recognising::ExampleOptions examples;  // of the classes; their model and frames are those of the forces
};

Status evaluate(const EvaluateOptions& options) {
  const ForceEvaluation& forces = options.forces;
  if (options.classes.empty()) {
    if (!options.examples.data.labels.empty()) return bad_input("--labels: needs --classes");
    return evaluate_forces(forces, nullptr);
  }
  if (!forces.loads.empty() || !forces.report.empty()) {
    return bad_input("--classes: excludes --loads and --report, which are of forces");
  }
  recognising::ExampleOptions examples = options.examples;
  examples.model = forces.model;
  examples.data.frames = forces.frames;
  return evaluate_classes(options.classes, examples, forces.json);
}

}  // namespace

void add_evaluate(Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  add_force_evaluation(command, options->forces);
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
