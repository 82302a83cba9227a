// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/layout_proposals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostShown = 1024;  // bytes

const char* name_of(bytes::layouts::Role role) {
  using bytes::layouts::Role;
  switch (role) {
    case Role::literal: return "mark";
    case Role::values: return "values";
    case Role::time:
    case Role::clock:
    case Role::datetime: return "time";
    case Role::row:
    case Role::col:
    case Role::first:
    case Role::count:
    case Role::array:
    case Role::frame: return "number";
    case Role::checksum: return "checksum";
    default: return "other";
  }
}

ordered_json parts_json(const std::vector<bytes::proposals::Part>& parts) {
  ordered_json json = ordered_json::array();
  for (const bytes::proposals::Part& part : parts) {
    if (part.begin >= kMostShown) continue;
    json.push_back({part.begin, std::min(part.end, kMostShown), name_of(part.role)});
  }
  return json;
}

}  // namespace

std::string hex_of(std::span<const std::uint8_t> bytes) {
  std::string hex;
  for (const std::uint8_t byte : bytes) hex += fmt::format("{:02x}", byte);
  return hex;
}

Result<bytes::proposals::Known> known_request(const JsonRequest& request) {
  bytes::proposals::Known known;
  for (const auto& [field, lines] : {std::pair{"rows", &known.rows}, {"cols", &known.cols}}) {
    const Result<std::optional<std::uint64_t>> number = request.number(field, "1 to 1024");
    if (!number) return number.error();
    if (*number && (**number < 1 || **number > kMaxLines)) return bad_field(field, "must be 1 to 1024");
    if (*number) *lines = **number;
  }
  return known;
}

std::string layout_proposals(std::span<const std::uint8_t> bytes, const bytes::proposals::Known& known) {
  ordered_json answer = {{"bytes", hex_of(bytes.first(std::min(bytes.size(), kMostShown)))},
                         {"proposals", ordered_json::array()}};
  for (const bytes::proposals::Proposal& proposal : bytes::proposals::propose(bytes, known)) {
    answer["proposals"].push_back({{"summary", proposal.summary},
                                   {"layout", proposal.toml},
                                   {"reasons", proposal.reasons},
                                   {"doubts", proposal.doubts},
                                   {"left_over", proposal.left_over},
                                   {"open", proposal.open},
                                   {"rows", proposal.shape.rows},
                                   {"cols", proposal.shape.cols},
                                   {"frames", proposal.frames},
                                   {"example", proposal.example},
                                   {"parts", parts_json(proposal.parts)}});
  }
  return json_text(answer);
}

Result<std::string> wanted_layout(const JsonRequest& request, std::span<const std::uint8_t> bytes) {
  const Result<std::optional<std::uint64_t>> place = request.number("place", "that of a proposal");
  if (!place) return place.error();
  if (const Result<std::vector<std::string>> lines = request.texts("layout"); lines && !*place) {
    return fmt::format("{}\n", fmt::join(*lines, "\n"));
  }
  const Result<bytes::proposals::Known> known = known_request(request);
  if (!known) return known.error();
  std::vector<bytes::proposals::Proposal> proposals = bytes::proposals::propose(bytes, *known);
  const std::uint64_t number = place->value_or(0);
  if (number >= proposals.size()) return bad_input("no such layout reads these bytes");
  return std::move(proposals[static_cast<std::size_t>(number)].toml);
}

Result<std::string> write_layout(const std::string& toml, const std::string& file) {
  const Result<bytes::layouts::Layout> layout = bytes::layouts::layout_from_toml(toml, file);
  if (!layout) return layout.error();
  const std::string& array = layout->arrays.front().name;
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    const Result<std::string> before = bytes::files::read_file(file, toml.size() + 1);
    if (before && *before == toml) return array;
    return bad_field("name", file + " is there already: choose another name");
  }
  Result<bytes::files::AtomicFile> written = bytes::files::AtomicFile::create(file);
  if (!written) return written.error();
  written->write(toml);
  if (Status committed = written->commit(); !committed) return committed.error();
  return array;
}

std::string read_by_layout(const std::string& from, const std::string& file, const std::string& array) {
  const char* const mark = from.find('?') == std::string::npos ? "?" : "&";
  return from + mark + "layout=" + file + (array.empty() ? "" : "&array=" + array);
}

}  // namespace dermis::out::serve
