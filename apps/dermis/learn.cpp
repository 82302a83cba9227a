// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "bp_classifier.hpp"
#include "commands.hpp"
#include "confusion_table.hpp"
#include "dermis/files/atomic_file.hpp"
#include "dermis/files/text.hpp"
#include "dermis/recognition/classes_file.hpp"
#include "dermis/recognition/comparison.hpp"
#include "dermis/recognition/dataset.hpp"
#include "dermis/recognition/learning.hpp"
#include "dermis/recognition/recogniser.hpp"
#include "dermis/report/recognition_report.hpp"
#include "labelled_examples.hpp"
#include "status_line.hpp"
#include "writable.hpp"

namespace dermis::app {
namespace {

using recognition::LabelledFrames;
using recognition::Learned;
using recognition::LearningSet;
using recognition::Split;
using Clock = std::chrono::steady_clock;

struct LearnOptions {
  ExampleOptions examples;
  std::string out;
  std::string splits;
  std::string predictions;
  std::string open;
  std::string open_predictions;
  std::string report;
};

Status check_options(const LearnOptions& options) {
  if (options.splits.empty() != options.predictions.empty()) return bad_input("--splits and --predictions go together");
  if (options.open.empty() != options.open_predictions.empty()) {
    return bad_input("--open and --open-predictions go together");
  }
  if (options.out.empty() && options.splits.empty() && options.open.empty()) {
    return bad_input("nothing would be written; name --out, or --splits with --predictions");
  }
  if (!options.report.empty() && options.out.empty()) return bad_input("--report: needs --out");
  for (const std::string& path : {options.out, options.predictions, options.open_predictions}) {
    if (path.empty()) continue;
    if (Status writable = check_writable(path); !writable) return writable;
  }
  return Done{};
}

/// A line for each label that a split asks for.
Status predict(const LabelledFrames& data, const LearningSet& set, const Split& split, bool may_be_unknown,
               std::string& lines) {
  const Result<Learned> learned = set.learn(split.taught);
  if (!learned) return bad_input("split " + files::in_quotes(split.name) + ": " + learned.error().message);
  Result<recognition::Recogniser> recogniser =
      recognition::Recogniser::create(learned->classes, data.layout, data.longest());
  if (!recogniser) return recogniser.error();
  for (const std::size_t place : split.asked) {
    const recognition::Label& label = data.labels[place];
    const recognition::Answer answer = recogniser->recognise(data.segment(label));
    const bool is_unknown = may_be_unknown && answer.verdict != recognition::Verdict::known;
    lines += fmt::format("{},{},{},", split.name, label.id,
                         is_unknown ? "unknown" : learned->classes.names[answer.likeliest]);
    files::append_number(lines, answer.probabilities[answer.likeliest]);
    if (may_be_unknown) {
      lines += ",";
      files::append_number(lines, answer.unknown_score);
    }
    lines += "\n";
  }
  return Done{};
}

Status write_predictions(const std::string& path, const LabelledFrames& data, const LearningSet& set,
                         const std::vector<Split>& splits, bool may_be_unknown, Progress& progress) {
  std::string lines = may_be_unknown ? "split,id,class,probability,unknown_score\n" : "split,id,class,probability\n";
  for (std::size_t i = 0; i < splits.size(); ++i) {
    if (Status predicted = predict(data, set, splits[i], may_be_unknown, lines); !predicted) return predicted;
    progress.show("splits", static_cast<double>(i + 1) / static_cast<double>(splits.size()));
  }
  Result<files::AtomicFile> file = files::AtomicFile::create(path);
  if (!file) return file.error();
  file->write(lines);
  return file->commit();
}

void print_report(const Learned& learned, double seconds) {
  const recognition::LearningReport& report = learned.report;
  const std::int64_t examples =
      std::accumulate(learned.classes.examples.begin(), learned.classes.examples.end(), std::int64_t{0});
  const double rate_hz = learned.classes.layout.rate_hz;
  fmt::print("{} classes, {} examples{}, learned in {:.2f} s\n", learned.classes.names.size(), examples,
             rate_hz > 0.0 ? fmt::format(" at {:.4g} frames a second", rate_hz) : "", seconds);
  fmt::print("cross-validated accuracy {:.1f} % of {} ({} folds {}), calibration error {:.1f} %\n",
             100.0 * report.accuracy, report.judged, report.folds,
             report.by_group ? "of whole recordings, subjects or sessions" : "in order of time",
             100.0 * report.calibration_error);
  print_confusion(learned.classes.names, report.confusion);
  const std::vector<std::string> lines = recognition::advice(learned);
  if (!lines.empty()) fmt::print("\n");
  for (const std::string& line : lines) fmt::print("{}\n", line);
}

/// The page of --report, where it is asked for.
Status write_report(const std::string& folder, const LabelledFrames& data, const LearningSet& set,
                    const Learned& learned, Progress& progress) {
  if (folder.empty()) return Done{};
  const recognition::ComparedEstimator network{"BP network", answer_by_bp_network};
  const auto estimators = recognition::compare_estimators(data, set, learned, std::span(&network, 1),
                                                          [&](double share) { progress.show("comparison", share); });
  if (!estimators) return estimators.error();
  return report::write_recognition_report(folder, data, learned, *estimators);
}

Status write_model(const LearnOptions& options, const LabelledFrames& data, const LearningSet& set,
                   Clock::time_point start, Progress& progress) {
  std::vector<std::size_t> all(data.labels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Result<Learned> learned = set.learn(all);
  if (!learned) return learned.error();
  learned->classes.touches = recognition::learn_touches(data);
  if (Status written = recognition::write_classes(options.out, learned->classes); !written) return written;
  print_report(*learned, std::chrono::duration<double>(Clock::now() - start).count());
  if (const auto& touches = learned->classes.touches) {
    const recognition::FindingReport finding = recognition::judge_touches(data, *touches);
    fmt::print("in the stream {} of {} touches are found, and {} where no label is\n", finding.found, finding.labelled,
               finding.others);
  } else if (learned->classes.moving) {
    fmt::print(
        "where touches begin and end cannot be learned: 'dermis recognise' needs labels that leave a tenth of the "
        "frames without a touch, or labels of one frame each\n");
  }
  return write_report(options.report, data, set, *learned, progress);
}

Status learn(const LearnOptions& options) {
  if (Status checked = check_options(options); !checked) return checked;
  const Result<LabelledFrames> data = read_examples(options.examples);
  if (!data) return data.error();
  std::vector<Split> splits;
  std::vector<Split> open_splits;
  if (!options.splits.empty()) {
    Result<std::vector<Split>> read = recognition::read_splits(options.splits, data->labels);
    if (!read) return read.error();
    splits = *std::move(read);
  }
  if (!options.open.empty()) {
    Result<std::vector<Split>> read = recognition::read_open_splits(options.open, data->labels);
    if (!read) return read.error();
    open_splits = *std::move(read);
  }
  Progress progress;
  const auto start = Clock::now();
  const Result<LearningSet> set = LearningSet::create(*data, [&](double share) { progress.show("features", share); });
  if (!set) return set.error();
  const auto features_took = Clock::now() - start;
  if (!splits.empty()) {
    Status written = write_predictions(options.predictions, *data, *set, splits, false, progress);
    if (!written) return written;
  }
  if (!open_splits.empty()) {
    Status written = write_predictions(options.open_predictions, *data, *set, open_splits, true, progress);
    if (!written) return written;
  }
  if (options.out.empty()) return Done{};
  return write_model(options, *data, *set, Clock::now() - features_took, progress);
}

}  // namespace

void add_learn(Command& command) {
  auto options = std::make_shared<LearnOptions>();
  recognition::DatasetFiles& data = options->examples.data;
  command.option("--in", options->examples.in, "Recordings, or other files of frames, whose frames the labels count");
  command.option("--model", options->examples.model, "Learn from the forces [N] of --in by this model of its array");
  command.flag("--tare", options->examples.tare, "Nothing touches in the first second of each --in: that is zero load");
  command.option("--frames", data.frames, "frames.npy: tared frames, the readings of all arrays side by side");
  command.option("--arrays", data.arrays, "arrays.csv: where the readings of each array of --frames are");
  command.option("--extra", data.extras, "extra.npy: further readings beside each of --frames, such as joint angles");
  command.option("--labels", data.labels, "labels.csv: which frames are an example of which class").required();
  command.option("--label", data.label, "Column of labels.csv that names the class").shows_default();
  command.option("--rate", data.rate_hz,
                 "Frames a second [Hz]; of --in, by default, as the times of its frames have it");
  command.option("--out", options->out, "Classes to write (safetensors)");
  command.option("--splits", options->splits, "splits.csv: learn once for each split from all that it does not name");
  command.option("--predictions", options->predictions, "What is answered for the labels that --splits names");
  command.option("--open", options->open, "open.csv: splits with classes that are not learned");
  command.option("--open-predictions", options->open_predictions, "What is answered for the labels of --open");
  command.option("--report", options->report,
                 "Folder for an HTML report with pictures, which compares with other estimators");
  command.action([options] { return learn(*options); });
}

}  // namespace dermis::app
