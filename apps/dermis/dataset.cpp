// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/out/datasets/dataset_files.hpp"
#include "dermis/out/datasets/episodes.hpp"
#include "dermis/out/datasets/summary.hpp"
#include "lost_input.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

struct DatasetCommandOptions {
  std::vector<std::string> recordings;
  std::string out;
  std::string format = "lerobot";
  std::uint64_t window = 1;
  std::string task = "touch";
  out::datasets::EpisodeOptions episodes{};
};

void print_tally(const out::datasets::EpisodeTally& tally, const DatasetCommandOptions& options) {
  print_notice(fmt::format("{} episode{}, {} steps in {}", tally.episodes, tally.episodes == 1 ? "" : "s", tally.steps,
                           options.out));
  for (const std::string& line : out::datasets::summary_lines(tally)) print_notice(line);
  for (const out::datasets::ArrayTally& array : tally.arrays) {
    if (array.missed == 0) continue;
    const bool is_short = array.most_fresh > options.window;
    const std::string mend = is_short ? fmt::format("; --window {} holds all between two steps", array.most_fresh) : "";
    print_notice(fmt::format("{}: {} of {} frames are in no window{}", array.name, array.missed, array.frames, mend));
  }
  print_notice(fmt::format("look at {}/summary.html before you train", options.out));
}

Status make_dataset(DatasetCommandOptions& options) {
  const Result<out::datasets::DatasetFormat> format = out::datasets::dataset_format(options.format);
  if (!format) return format.error();
  options.episodes.window = options.window;
  options.episodes.stop = &stop_flag();
  options.episodes.notice = print_notice;
  options.episodes.loss = note_loss;
  if (Status valid = options.episodes.validate(); !valid) return valid;
  const auto sink = out::datasets::create_dataset(
      options.out, {.format = *format, .fps = options.episodes.fps, .task = options.task});
  if (!sink) return sink.error();
  const Result<out::datasets::EpisodeTally> tally =
      out::datasets::make_episodes(options.recordings, options.episodes, **sink);
  if (!tally) return tally.error();
  print_tally(*tally, options);
  return Done{};
}

}  // namespace

void add_dataset(Command& command) {
  auto options = std::make_shared<DatasetCommandOptions>();
  command.input("recordings", options->recordings, "Recordings, or other files of frames; each is an episode")
      .required();
  command.option("--out", options->out, "Folder to write, which must not exist yet").required();
  command.option("--format", options->format, "Layout: LeRobot v3, HDF5 of ACT or of robomimic, zarr replay buffer")
      .one_of(out::datasets::dataset_formats())
      .shows_default();
  command.input_file(
      "--model", options->episodes.model,
      "Model file of the array, or suit.toml of several; without it, the models that the recordings hold");
  command.flag("--tare", options->episodes.tare,
               "Take the first second of each recording (at least 10 frames) as unloaded, like 'dermis run'; refused "
               "under a load");
  command.flag("--tare-force", options->episodes.tare_force, "The same, whatever load stands there");
  command.flag("--follow-drift", options->episodes.follow_drift,
               "Follow the offsets of idle taxels, like 'dermis run'");
  command.flag("--cut", options->episodes.cut,
               "Each span of a label (marks of the recordings) is an episode; what has no label is left out");
  command.option("--hold-out", options->episodes.hold_out,
                 "Not to be trained on: a share of the episodes such as 0.2, the last ones, or recordings by name");
  command.input("--state", options->episodes.states,
                "The state of the robot: a topic of its joints, or a CSV with time_s for each recording");
  command.input("--action", options->episodes.actions, "The same of the actions of the robot");
  command.option("--fps", options->episodes.fps, "Steps a second [Hz]").shows_default();
  command.option("--window", options->window, "Each step has this many of the last frames").shows_default();
  command.option("--columns", options->episodes.quantities,
                 "Only these: forces, sigma, valid, raw, age, fresh, contacts, temperature, supply");
  command.flag("--flat", options->episodes.flat, "Every column has one dimension");
  command.option("--task", options->task, "Sentence that says what is done in steps without a label (LeRobot)")
      .shows_default();
  command.action([options] { return make_dataset(*options); });
}

}  // namespace dermis::app
