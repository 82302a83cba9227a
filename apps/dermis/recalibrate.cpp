// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/calibration/recalibration.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "interruption.hpp"
#include "kept_model.hpp"
#include "labelled_recording.hpp"

namespace dermis::app {
namespace {

using learn::calibration::Recalibration;

struct RecalibrateOptions {
  std::string model;
  std::string frames;
  std::string loads;
  std::string out;
};

Status recalibrate(const RecalibrateOptions& options) {
  if (options.model.ends_with(".toml")) {
    return bad_input(options.model + ": describes an array, and is no model; 'dermis calibrate' makes one");
  }
  const std::string& out = options.out.empty() ? options.model : options.out;
  if (Status claimed = claim_model(out); !claimed) return claimed;
  const Result<LabelledRecording> recording = LabelledRecording::read(options.model, options.frames, options.loads);
  if (!recording) return recording.error();
  const auto& [model, frames, loads] = *recording;
  const Result<Recalibration> recalibration = learn::calibration::recalibrate(model, frames, loads);
  if (!recalibration) return bad_input(options.loads + ": " + recalibration.error().message);
  if (Status kept = keep_earlier_model(out); !kept) return kept;
  if (Status written = bytes::models::write_model(out, recalibration->model); !written) return written;
  fmt::print("{}\n", learn::calibration::describe(*recalibration));
  return Done{};
}

}  // namespace

void add_recalibrate(Command& command) {
  auto options = std::make_shared<RecalibrateOptions>();
  command.input_file("--model", options->model, "Model file of 'dermis calibrate'").required();
  command.input("--frames", options->frames, "Raw counts: frames.csv, a recording or another file of frames")
      .required();
  command.input("--loads", options->loads, "loads.csv: known weights, of which one is enough").required();
  command.output_model("--out", options->out,
                       "Model file to write; without it, MODEL, and the old one stays as MODEL-before-<UTC time>");
  command.action([options] {
    end_when_interrupted();
    return recalibrate(*options);
  });
}

}  // namespace dermis::app
