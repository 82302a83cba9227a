// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/core/result.hpp"

namespace dermis::fleet {

/// Work for any machine of a fleet: a command of dermis on files of its folder.
struct Job {
  std::string name;                ///< Of the user; for the list of jobs.
  std::vector<std::string> words;  ///< "run", "--in", "a.mcap", ...

  bool operator==(const Job&) const = default;
};

/// Jobs come from others. Fails on all but a few commands, which only read and write files, and on words that may lead
/// out of the folder: absolute paths, "..", addresses of devices.
[[nodiscard]] Status check_job(const Job& job);

/// Reads jobs.toml: a table [[job]] with `words`, and a `name` if wanted, for each. Checks each.
[[nodiscard]] Result<std::vector<Job>> read_jobs(const std::string& path);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<std::vector<Job>> parse_jobs(std::string_view text, const std::string& name);

/// As messages carry it.
[[nodiscard]] std::string job_to_json(const Job& job);
/// Accepts any text. Checks the job.
[[nodiscard]] Result<Job> job_from_json(std::string_view text);

}  // namespace dermis::fleet
