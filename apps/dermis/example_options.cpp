// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "example_options.hpp"

namespace dermis::app {

Option add_example_options(Command& command, recognising::ExampleOptions& examples) {
  recognition::DatasetFiles& data = examples.data;
  command.input("--in", examples.in, "Recordings, or other files of frames, whose frames the labels count");
  command.flag("--tare", examples.tare, "Take the first second of each --in as zero load: nothing may touch then");
  command.flag("--tare-force", examples.tare_force, "The same, whatever load stands on the array");
  command.input("--arrays", data.arrays, "arrays.csv: where the readings of each array of --frames are");
  command.input("--extra", data.extras,
                "Further readings, such as joint angles: extra.npy beside --frames, CSV with time_s beside --in");
  command.option("--label", data.label, "Column of labels.csv that names the class").shows_default();
  return command.input("--labels", data.labels, "labels.csv: which frames are an example of which class");
}

}  // namespace dermis::app
