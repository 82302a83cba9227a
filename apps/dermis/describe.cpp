// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "asking.hpp"
#include "commands.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/proposals/proposals.hpp"
#include "dermis/learn/arrangement/arrangement.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "interruption.hpp"
#include "pressing.hpp"
#include "proposal_text.hpp"
#include "source_bytes.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using bytes::proposals::Proposal;

struct DescribeOptions {
  std::string source;
  std::optional<std::uint64_t> rows;
  std::optional<std::uint64_t> cols;
  std::string unit;
  std::string out;
  std::string asks;
  bool json = false;
  std::string places;
  double pitch_mm = 10.0;
};

const std::vector<std::string>& units() {
  static const std::vector<std::string> kUnits = {"counts", "volts", "ohms", "kPa", "newtons"};
  return kUnits;
}

Status set_unit(const std::string& unit, bytes::proposals::Known& known) {
  if (std::find(units().begin(), units().end(), unit) == units().end()) {
    return bad_input("--unit: must be counts, volts, ohms, kPa or newtons");
  }
  known.unit = unit;
  return Done{};
}

Result<bytes::proposals::Known> known_of(const DescribeOptions& options) {
  bytes::proposals::Known known;
  for (const auto& [name, lines, into] :
       {std::tuple{"--rows", options.rows, &known.rows}, {"--cols", options.cols, &known.cols}}) {
    if (lines && (*lines < 1 || *lines > kMaxLines))
      return bad_input(fmt::format("{}: must be 1 to {}", name, kMaxLines));
    *into = lines;
  }
  if (options.unit.empty()) return known;
  if (Status set = set_unit(options.unit, known); !set) return set.error();
  return known;
}

