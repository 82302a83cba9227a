// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <chrono>
#include <memory>
#include <string>

#include "commands.hpp"
#include "dermis/calibration/recalibration.hpp"
#include "dermis/files/kept_copy.hpp"
#include "dermis/pipeline/model.hpp"
#include "interruption.hpp"
#include "labelled_recording.hpp"
#include "writable.hpp"

namespace dermis::app {
namespace {

using calibration::Recalibration;

struct RecalibrateOptions {
  std::string model;
  std::string frames;
  std::string loads;
  std::string out;
};

/// The old model stays beside the new one that takes its name. Its path; empty: the new one has another.
Result<std::string> write(const RecalibrateOptions& options, const pipeline::Model& fresh) {
  std::string kept;
  if (options.out.empty()) {
    Result<std::string> copy = files::keep_copy(options.model, std::chrono::system_clock::now());
    if (!copy) return copy.error();
    kept = *std::move(copy);
  }
  if (Status written = pipeline::write_model(options.out.empty() ? options.model : options.out, fresh); !written) {
    return written.error();
  }
  return kept;
}

Status recalibrate(const RecalibrateOptions& options) {
  if (options.model.ends_with(".toml")) {
    return bad_input(options.model + ": describes an array, and is no model; 'dermis calibrate' makes one");
  }
  if (Status writable = check_writable(options.out.empty() ? options.model : options.out); !writable) return writable;
  const Result<LabelledRecording> recording = LabelledRecording::read(options.model, options.frames, options.loads);
  if (!recording) return recording.error();
  const auto& [model, frames, loads] = *recording;
  const Result<Recalibration> recalibration = calibration::recalibrate(model, frames, loads);
  if (!recalibration) return bad_input(options.loads + ": " + recalibration.error().message);
  const Result<std::string> kept = write(options, recalibration->model);
  if (!kept) return kept.error();
  fmt::print("{}\n", calibration::describe(*recalibration));
  if (!kept->empty()) fmt::print("the model as it was: {}\n", *kept);
  return Done{};
}

}  // namespace

void add_recalibrate(Command& command) {
  auto options = std::make_shared<RecalibrateOptions>();
  command.option("--model", options->model, "Model file of 'dermis calibrate'").required();
  command.option("--frames", options->frames, "Raw counts: frames.csv, a recording or another file of frames")
      .required();
  command.option("--loads", options->loads, "loads.csv: known weights, of which one is enough").required();
  command.option("--out", options->out,
                 "Model file to write; without it, MODEL, and the old one stays as MODEL-before-<UTC time>");
  command.action([options] {
    end_when_interrupted();
    return recalibrate(*options);
  });
}

}  // namespace dermis::app
