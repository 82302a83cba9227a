// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "commands.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/text.hpp"
#include "recognising/source_recogniser.hpp"
#include "source_options.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using learn::recognition::Classes;
using learn::recognition::Verdict;
using recognising::RecognitionInput;
using recognising::SourceRecogniser;
using recognising::SourceRecognition;

constexpr const char* kHeader =
    "first,last,time_s,class,probability,likeliest,second,second_probability,unknown_score,reason\n";

struct RecogniseOptions {
  RecognitionInput in;
  std::string out = kStandardOutput;
  bool json = false;
};

std::string csv_line(const SourceRecognition& found, const Classes& classes) {
  const auto& [frames, answer] = found.recognition;
  const std::string& likeliest = classes.names[answer.likeliest];
  const bool is_known = answer.verdict == Verdict::known;
  std::string line = fmt::format("{},{},", frames.first, frames.last);
  bytes::files::append_seconds(line, found.time);
  line +=
      fmt::format(",{},{:.4f},{},{},{:.4f},{:.4f},{}\n", is_known ? likeliest : "unknown",
                  answer.probabilities[answer.likeliest], likeliest, classes.names[answer.second],
                  answer.probabilities[answer.second], answer.unknown_score, is_known ? "" : to_string(answer.verdict));
  return line;
}

std::string json_line(const SourceRecognition& found, const Classes& classes) {
  const auto& [frames, answer] = found.recognition;
  nlohmann::ordered_json probabilities = nlohmann::ordered_json::object();
  for (std::size_t label = 0; label < classes.names.size(); ++label) {
    probabilities[classes.names[label]] = answer.probabilities[label];
  }
  const bool is_known = answer.verdict == Verdict::known;
  const nlohmann::ordered_json line = {{"first", frames.first},
                                       {"last", frames.last},
                                       {"time_s", bytes::files::seconds_of(found.time)},
                                       {"class", is_known ? classes.names[answer.likeliest] : "unknown"},
                                       {"unknown_score", answer.unknown_score},
                                       {"reason", is_known ? "" : to_string(answer.verdict)},
                                       {"probabilities", probabilities}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Status recognise_all(SourceRecogniser& recogniser, bool json, bytes::files::AtomicFile& out) {
  const auto write = json ? json_line : csv_line;
  for (;;) {
    const Result<std::optional<SourceRecognition>> found = recogniser.next();
    if (!found) return found.error();
    if (!*found) return out.commit();
    out.write(write(**found, recogniser.classes()));
    if (Status written = out.status(); !written) return written;
  }
}

Status recognise(const RecogniseOptions& options) {
  RecognitionInput input = options.in;
  input.loads.source = source_options();
  input.loads.tare = input.loads.tare || input.loads.tare_force;
  Result<SourceRecogniser> recogniser = SourceRecogniser::open(input);
  if (!recogniser) return recogniser.error();
  Result<bytes::files::AtomicFile> out = bytes::files::AtomicFile::create(options.out);
  if (!out) return out.error();
  if (!recogniser->knows_rate()) {
    print_notice(input.classes +
                 ": does not know the rate of its examples, so each pose is told from a single frame, and " +
                 "gestures must come at that rate");
  }
  if (!options.json) out->write(kHeader);
  return recognise_all(*recogniser, options.json, *out);
}

}  // namespace

void add_recognise(Command& command) {
  auto options = std::make_shared<RecogniseOptions>();
  command.input_file("--classes", options->in.classes, "Classes of 'dermis recognise learn'").required();
  command.input("--in", options->in.loads.from, "A file of frames, a recording or the URI of a device").required();
  command.input_file("--model", options->in.loads.model,
                     "Model for classes that were learned from forces, or suit.toml of several arrays");
  command.flag(
      "--tare", options->in.loads.tare,
      "Take the first second (at least 10 frames) as unloaded; without it and --model, readings must be tared");
  command.flag("--tare-force", options->in.loads.tare_force, "The same, whatever load stands on the array");
  command.input("--extra", options->in.loads.extra,
                "CSV of further readings beside the frames, where the classes were learned with some");
  command.output("--out", options->out, "File to write the answers to").shows_default();
  command.option("--rate", options->in.rate_hz, "Frames a second, if they differ from those of the examples [Hz]");
  command.flag("--json", options->json,
               "Write one line of JSON for each answer, with the probabilities of all classes");
  command.action([options] { return recognise(*options); });
  Command learn = command.subcommand("learn", "Learn classes from examples of poses or gestures");
  add_learn(learn);
}

}  // namespace dermis::app