void print_json(const DescribeOptions& options, const SourceBytes& source, const std::vector<Proposal>& proposals) {
  using Json = nlohmann::ordered_json;
  Json json = {{"source", options.source},
               {"bytes", source.bytes.size()},
               {"known", source.known.empty() ? Json() : Json(source.known)},
               {"proposals", Json::array()}};
  for (const Proposal& proposal : proposals) {
    json["proposals"].push_back({{"layout", proposal.toml},
                                 {"summary", proposal.summary},
                                 {"reasons", proposal.reasons},
                                 {"doubts", proposal.doubts},
                                 {"left_over", proposal.left_over},
                                 {"left_share", proposal.left_share},
                                 {"open", proposal.open},
                                 {"frames", proposal.frames},
                                 {"rows", proposal.shape.rows},
                                 {"cols", proposal.shape.cols},
                                 {"example", proposal.example}});
  }
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

/// A line that the user types; `otherwise` where it is empty.
std::string asked(const std::string& question, const std::string& otherwise) {
  fmt::print(stderr, "{} [{}]: ", question, otherwise);
  std::string answer;
  std::getline(std::cin, answer);
  return answer.empty() ? otherwise : answer;
}

Status ask_lines(const std::string& name, std::size_t likely, std::optional<std::size_t>& lines) {
  const std::string answer = asked(name, std::to_string(likely));
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(answer.data(), answer.data() + answer.size(), value);
  if (error != std::errc{} || end != answer.data() + answer.size() || value < 1 || value > kMaxLines) {
    return bad_input(fmt::format("{}: must be 1 to {}", name, kMaxLines));
  }
  lines = value;
  return Done{};
}

/// Asks for what the bytes cannot tell; true where an answer says more than was known.
Result<bool> ask(const Proposal& proposal, bytes::proposals::Known& known) {
  for (const std::string& key : proposal.open) {
    Status answered = Done{};
    if (key == "rows") answered = ask_lines("rows", proposal.shape.rows, known.rows);
    if (key == "cols") answered = ask_lines("columns", proposal.shape.cols, known.cols);
    if (key == "unit") answered = set_unit(asked("unit: counts, volts, ohms, kPa or newtons", "counts"), known);
    if (!answered) return answered.error();
  }
  return !proposal.open.empty();
}

void print_text(const DescribeOptions& options, const SourceBytes& source, const std::vector<Proposal>& proposals) {
  if (!source.known.empty())
    fmt::print("{}: these bytes are {}: dermis reads them as they are\n", options.source, source.known);
  for (std::size_t k = 0; k < proposals.size(); ++k)
    fmt::print("{}{}", k > 0 ? "\n" : "", proposal_text(proposals[k], k + 1));
}

Status write_layout(const DescribeOptions& options, const Proposal& proposal) {
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(options.out);
  if (!file) return file.error();
  file->write("# Of " + options.source + ", by dermis describe: " + proposal.summary + "\n" + proposal.toml);
  return file->commit();
}

Result<std::size_t> chosen_of(const std::vector<Proposal>& proposals) {
  const std::string answer = asked(fmt::format("which layout, 1 to {}", proposals.size()), "1");
  if (answer.size() != 1 || answer[0] < '1' || answer[0] >= '1' + static_cast<int>(proposals.size())) {
    return bad_input("which layout: must be 1 to " + std::to_string(proposals.size()));
  }
  return static_cast<std::size_t>(answer[0] - '1');
}

Status describe(const DescribeOptions& options) {
  Result<bytes::proposals::Known> known = known_of(options);
  if (!known) return known.error();
  const Result<SourceBytes> source = read_source_bytes(options.source, options.asks);
  if (!source) return source.error();
  if (!source->start.empty()) known->start = bytes::files::bytes_toml(source->start);
  if (!source->request.empty()) known->request = bytes::files::bytes_toml(source->request);
  const bool is_file_that_is_known = !source->known.empty() && !source->is_stream;
  std::vector<Proposal> proposals;
  if (!is_file_that_is_known) proposals = bytes::proposals::propose(source->bytes, *known);
  if (options.json) print_json(options, *source, proposals);
  if (!options.json) print_text(options, *source, proposals);
  if (proposals.empty()) {
    if (!options.out.empty() || source->known.empty()) {
      return bad_input(fmt::format("'{}': no layout {}", options.source,
                                   source->known.empty() ? "reads most of these bytes" : "is needed"));
    }
    return Done{};
  }
  std::size_t chosen = 0;
  const bool is_asked = !options.json && ::isatty(STDIN_FILENO) == 1;
  if (is_asked) {
    const Result<bool> answered = ask(proposals.front(), *known);
    if (!answered) return answered.error();
    if (*answered) {
      proposals = bytes::proposals::propose(source->bytes, *known);
      if (proposals.empty())
        return bad_input(fmt::format("'{}': no layout of this shape reads these bytes", options.source));
      print_text(options, *source, proposals);
    }
    if (!options.out.empty() && proposals.size() > 1) {
      const Result<std::size_t> which = chosen_of(proposals);
      if (!which) return which.error();
      chosen = *which;
    }
  }
  return options.out.empty() ? Status(Done{}) : write_layout(options, proposals[chosen]);
}

}  // namespace

void add_describe(Command& command) {
  auto options = std::make_shared<DescribeOptions>();
  command.input("source", options->source, "URI of a device (docs/devices.md), or a file").required();
  const Option press =
      command.input("--press", options->places,
                    "places.csv, or a grid as 6x9: press these places in turn; tells which channel is where");
  command.option("--pitch", options->pitch_mm, "From place to place of the grid [mm]").shows_default().needs(press);
  command.option("--rows", options->rows, "Rows of the array, where they are known").excludes(press);
  command.option("--cols", options->cols, "Columns of the array, where they are known").excludes(press);
  command.option("--unit", options->unit, "What a reading is").one_of(units()).excludes(press);
  const Option ask =
      command.flag("--ask", options->asks, std::string(kUsualAsks),
                   "Send a silent device what boards usually wait for, or --ask=BYTES, until it answers");
  ask.excludes(press);
  command.output(
      "--out", options->out,
      "layout.toml to write: the first layout, or the one that is chosen on a terminal; with --press, array.toml");
  command.outputs_beside("--out", [options] {
    if (options->places.empty() || options->out.empty()) return std::vector<std::string>();
    const auto [array, positions, suit] = learn::arrangement::arrangement_files(options->out);
    return std::vector{positions, suit};
  });
  command.flag("--json", options->json, "As JSON");
  command.action([options] {
    end_when_interrupted();
    if (options->places.empty()) return describe(*options);
    return describe_pressing({options->source, options->places, options->pitch_mm, options->out, options->json});
  });
}

}  // namespace dermis::app
