// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration_input.hpp"

#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "kept_model.hpp"
#include "labelled_recording.hpp"
#include "seconds.hpp"
#include "source_options.hpp"

namespace dermis::app {

void CalibrationFiles::add(Command& command) {
  command.input_file("--array", array, "array.toml: size, pitch and readout circuit").required();
  command.input_file("--frames", frames, "Raw counts: frames.csv, a recording or another file of frames").required();
  command.input_file("--loads", loads, "loads.csv: which load pressed where in which frame").required();
  command.option("--settle", settle_s, "Skip the first seconds, while the array warms up [s]").shows_default();
}

Result<CalibrationInput> CalibrationInput::read(const CalibrationFiles& files, const std::string& out) {
  const Result<Nanos> settle = nanos_from_seconds(files.settle_s, "--settle");
  if (!settle) return settle.error();
  Result<ArrayDescription> array = bytes::files::read_array(files.array);
  if (!array) return array.error();
  if (Status claimed = out.empty() ? Done{} : claim_model(out); !claimed) return claimed.error();
  Result<std::vector<RawFrame>> frames = live::sources::read_frames(files.frames, source_options(&*array));
  if (!frames) return frames.error();
  Result<std::vector<Load>> loads = read_told_loads(files.loads, *array, frames->size());
  if (!loads) return loads.error();
  return CalibrationInput{*std::move(array), *settle, *std::move(frames), *std::move(loads)};
}

}  // namespace dermis::app
