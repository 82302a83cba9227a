// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>

#include "commands.hpp"
#include "evaluate_classes.hpp"
#include "evaluate_forces.hpp"
#include "evaluate_left_out.hpp"
#include "example_options.hpp"
#include "interruption.hpp"

namespace dermis::app {
namespace {

struct EvaluateOptions {
  ForceEvaluation forces;
  LeftOutEvaluation left_out;
  std::string classes;
  recognising::ExampleOptions examples;  // of the classes; their model and frames are those of the forces
};

Status evaluate_without_each(const EvaluateOptions& options) {
  const auto& [forces, left_out, classes, examples] = options;
  if (left_out.leave_out != "press") return bad_input("--leave-out " + left_out.leave_out + ": not known; say press");
  if (!forces.model.empty() || !forces.report.empty()) {
    return bad_input("--leave-out: excludes --model and --report; it calibrates anew");
  }
  if (!classes.empty() || !examples.in.empty() || !examples.data.labels.empty()) {
    return bad_input("--leave-out: excludes --classes, --in and --labels, which are of classes");
  }
  if (left_out.array.empty() || forces.frames.empty() || forces.loads.empty()) {
    return bad_input("--leave-out: needs --array, --frames and --loads");
  }
  return evaluate_left_out(left_out, forces.frames, forces.loads, forces.json);
}

Status evaluate(const EvaluateOptions& options) {
  const ForceEvaluation& forces = options.forces;
  if (!options.left_out.leave_out.empty()) return evaluate_without_each(options);
  if (!options.left_out.array.empty() || options.left_out.tables.is_any()) {
    return bad_input("--array, --out, --totals and --contacts: need --leave-out press");
  }
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
  add_left_out_evaluation(command, options->left_out);
  command.heading("Classes");
  command.input_file("--classes", options->classes,
                     "Judge the classes of 'dermis recognise learn', not forces, on labelled examples: --in, or "
                     "--frames of tared frames.npy");
  add_example_options(command, options->examples);
  command.option("--rate", options->examples.data.rate_hz,
                 "Frames a second, if they differ from those of the examples [Hz]");
  command.action([options] {
    end_when_interrupted();
    return evaluate(*options);
  });
}

}  // namespace dermis::app
