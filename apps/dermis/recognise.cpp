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
#include "open_source.hpp"
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
  std::string in;
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

Status recognise_all(StreamRecogniser& recogniser, FrameSource& source, bool json, files::AtomicFile& out) {
  const auto write = json ? json_line : csv_line;
  RawFrame frame;
  while (!stop_flag().load()) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) break;
    const auto recognition = recogniser.next(frame.counts);
    if (!recognition) continue;
    out.write(write(*recognition, frame.time, recogniser.classes()));
    if (Status written = out.status(); !written) return written;
  }
  if (const auto last = recogniser.finish()) out.write(write(*last, frame.time, recogniser.classes()));
  return out.commit();
}

Status recognise(const RecogniseOptions& options) {
  if (!recognition::is_rate(options.rate_hz)) return bad_input("--rate: must be 0.001 to 1e6");
  Result<Classes> classes = recognition::read_classes(options.classes);
  if (!classes) return classes.error();
  Layout layout = classes->layout;
  if (layout.extras > 0) {
    return bad_input(options.classes +
                     ": its classes need further readings beside each frame, which a stream of frames " +
                     "has not; learn them without --extra");
  }
  if (options.rate_hz > 0.0) layout.rate_hz = options.rate_hz;
  const ArrayDescription array = array_of(layout);
  const Result<std::unique_ptr<FrameSource>> source = open_source(options.in, &array);
  if (!source) return source.error();
  const std::optional<FrameShape> shape = (*source)->shape();
  if (shape && shape->taxel_count() != layout.readings) {
    return bad_input(fmt::format("{}: has frames of {} readings, the examples had {}", options.in, shape->taxel_count(),
                                 layout.readings));
  }
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(*std::move(classes), layout);
  if (!recogniser) return bad_input(options.classes + ": " + recogniser.error().message);
  Result<files::AtomicFile> out = files::AtomicFile::create(options.out);
  if (!out) return out.error();
  if (!options.json) out->write(kHeader);
  return recognise_all(*recogniser, **source, options.json, *out);
}

}  // namespace

void add_recognise(Command& command) {
  auto options = std::make_shared<RecogniseOptions>();
  command.option("--classes", options->classes, "Classes of 'dermis learn'").required();
  command.option("--in", options->in, "Tared frames: a file, a recording or the URI of a device").required();
  command.option("--out", options->out, "Where to write what is recognised").shows_default();
  command.option("--rate", options->rate_hz, "Frames a second, where they differ from those of the examples [Hz]");
  command.flag("--json", options->json, "Write a line of JSON each, with the probabilities of all classes");
  command.action([options] { return recognise(*options); });
}

}  // namespace dermis::app
