// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "example_options.hpp"

namespace dermis::app {

Option add_example_options(Command& command, recognising::ExampleOptions& examples) {
  learn::recognition::DatasetFiles& data = examples.data;
  command.input("--in", examples.in, "Recordings, or other files of frames, whose frames the labels count");
  command.flag("--tare", examples.tare, "Take the first second of each --in as zero load: nothing may touch then");
  command.flag("--tare-force", examples.tare_force, "The same, whatever load stands on the array");
  command.input("--arrays", data.arrays, "arrays.csv: where the readings of each array of --frames are");
  command.input("--extra", data.extras,
                "Further readings, such as joint angles: extra.npy beside --frames, CSV with time_s beside --in");
  command.option("--label", data.label, "Column of labels.csv that names the class").shows_default();
  return command.input("--labels", data.labels, "labels.csv: which frames are an example of which class");
}

void add_taught_examples(Command& command, recognising::ExampleOptions& examples) {
  add_example_options(command, examples).required();
  command.input_file("--model", examples.model,
                     "Learn from the forces [N] of --in by this model of its array, or suit.toml of several");
  command.input("--frames", examples.data.frames, "frames.npy: tared frames, the readings of all arrays side by side");
  command.option("--rate", examples.data.rate_hz,
                 "Frames a second [Hz]; default with --in: by the times of its frames");
}

}  // namespace dermis::app
