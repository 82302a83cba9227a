// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

/// Work for any machine of a fleet: a command of dermis on files of its folder, or on ranges of streams.
struct Job {
  std::string name;                ///< Given by the user, for the list of jobs.
  std::vector<std::string> words;  ///< "run", "--in", "a.mcap", ...

  bool operator==(const Job&) const = default;
};

/// Jobs come from others. Fails on all but a few commands, which only read and write files. Also fails on words that
/// may lead out of the folder: absolute paths, "..", addresses of devices. Fails on ranges without an end.
[[nodiscard]] Status check_job(const Job& job);

/// The word of a job is a range of a stream on the worker's server: "nats://?robot=R&array=A&from=1&to=last".
[[nodiscard]] bool is_range(std::string_view word);
/// The address of a range (StreamAddress) that check_job() has accepted.
[[nodiscard]] std::string range_at(const BrokerAddress& server, std::string_view word);

/// Reads jobs.toml: a table [[job]] with `words`, and a `name` if wanted, for each. Checks each.
[[nodiscard]] Result<std::vector<Job>> read_jobs(const std::string& path);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<std::vector<Job>> parse_jobs(std::string_view text, const std::string& name);

/// As messages carry it.
[[nodiscard]] std::string job_to_json(const Job& job);
/// Accepts any text. Checks the job.
[[nodiscard]] Result<Job> job_from_json(std::string_view text);

}  // namespace dermis::live::fleet
