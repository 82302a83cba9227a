// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "child_process.hpp"
#include "commands.hpp"
#include "dermis/fleet/job_queue.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{2};
constexpr std::chrono::seconds kExtendEvery{5};
constexpr std::chrono::seconds kRetryAfter{1};

struct WorkOptions {
  std::string hub;
  std::string folder = ".";
};

std::string name_of_worker() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}-{}", host.data(), ::getpid());
}

/// Does the job in a process of its own, in the current folder; an empty text, or what went wrong. An output that is
/// there is of an earlier try.
std::string do_job(fleet::JobQueue& queue, const fleet::TakenJob& taken) {
  std::vector<std::string> command = {std::filesystem::read_symlink("/proc/self/exe").string()};
  command.insert(command.end(), taken.job.words.begin(), taken.job.words.end());
  command.emplace_back("--force");
  Result<ChildProcess> child = ChildProcess::start(command);
  if (!child) return child.error().message;
  Clock::time_point extended = Clock::now();
  std::optional<int> status;
  while (!(status = child->exit_status())) {
    if (stop_flag()) return "its worker was stopped";
    std::this_thread::sleep_for(kLook);
    if (Clock::now() - extended < kExtendEvery) continue;
    static_cast<void>(queue.extend(taken));
    extended = Clock::now();
  }
  return *status == 0 ? "" : fmt::format("exit status {}", *status);
}

/// Tries until the server has it: a job that was done is not to be done again.
void finish(fleet::JobQueue& queue, const fleet::TakenJob& taken, const fleet::JobOutcome& outcome) {
  for (Status told = queue.finish(taken, outcome); !told && !stop_flag(); told = queue.finish(taken, outcome)) {
    print_notice(told.error().message);
    std::this_thread::sleep_for(kRetryAfter);
  }
}

Status work(const WorkOptions& options) {
  const Result<fleet::BrokerAddress> address = fleet::parse_broker_address(options.hub);
  if (!address) return address.error();
  std::error_code failure;
  std::filesystem::current_path(options.folder, failure);
  if (failure) return bad_input(options.folder + ": " + failure.message());
  const Result<std::unique_ptr<fleet::JobQueue>> queue = fleet::JobQueue::connect(*address);
  if (!queue) return queue.error();
  const std::string worker = name_of_worker();
  print_notice(fmt::format("{} works for {} (Ctrl-C ends it)", worker, options.hub));
  while (!stop_flag()) {
    const Result<std::optional<fleet::TakenJob>> taken = (*queue)->take();
    if (!taken) {
      print_notice(taken.error().message);
      std::this_thread::sleep_for(kRetryAfter);
      continue;
    }
    if (!*taken) continue;
    const Clock::time_point begun = Clock::now();
    const std::string error = do_job(**queue, **taken);
    const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    if (!error.empty()) print_notice(fmt::format("{}: {}", (*taken)->job.name, error));
    if (stop_flag()) break;  // the lease ends, and another has the job
    finish(**queue, **taken, {(*taken)->job.name, worker, seconds, error});
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
