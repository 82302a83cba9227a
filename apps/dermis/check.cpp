// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "dermis/bytes/files/force_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/learn/health/weight_check.hpp"
#include "dermis/live/forces/operation.hpp"
#include "process_all.hpp"
#include "source_options.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using learn::health::WeightFinding;
using live::forces::Operation;

constexpr int kExitAged = 3;

struct CheckOptions {
  std::string model;
  std::string in;
  std::string weight;
};

/// The zero follows idle taxels, as it does in use.
Result<WeightFinding> weigh(Operation& operation, double weight_n) {
  operation.pipeline.drift().set_options({.track = true});
  learn::health::WeightCheck check(operation.model, weight_n);
  const Status done = process_all(operation, [&](const RawFrame& /*raw*/, const ForceFrame& force) {
    check.add(force, operation.pipeline.conditioned().ratio);
  });
  if (!done) return done.error();
  return check.finding();
}

Result<int> check(const CheckOptions& options) {
  const Result<double> weight_n = bytes::files::parse_force(options.weight);
  if (!weight_n) return bad_input("--weight: " + weight_n.error().message);
  if (!(*weight_n > 0.0 && *weight_n <= 1e6)) return bad_input("--weight: must be above 0 and at most 1e6 N");
  if (double newtons = 0.0; !bytes::files::parse_number(options.weight, newtons)) {
    print_notice(fmt::format("--weight: {}, taken for {:.4g} N", options.weight, *weight_n));
  }
  const Result<std::unique_ptr<Operation>> operation =
      live::forces::open_operation(options.model, options.in, source_options());
  if (!operation) return operation.error();
  const Result<WeightFinding> finding = weigh(**operation, *weight_n);
  if (!finding) return finding.error();
  if (finding->presses.empty()) return failed(options.in + ": " + learn::health::describe(*finding));
  fmt::print("{}", learn::health::describe(*finding));
  return finding->has_aged() || finding->has_lost_cover() || finding->has_changed_film() ? kExitAged : 0;
}

}  // namespace

void add_check(Command& command) {
  auto options = std::make_shared<CheckOptions>();
  command
      .input_file("--model", options->model,
                  "Model file of 'dermis calibrate', or array.toml where readings are forces")
      .required();
  command.input("--in", options->in, "Raw counts while the object is put on: frames.csv, a recording or a device")
      .required();
  command.option("--weight", options->weight, "What the object presses with: newtons, or its mass as in '200 g'")
      .required();
  command.action_with_exit_status([options] { return check(*options); });
}

}  // namespace dermis::app
