// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "commands.hpp"
#include "dermis/files/atomic_file.hpp"
#include "dermis/files/text.hpp"
#include "dermis/recognition/classes_file.hpp"
#include "dermis/recognition/stream_recogniser.hpp"
#include "load_source.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using recognition::Answer;
using recognition::Classes;
using recognition::Layout;
using recognition::Recognition;
using recognition::StreamRecogniser;
using recognition::Verdict;

constexpr const char* kHeader =
    "first,last,time_s,class,probability,likeliest,second,second_probability,unknown_score,reason\n";

struct RecogniseOptions {
  std::string classes;
  LoadInput in;
  std::string out = "/dev/stdout";
  double rate_hz = 0.0;
  bool json = false;
};

/// What the frames of the source look like: those of the examples, side by side.
ArrayDescription array_of(const Layout& layout) {
  ArrayDescription array;
  const bool is_one = layout.arrays.size() == 1 && layout.arrays.front().taxel_count() == layout.readings;
  array.name = layout.arrays.front().name;
  array.rows = is_one ? layout.arrays.front().rows : 1;
  array.cols = is_one ? layout.arrays.front().cols : layout.readings;
  return array;
}

std::string csv_line(const Recognition& recognition, Nanos time, const Classes& classes) {
  const Answer& answer = recognition.answer;
  const std::string& likeliest = classes.names[answer.likeliest];
  const bool is_known = answer.verdict == Verdict::known;
  std::string line = fmt::format("{},{},", recognition.frames.first, recognition.frames.last);
  files::append_seconds(line, time);
  line +=
      fmt::format(",{},{:.4f},{},{},{:.4f},{:.4f},{}\n", is_known ? likeliest : "unknown",
                  answer.probabilities[answer.likeliest], likeliest, classes.names[answer.second],
                  answer.probabilities[answer.second], answer.unknown_score, is_known ? "" : to_string(answer.verdict));
  return line;
}

std::string json_line(const Recognition& recognition, Nanos time, const Classes& classes) {
  const Answer& answer = recognition.answer;
  nlohmann::ordered_json probabilities = nlohmann::ordered_json::object();
  for (std::size_t label = 0; label < classes.names.size(); ++label) {
    probabilities[classes.names[label]] = answer.probabilities[label];
  }
  const bool is_known = answer.verdict == Verdict::known;
  const nlohmann::ordered_json line = {
      {"first", recognition.frames.first},     {"last", recognition.frames.last},
      {"time_s", files::seconds_of(time)},     {"class", is_known ? classes.names[answer.likeliest] : "unknown"},
      {"unknown_score", answer.unknown_score}, {"reason", is_known ? "" : to_string(answer.verdict)},
      {"probabilities", probabilities}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// `before`: how many frames came before the first that the recogniser saw.
Recognition counted_from(Recognition recognition, std::size_t before) {
  recognition.frames.first += before;
  recognition.frames.last += before;
  return recognition;
}

Status recognise_all(StreamRecogniser& recogniser, LoadSource& source, bool json, files::AtomicFile& out) {
  const auto write = json ? json_line : csv_line;
  std::size_t tared = 0;
  while (!stop_flag().load()) {
    const Result<bool> more = source.next();
    if (!more) return more.error();
    if (!*more) break;
    if (source.is_tare()) {
      ++tared;
      continue;
    }
    const auto recognition = recogniser.next(source.loads());
    if (!recognition) continue;
    out.write(write(counted_from(*recognition, tared), source.time(), recogniser.classes()));
    if (Status written = out.status(); !written) return written;
  }
  if (const auto last = recogniser.finish()) {
    out.write(write(counted_from(*last, tared), source.time(), recogniser.classes()));
  }
  return out.commit();
}

/// Whether these classes can name what comes from `options`.
Status check_classes(const Classes& classes, const RecogniseOptions& options) {
  if (classes.layout.extras > 0) {
    return bad_input(options.classes +
                     ": its classes need further readings beside each frame, which a stream of frames has not; learn "
                     "them without --extra");
  }
  if (Status checked = check_loads(classes.layout, options.classes, options.in.model); !checked) return checked;
  if (classes.layout.rate_hz == 0.0 && options.rate_hz > 0.0) {
    return bad_input("--rate: " + options.classes +
                     " does not know the rate of its examples; learn its classes with --rate");
  }
  return Done{};
}

/// What the frames of the source look like.
Layout layout_of(const LoadSource& source, const Classes& classes, double rate_hz) {
  Layout layout = classes.layout;
  const std::optional<recognition::SensedArray> array = source.array();
  if (layout.has_forces() && array) {
    layout.arrays = {*array};
    layout.readings = array->taxel_count();
  }
  if (rate_hz > 0.0) layout.rate_hz = rate_hz;
  return layout;
}

Status recognise(const RecogniseOptions& options) {
  if (!recognition::is_rate(options.rate_hz)) return bad_input("--rate: must be 0.001 to 1e6");
  Result<Classes> classes = recognition::read_classes(options.classes);
  if (!classes) return classes.error();
  if (Status checked = check_classes(*classes, options); !checked) return checked;
  const ArrayDescription array = array_of(classes->layout);
  LoadInput input = options.in;
  input.array = &array;
  input.stop = &stop_flag();
  Result<LoadSource> source = LoadSource::open(input);
  if (!source) return source.error();
  const Layout layout = layout_of(*source, *classes, options.rate_hz);
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(*std::move(classes), layout);
  if (!recogniser) return bad_input(options.classes + ": " + recogniser.error().message);
  Result<files::AtomicFile> out = files::AtomicFile::create(options.out);
  if (!out) return out.error();
  if (layout.rate_hz == 0.0) {
    say(options.classes + ": does not know the rate of its examples, so each pose is told from a single frame, and " +
        "gestures must come at that rate");
  }
  if (!options.json) out->write(kHeader);
  return recognise_all(*recogniser, *source, options.json, *out);
}

}  // namespace

void add_recognise(Command& command) {
  auto options = std::make_shared<RecogniseOptions>();
  command.option("--classes", options->classes, "Classes of 'dermis learn'").required();
  command.option("--in", options->in.from, "A file of frames, a recording or the URI of a device").required();
  command.option("--model", options->in.model, "What computes the forces, where the classes were learned from forces");
  command.flag(
      "--tare", options->in.tare,
      "Take the first second (at least 10 frames) for unloaded; else readings without --model are tared already");
  command.option("--out", options->out, "Where to write what is recognised").shows_default();
  command.option("--rate", options->rate_hz, "Frames a second, where they differ from those of the examples [Hz]");
  command.flag("--json", options->json, "Write a line of JSON each, with the probabilities of all classes");
  command.action([options] { return recognise(*options); });
}

}  // namespace dermis::app
