// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "dermis/files/atomic_file.hpp"
#include "dermis/fleet/hub.hpp"
#include "dermis/fleet/job_queue.hpp"
#include "fleet_robots.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

struct InitOptions {
  fleet::FleetPlan plan;
  std::string out;
};

struct AddOptions {
  std::string hub;
  std::vector<std::string> robots;
};

/// A Hub or a JobQueue.
template <typename Served>
Result<std::unique_ptr<Served>> connect(const std::string& text) {
  const Result<fleet::BrokerAddress> address = fleet::parse_broker_address(text);
  if (!address) return address.error();
  return Served::connect(*address);
}

Status init(const InitOptions& options) {
  const auto files = fleet::server_files(options.plan);
  if (!files) return files.error();
  std::error_code failure;
  std::filesystem::create_directories(options.out, failure);
  if (failure) return bad_input(fmt::format("{}: {}", options.out, failure.message()));
  for (const auto& [name, text] : *files) {
    const std::string path = (std::filesystem::path(options.out) / name).string();
    if (std::filesystem::exists(path)) return bad_input(path + ": is there already");
    Result<files::AtomicFile> file = files::AtomicFile::create(path);
    if (!file) return file.error();
    file->write(text);
    if (Status written = file->commit(); !written) return written;
    print_notice("wrote " + path);
  }
  return Done{};
}

Status add(const AddOptions& options) {
  const Result<std::unique_ptr<fleet::Hub>> hub = connect<fleet::Hub>(options.hub);
  if (!hub) return hub.error();
  for (const std::string& robot : options.robots) {
    if (Status added = (*hub)->add_robot(robot); !added) return added;
    print_notice(fmt::format("{}: the hub keeps its frames", robot));
  }
  return Done{};
}

struct SubmitOptions {
  std::string hub;
  std::string jobs;
};

Status submit(const SubmitOptions& options) {
  const Result<std::vector<fleet::Job>> jobs = fleet::read_jobs(options.jobs);
  if (!jobs) return jobs.error();
  const Result<std::unique_ptr<fleet::JobQueue>> queue = connect<fleet::JobQueue>(options.hub);
  if (!queue) return queue.error();
  for (std::size_t i = 0; i < jobs->size(); ++i) {
    const Status submitted = (*queue)->submit((*jobs)[i]);
    if (submitted) continue;
    return failed(fmt::format("{} ({} of {} jobs were submitted)", submitted.error().message, i, jobs->size()));
  }
  print_notice(fmt::format("submitted {} jobs", jobs->size()));
  return Done{};
}

Status show_jobs(const std::string& text) {
  const Result<std::unique_ptr<fleet::JobQueue>> queue = connect<fleet::JobQueue>(text);
  if (!queue) return queue.error();
  const Result<fleet::JobCounts> counts = (*queue)->counts();
  if (!counts) return counts.error();
  fmt::print("waiting {}, taken {}, done {}, given up {}\n", counts->waiting, counts->taken, counts->done,
             counts->given_up);
  const Result<std::vector<fleet::JobOutcome>> given_up = (*queue)->given_up();
  if (!given_up) return given_up.error();
  for (const fleet::JobOutcome& outcome : *given_up) fmt::print("given up: {}: {}\n", outcome.name, outcome.error);
  return Done{};
}

void require_hub(Command& command, std::string& hub) {
  command.option("hub", hub, "nats://HOST of the hub").required();
}

}  // namespace

void add_fleet(Command& command) {
  auto made = std::make_shared<InitOptions>();
  Command init_command = command.subcommand("init", "Write the files of the servers of a fleet (nats-server)");
  init_command.option("--robot", made->plan.robots, "Its name; for each robot").required();
  init_command.option("--hub", made->plan.hub, "Name or address of the hub, as robots reach it").shows_default();
  init_command.option("--port", made->plan.port, "Of each server, for its clients").shows_default();
  init_command.option("--robots-port", made->plan.robots_port, "Of the hub, for the servers of robots").shows_default();
  init_command.option("--out", made->out, "Folder for the files").required();
  init_command.action([made] { return init(*made); });

  auto added = std::make_shared<AddOptions>();
  Command add_command = command.subcommand("add", "Have the hub keep the frames of robots");
  require_hub(add_command, added->hub);
  add_command.option("--robot", added->robots, "Its name; for each robot").required();
  add_command.action([added] { return add(*added); });

  add_fleet_list(command);
  add_fleet_page(command);

  auto submitted = std::make_shared<SubmitOptions>();
  Command submit_command = command.subcommand("submit", "Give jobs to the workers of a hub ('dermis work')");
  require_hub(submit_command, submitted->hub);
  submit_command.input_file("jobs", submitted->jobs, "jobs.toml (docs/fleet.md)").required();
  submit_command.action([submitted] { return submit(*submitted); });

  auto jobs_hub = std::make_shared<std::string>();
  Command jobs_command = command.subcommand("jobs", "How the jobs of a hub do");
  require_hub(jobs_command, *jobs_hub);
  jobs_command.action([jobs_hub] { return show_jobs(*jobs_hub); });
}

}  // namespace dermis::app
