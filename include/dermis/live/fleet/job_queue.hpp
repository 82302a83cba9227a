// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/fleet/job.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

class Broker;

/// A job that one worker has. Another gets it where it is neither done nor extended in time.
struct TakenJob {
  Job job;
  std::string id;
  std::uint64_t tries = 1;  ///< This one included.
  std::string lease;        ///< It names the job to the server.
};

/// The outcome of a job.
struct JobOutcome {
  std::string name;
  std::string worker;
  double seconds = 0.0;
  std::string error;      ///< Empty: it is done.
  bool is_final = false;  ///< An error that another try would not mend.
};

struct JobCounts {
  std::uint64_t waiting = 0;
  std::uint64_t taken = 0;
  std::uint64_t done = 0;
  std::uint64_t given_up = 0;
};

/// The jobs of a fleet, in streams of its server. Thread-safe.
class JobQueue {
 public:
  static constexpr std::uint64_t kMostTries = 3;
  /// Each try has its lease. A killed worker's job waits little. After a slow link has cost a try, there is more time.
  static constexpr std::array<std::chrono::seconds, kMostTries> kLeases{
      std::chrono::seconds(4), std::chrono::seconds(12), std::chrono::seconds(36)};

  /// Makes the streams where they are not there. Fails where no server answers.
  [[nodiscard]] static Result<std::unique_ptr<JobQueue>> connect(const BrokerAddress& address);
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;
  ~JobQueue();

  [[nodiscard]] Status submit(const Job& job);

  /// The next job; empty where none comes within a second. A job that nobody can do is given up here.
  [[nodiscard]] Result<std::optional<TakenJob>> take();
  /// Nobody else gets the job within the lease of its try from now.
  [[nodiscard]] Status extend(const TakenJob& job);
  /// Another worker gets the job at once.
  [[nodiscard]] Status give_back(const TakenJob& job);
  /// Stores the outcome; then the job is away. A failed one is given back, after kMostTries or a final error given up.
  [[nodiscard]] Status finish(const TakenJob& job, const JobOutcome& outcome);

  [[nodiscard]] Result<JobCounts> counts();
  /// The jobs that were given up, and why.
  [[nodiscard]] Result<std::vector<JobOutcome>> given_up();

 private:
  explicit JobQueue(std::unique_ptr<Broker> broker);
  [[nodiscard]] Status store_outcome(const std::string& subject, const JobOutcome& outcome);
  [[nodiscard]] Status give_up(const TakenJob& job, const std::string& why);

  std::unique_ptr<Broker> broker_;
};

}  // namespace dermis::live::fleet
