// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "child_process.hpp"
#include "commands.hpp"
#include "dermis/live/fleet/job_queue.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{2};
constexpr std::chrono::seconds kExtendEvery = live::fleet::JobQueue::kLeases.front() / 4;
constexpr std::chrono::seconds kRetryAfter{1};
constexpr std::chrono::seconds kRestAfterFailure{5};  // for each in a row
constexpr int kMostRests = 12;
constexpr int kBadInput = 2;  // exit status: another try would end alike

struct WorkOptions {
  std::string hub;
  std::string folder = ".";
};

Result<std::string> own_program() {
  std::error_code failure;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failure);
  if (failure) return failed("/proc/self/exe: " + failure.message());
  return program.string();
}

std::string name_of_worker() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}-{}", host.data(), ::getpid());
}

std::string absolute(const std::string& path) {
  return path.empty() ? path : std::filesystem::absolute(path).string();
}

struct Worker {
  std::string name;
  std::string program;
  live::fleet::BrokerAddress server;  ///< Its files have absolute paths, as the worker goes to the folder of the jobs.
};

Result<Worker> worker_of(const std::string& hub) {
  Result<live::fleet::BrokerAddress> server = live::fleet::parse_broker_address(hub);
  if (!server) return server.error();
  Result<std::string> program = own_program();
  if (!program) return program.error();
  server->ca = absolute(server->ca);
  server->key = absolute(server->key);
  const auto range =
      live::fleet::parse_stream_address(live::fleet::range_at(*server, "nats://?robot=r&array=a&from=1&to=last"));
  if (!range) return range.error();
  return Worker{name_of_worker(), *std::move(program), *std::move(server)};
}

/// Where the word names a file of the folder or below, or none. `folder`: without links.
bool stays_in(const std::filesystem::path& folder, const std::string& word) {
  const std::size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
  const std::string name = equals == std::string::npos ? word : word.substr(equals + 1);
  std::error_code failure;
  const std::filesystem::path place =
      std::filesystem::weakly_canonical(folder / name.substr(0, name.find('#')), failure);
  if (failure) return false;
  const auto [end_of_folder, rest] = std::mismatch(folder.begin(), folder.end(), place.begin(), place.end());
  return end_of_folder == folder.end();
}

/// The job as a process that does not outlive this one. A later try replaces an output, but no dataset.
Result<ChildProcess> start(const live::fleet::TakenJob& taken, const Worker& worker) {
  const std::filesystem::path folder = std::filesystem::canonical(".");
  std::vector<std::string> command = {"setpriv", "--pdeathsig", "KILL", worker.program};
  for (const std::string& word : taken.job.words) {
    const bool is_range = live::fleet::is_range(word);
    if (!is_range && !stays_in(folder, word)) return bad_input("'" + word + "' leads out of the folder");
    command.push_back(is_range ? live::fleet::range_at(worker.server, word) : word);
  }
  if (taken.tries > 1 && taken.job.words.front() != "dataset") command.emplace_back("--force");
  return ChildProcess::start(command);
}

/// Waits for the job and extends its lease; empty where the worker is stopped.
std::optional<int> exit_status_of(ChildProcess& child, live::fleet::JobQueue& queue,
                                  const live::fleet::TakenJob& taken) {
  Clock::time_point extended = Clock::now();
  while (!stop_flag()) {
    if (const std::optional<int> status = child.exit_status()) return status;
    std::this_thread::sleep_for(kLook);
    if (Clock::now() - extended < kExtendEvery) continue;
    static_cast<void>(queue.extend(taken));
    extended = Clock::now();
  }
  return std::nullopt;
}

/// The outcome but for its seconds; empty where the worker is stopped.
std::optional<live::fleet::JobOutcome> do_job(live::fleet::JobQueue& queue, const live::fleet::TakenJob& taken,
                                              const Worker& worker) {
  live::fleet::JobOutcome outcome;
  outcome.name = taken.job.name;
  outcome.worker = worker.name;
  Result<ChildProcess> child = start(taken, worker);
  if (!child) {
    outcome.error = child.error().message;
    outcome.is_final = child.error().kind == ErrorKind::bad_input;
    return outcome;
  }
  const std::optional<int> status = exit_status_of(*child, queue, taken);
  if (!status) return std::nullopt;
  if (*status != 0) outcome.error = fmt::format("exit status {}", *status);
  outcome.is_final = *status == kBadInput;
  return outcome;
}

/// Tries until the server has it: a job that was done is not to be done again.
void finish(live::fleet::JobQueue& queue, const live::fleet::TakenJob& taken, const live::fleet::JobOutcome& outcome) {
  for (Status told = queue.finish(taken, outcome); !told && !stop_flag(); told = queue.finish(taken, outcome)) {
    print_notice(told.error().message);
    std::this_thread::sleep_for(kRetryAfter);
  }
}

/// Another worker gets the job that has failed here, as this machine may lack what it needs.
void rest(std::chrono::seconds time) {
  for (const Clock::time_point end = Clock::now() + time; !stop_flag() && Clock::now() < end;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

Status work(const WorkOptions& options) {
  const Result<Worker> worker = worker_of(options.hub);
  if (!worker) return worker.error();
  const Result<std::unique_ptr<live::fleet::JobQueue>> queue = live::fleet::JobQueue::connect(worker->server);
  if (!queue) return queue.error();
  std::error_code failure;
  std::filesystem::current_path(options.folder, failure);
  if (failure) return bad_input(options.folder + ": " + failure.message());
  print_notice(
      fmt::format("{} works for {} (Ctrl-C ends it)", worker->name, live::fleet::without_password(options.hub)));
  int failures = 0;  // in a row
  while (!stop_flag()) {
    const Result<std::optional<live::fleet::TakenJob>> taken = (*queue)->take();
    if (!taken) {
      print_notice(taken.error().message);
      std::this_thread::sleep_for(kRetryAfter);
      continue;
    }
    if (!*taken) continue;
    const Clock::time_point begun = Clock::now();
    std::optional<live::fleet::JobOutcome> outcome = do_job(**queue, **taken, *worker);
    if (!outcome) return (*queue)->give_back(**taken);
    outcome->seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    if (!outcome->error.empty()) print_notice(fmt::format("{}: {}", outcome->name, outcome->error));
    finish(**queue, **taken, *outcome);
    const bool has_failed = !outcome->error.empty() && !outcome->is_final;
    failures = has_failed ? std::min(failures + 1, kMostRests) : 0;
    rest(failures * kRestAfterFailure);
  }
  return Done{};
}

}  // namespace

void add_work(Command& command) {
  auto options = std::make_shared<WorkOptions>();
  command.option("hub", options->hub, "nats://HOST of the hub").required();
  command.option("--folder", options->folder, "Where the files of the jobs are; no job leaves it").shows_default();
  command.action([options] { return work(*options); });
}

}  // namespace dermis::app
