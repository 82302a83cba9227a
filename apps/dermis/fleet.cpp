// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/chrono.h>
#include <fmt/core.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/live/fleet/hub.hpp"
#include "dermis/live/fleet/model_store.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "fleet_connection.hpp"
#include "fleet_robots.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr std::size_t kShownDigits = 8;  // of a SHA-256

struct AddOptions {
  std::string hub;
  std::vector<std::string> robots;
};

Status add(const AddOptions& options) {
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(options.hub);
  if (!hub) return hub.error();
  for (const std::string& robot : options.robots) {
    if (Status added = (*hub)->add_robot(robot); !added) return added;
    print_notice(fmt::format("{}: the hub keeps its frames", robot));
  }
  return Done{};
}

struct ModelOptions {
  std::string hub;
  std::string model;
  std::vector<std::string> arrays;  ///< "robot/array"
};

/// `use(store, robot, array)` for each array.
template <typename Use>
Status for_arrays(const ModelOptions& options, const Use& use) {
  std::vector<std::pair<std::string, std::string>> places;
  for (const std::string& text : options.arrays) {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) return bad_input(fmt::format("--for: '{}' must be ROBOT/ARRAY", text));
    places.emplace_back(text.substr(0, slash), text.substr(slash + 1));
    for (const std::string& name : {places.back().first, places.back().second}) {
      if (Status good = live::fleet::check_name("--for", name); !good) return good;
    }
  }
  const Result<std::unique_ptr<live::fleet::ModelStore>> store = connect_fleet<live::fleet::ModelStore>(options.hub);
  if (!store) return store.error();
  for (const auto& [robot, array] : places) {
    const Result<live::fleet::ModelManifest> manifest = use(**store, robot, array);
    if (!manifest) return manifest.error();
    const live::fleet::PushedModel& model = manifest->current_model();
    print_notice(fmt::format("{}/{}: is to use model {} ({}, {})", robot, array, model.number, model.name,
                             model.sha256.substr(0, kShownDigits)));
  }
  return Done{};
}

Status push(const ModelOptions& options) {
  if (options.model.ends_with(".toml")) return bad_input(options.model + ": is no model file; calibrate writes one");
  if (const auto model = bytes::models::read_model(options.model); !model) return model.error();
  const Result<std::string> bytes = bytes::files::read_file(options.model, live::fleet::ModelManifest::kMostBytes);
  if (!bytes) return bytes.error();
  const std::string name = std::filesystem::path(options.model).filename().string();
  return for_arrays(options, [&](live::fleet::ModelStore& store, const std::string& robot, const std::string& array) {
    return store.push(robot, array, name, *bytes);
  });
}

Status roll_back(const ModelOptions& options) {
  return for_arrays(options, [](live::fleet::ModelStore& store, const std::string& robot, const std::string& array) {
    return store.roll_back(robot, array);
  });
}

Status show_models(const std::string& text) {
  const Result<std::unique_ptr<live::fleet::ModelStore>> store = connect_fleet<live::fleet::ModelStore>(text);
  if (!store) return store.error();
  const Result<std::vector<live::fleet::ModelManifest>> manifests = (*store)->all();
  if (!manifests) return manifests.error();
  fmt::print("{:<24} {:>7} {:<8} {:>10} {:<20} {}\n", "robot/array", "number", "sha256", "kB", "pushed (UTC)", "model");
  for (const live::fleet::ModelManifest& manifest : *manifests) {
    for (const live::fleet::PushedModel& model : manifest.models) {
      const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(model.time).count();
      fmt::print("{:<24} {:>7} {} {:>10.1f} {:%Y-%m-%d %H:%M:%S}  {}\n", manifest.robot + "/" + manifest.array,
                 fmt::format("{}{}", model.number == manifest.current ? "*" : "", model.number),
                 model.sha256.substr(0, kShownDigits), static_cast<double>(model.bytes) / 1e3,
                 fmt::gmtime(static_cast<std::time_t>(seconds)), model.name);
    }
  }
  return Done{};
}

void require_hub(Command& command, std::string& hub) {
  command.option("hub", hub, "nats://HOST of the hub").required();
}

void add_model_commands(Command& command) {
  auto pushed = std::make_shared<ModelOptions>();
  Command push_command =
      command.subcommand("push", "Have robots use a model; each checks it and takes it while it works");
  require_hub(push_command, pushed->hub);
  push_command.input_file("model", pushed->model, "Model of 'dermis calibrate'").required();
  push_command.option("--for", pushed->arrays, "ROBOT/ARRAY; for each array").required();
  push_command.action([pushed] { return push(*pushed); });

  auto rolled = std::make_shared<ModelOptions>();
  Command back_command = command.subcommand("rollback", "Have robots use the model before their current one");
  require_hub(back_command, rolled->hub);
  back_command.option("--for", rolled->arrays, "ROBOT/ARRAY; for each array").required();
  back_command.action([rolled] { return roll_back(*rolled); });

  auto hub = std::make_shared<std::string>();
  Command models_command = command.subcommand("models", "The last models of each array; * marks the one in use");
  require_hub(models_command, *hub);
  models_command.action([hub] { return show_models(*hub); });
}

}  // namespace

void add_fleet(Command& command) {
  auto added = std::make_shared<AddOptions>();
  Command add_command = command.subcommand("add", "Have the hub keep the frames of robots");
  require_hub(add_command, added->hub);
  add_command.option("--robot", added->robots, "Its name; for each robot").required();
  add_command.action([added] { return add(*added); });

  add_fleet_list(command);
  add_fleet_page(command);

  add_model_commands(command);
}

}  // namespace dermis::app
