// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/job.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "dermis/bytes/files/config_table.hpp"
#include "dermis/live/fleet/stream_address.hpp"

namespace dermis::live::fleet {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostWords = 200;
constexpr std::size_t kMostCharacters = 4096;
const std::set<std::string, std::less<>> kCommands = {"calibrate", "convert", "dataset", "evaluate", "run", "simulate"};
constexpr std::string_view kOwnServer = "nats://?";  // that of the worker

bool has_control_characters(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
}

bool is_option(std::string_view word, std::string_view name) {
  return word.starts_with("--") && word.substr(2).starts_with(name);
}

/// A path within the folder, or no path at all.
bool stays_within(std::string_view word) {
  if (has_control_characters(word)) return false;
  if (word.starts_with('/') || word.starts_with('~') || word == "--" || is_option(word, "force")) return false;
  if (word.starts_with('[') || word.find("=[") != std::string_view::npos) return false;  // "[a,b]" are two words
  const bool is_short_option = word.size() > 1 && word[0] == '-' && word[1] != '-';
  if (is_short_option && word.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return false;
  for (const std::string_view way_out : {"..", "=/", ":/", "%", "#/", "//"}) {
    if (word.find(way_out) != std::string_view::npos) return false;
  }
  for (const std::string_view device : {"serial:", "tcp:", "tcp-listen:", "udp:", "stdin:", "nats:", "tls:", "dds:",
                                        "modbus-tcp:", "modbus-rtu:", "file:", "sim:"}) {
    if (word.find(device) != std::string_view::npos) return false;
  }
  return true;
}

/// A word after this one is read, and not written.
bool names_an_input(std::string_view before) {
  if (!before.starts_with('-') || before.find('=') != std::string_view::npos) return true;
  return before.starts_with("--") && (before.substr(2) == "in" || before.substr(2) == "frames");
}

/// A range of frames on the worker's own server, which it reads by its own key. `before`: the word before it.
Status check_range(const std::string& word, const std::string& before) {
  if (!names_an_input(before)) return bad_input("words: '" + word + "' is no recording to read");
  const Result<StreamAddress> range = parse_stream_address("nats://HUB?" + word.substr(kOwnServer.size()));
  if (!range) return range.error();
  if (!range->ends) return bad_input("words: '" + word + "' has no end; add to=");
  if (range->broker.key.empty() && range->broker.ca.empty()) return Done{};
  return bad_input("words: '" + word + "' names a key or certificates; the worker has its own");
}

std::string command_list() {
  std::string list;
  for (const std::string& command : kCommands) list += (list.empty() ? "" : ", ") + command;
  return list;
}

Result<std::vector<Job>> jobs_of(bytes::files::ConfigFile& file, const std::string& name) {
  std::vector<Job> jobs(file.table_count("job"));
  if (jobs.empty()) return bad_input(name + ": has no [[job]]");
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const std::string table = "job[" + std::to_string(i) + "].";
    jobs[i].name = name + " " + std::to_string(i + 1);
    file.text(table + "name", jobs[i].name);
    file.require(table + "words");
    file.texts(table + "words", jobs[i].words);
    if (const Status good = check_job(jobs[i]); !good) file.fail(table + "words", good.error().message);
  }
  if (const Status finished = file.finish(); !finished) return finished.error();
  return jobs;
}

}  // namespace

Status check_job(const Job& job) {
  if (job.words.empty() || !kCommands.contains(job.words.front())) {
    return bad_input("words: a job begins with one of " + command_list());
  }
  if (job.words.size() > kMostWords) return bad_input("words: are more than 200");
  if (job.name.size() > kMostCharacters || has_control_characters(job.name)) {
    return bad_input("name: must be one line of at most 4096 characters");
  }
  for (std::size_t i = 0; i < job.words.size(); ++i) {
    const std::string& word = job.words[i];
    if (word.size() > kMostCharacters) return bad_input("words: one is longer than 4096 characters");
    if (is_range(word)) {
      if (Status good = check_range(word, job.words[i - 1]); !good) return good;  // not the first, a command
    } else if (!stays_within(word)) {
      return bad_input("words: '" + word + "' may lead out of the folder; name files by relative paths");
    }
  }
  return Done{};
}

bool is_range(std::string_view word) {
  return word.starts_with(kOwnServer);
}

std::string range_at(const BrokerAddress& server, std::string_view word) {
  std::string address = server.url + "?" + std::string(word.substr(kOwnServer.size()));
  if (!server.ca.empty()) address += "&ca=" + server.ca;
  if (!server.key.empty()) address += "&key=" + server.key;
  return address;
}

Result<std::vector<Job>> read_jobs(const std::string& path) {
  Result<bytes::files::ConfigFile> file = bytes::files::ConfigFile::read(path);
  if (!file) return file.error();
  return jobs_of(*file, path);
}

Result<std::vector<Job>> parse_jobs(std::string_view text, const std::string& name) {
  Result<bytes::files::ConfigFile> file = bytes::files::ConfigFile::parse(text, name);
  if (!file) return file.error();
  return jobs_of(*file, name);
}

std::string job_to_json(const Job& job) {
  return Json({{"name", job.name}, {"words", job.words}}).dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<Job> job_from_json(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  const bool is_job =
      json.is_object() && json.contains("name") && json["name"].is_string() && json.contains("words") &&
      json["words"].is_array() &&
      std::all_of(json["words"].begin(), json["words"].end(), [](const Json& word) { return word.is_string(); });
  if (!is_job) return bad_input("is no job: needs name and words");
  Job job{json["name"], json["words"]};
  if (const Status good = check_job(job); !good) return good.error();
  return job;
}

}  // namespace dermis::live::fleet
