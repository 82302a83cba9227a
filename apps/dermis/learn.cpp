// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "commands.hpp"
#include "confusion_table.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/learn/recognition/comparison.hpp"
#include "dermis/learn/recognition/dataset.hpp"
#include "dermis/learn/recognition/learning.hpp"
#include "dermis/learn/recognition/predictions.hpp"
#include "dermis/out/report/recognition_report.hpp"
#include "example_options.hpp"
#include "interruption.hpp"
#include "kept_model.hpp"
#include "source_options.hpp"
#include "status_line.hpp"
#include "touch_finding.hpp"

namespace dermis::app {
namespace {

using learn::recognition::Answers;
using learn::recognition::LabelledFrames;
using learn::recognition::Learned;
using learn::recognition::LearningSet;
using learn::recognition::Split;
using Clock = std::chrono::steady_clock;

struct LearnOptions {
  recognising::ExampleOptions examples;
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
  return options.out.empty() ? Done{} : claim_model(options.out);
}

Status write_predictions(const std::string& path, const LabelledFrames& data, const LearningSet& set,
                         const std::vector<Split>& splits, Answers answers, Progress& progress) {
  const auto show = [&](double share) { progress.show("splits", share); };
  const Result<std::string> lines = learn::recognition::predictions_of(data, set, splits, answers, show);
  if (!lines) return lines.error();
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path);
  if (!file) return file.error();
  file->write(*lines);
  return file->commit();
}

void print_report(const Learned& learned, double seconds) {
  const learn::recognition::LearningReport& report = learned.report;
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
  const std::vector<std::string> lines = learn::recognition::advice(learned);
  if (!lines.empty()) fmt::print("\n");
  for (const std::string& line : lines) fmt::print("{}\n", line);
}

/// The page of --report, where it is asked for.
Status write_report(const std::string& folder, const LabelledFrames& data, const LearningSet& set,
                    const Learned& learned, Progress& progress) {
  if (folder.empty()) return Done{};
  const auto estimators = learn::recognition::compare_estimators(
      data, set, learned, {}, [&](double share) { progress.show("comparison", share); });
  if (!estimators) return estimators.error();
  return out::report::write_recognition_report(folder, data, learned, *estimators);
}

Status write_model(const LearnOptions& options, const LabelledFrames& data, const LearningSet& set,
                   Clock::time_point start, Progress& progress) {
  std::vector<std::size_t> all(data.labels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Result<Learned> learned = set.learn(all);
  if (!learned) return learned.error();
  learned->classes.touches = learn::recognition::learn_touches(data);
  if (Status kept = keep_earlier_model(options.out); !kept) return kept;
  if (Status written = learn::recognition::write_classes(options.out, learned->classes); !written) return written;
  print_report(*learned, std::chrono::duration<double>(Clock::now() - start).count());
  if (const auto& touches = learned->classes.touches) {
    print_finding(data, *touches);
  } else if (learned->classes.moving) {
    fmt::print(
        "where touches begin and end cannot be learned: 'dermis recognise' needs labels that leave a tenth of the "
        "frames without a touch, or labels of one frame each\n");
  }
  return write_report(options.report, data, set, *learned, progress);
}

Status learn(const LearnOptions& options) {
  if (Status checked = check_options(options); !checked) return checked;
  const Result<LabelledFrames> data = recognising::read_examples(options.examples, source_options());
  if (!data) return data.error();
  std::vector<Split> splits;
  std::vector<Split> open_splits;
  if (!options.splits.empty()) {
    Result<std::vector<Split>> read = learn::recognition::read_splits(options.splits, data->labels);
    if (!read) return read.error();
    splits = *std::move(read);
  }
  if (!options.open.empty()) {
    Result<std::vector<Split>> read = learn::recognition::read_open_splits(options.open, data->labels);
    if (!read) return read.error();
    open_splits = *std::move(read);
  }
  Progress progress;
  const auto start = Clock::now();
  const Result<LearningSet> set = LearningSet::create(*data, [&](double share) { progress.show("features", share); });
  if (!set) return set.error();
  const auto features_took = Clock::now() - start;
  if (!splits.empty()) {
    Status written = write_predictions(options.predictions, *data, *set, splits, Answers::classes, progress);
    if (!written) return written;
  }
  if (!open_splits.empty()) {
    Status written =
        write_predictions(options.open_predictions, *data, *set, open_splits, Answers::classes_or_unknown, progress);
    if (!written) return written;
  }
  if (options.out.empty()) return Done{};
  return write_model(options, *data, *set, Clock::now() - features_took, progress);
}

}  // namespace

void add_learn(Command& command) {
  auto options = std::make_shared<LearnOptions>();
  add_taught_examples(command, options->examples);
  command.output_model("--out", options->out, "Classes to write (safetensors)");
  command.input("--splits", options->splits, "splits.csv: for each split, learn from all labels that it does not name");
  command.output("--predictions", options->predictions, "File to write: the answers for the labels of --splits");
  command.input("--open", options->open, "open.csv: splits with classes that are not learned");
  command.output("--open-predictions", options->open_predictions,
                 "File to write: the answers for the labels of --open");
  command.output_folder("--report", options->report, {"index.html"},
                        "Folder for an HTML report with pictures and a comparison of estimators");
  command.action([options] {
    end_when_interrupted();
    return learn(*options);
  });
}

}  // namespace dermis::app
