// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/models/model_fit.hpp"
#include "dermis/live/fleet/frame_stream.hpp"
#include "dermis/live/fleet/hub.hpp"
#include "dermis/live/fleet/model_store.hpp"
#include "dermis/live/fleet/robot_condition.hpp"
#include "dermis/touch/frames/nearest_name.hpp"
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
  if (Status prepared = (*hub)->prepare(); !prepared) return prepared;
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

/// Robots and arrays.
using Places = std::vector<std::pair<std::string, std::string>>;

Result<Places> places_of(const ModelOptions& options) {
  Places places;
  for (const std::string& text : options.arrays) {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) return bad_input(fmt::format("--for: '{}' must be ROBOT/ARRAY", text));
    places.emplace_back(text.substr(0, slash), text.substr(slash + 1));
    for (const std::string& name : {places.back().first, places.back().second}) {
      if (const Status good = live::fleet::check_name("--for", name); !good) return good.error();
    }
  }
  return places;
}

/// `use(store, robot, array)` for each array.
template <typename Use>
Status for_arrays(const ModelOptions& options, const Places& places, const Use& use) {
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

using Robots = std::vector<live::fleet::RobotState>;

const live::fleet::RobotState* robot_of(const Robots& robots, const std::string& name) {
  const auto found = std::find_if(robots.begin(), robots.end(), [&](const auto& robot) { return robot.name == name; });
  return found == robots.end() ? nullptr : &*found;
}

const live::fleet::ArrayHealth* array_of(const live::fleet::RobotState* robot, const std::string& name) {
  if (robot == nullptr || !robot->health) return nullptr;
  const auto& arrays = robot->health->arrays;
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const auto& array) { return array.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

template <typename Named>
std::string names_of(const std::vector<Named>& all) {
  constexpr std::size_t kMostNames = 20;
  std::string names;
  for (std::size_t k = 0; k < std::min(all.size(), kMostNames); ++k) names += (k > 0 ? ", " : "") + all[k].name;
  return all.size() > kMostNames ? names + ", ..." : names;
}

/// Whether the model fits the array as its robot has described it in its stream.
Status check_fit(const live::fleet::BrokerAddress& hub, const std::string& robot, const std::string& array,
                 const ArrayDescription& of_model) {
  const auto stream =
      live::fleet::FrameStream::open({.text = robot + "/" + array, .broker = hub, .robot = robot, .array = array});
  if (!stream) return Done{};  // it has published no frame yet: the robot itself refuses
  const auto described = bytes::files::array_from_toml((*stream)->notes().array_toml, robot + "/" + array);
  const std::string why = described ? bytes::models::misfit(*described, of_model) : "";
  if (why.empty()) return Done{};
  return bad_input(fmt::format("--for: the model does not fit {}/{}: {}", robot, array, why));
}

/// Whether the array is known, and may use a model of this array. A hub that knows no robot yet knows no better.
Status check_place(const live::fleet::BrokerAddress& hub, const Robots& robots, const std::string& robot,
                   const std::string& array, const ArrayDescription& of_model) {
  const live::fleet::RobotState* const known = robot_of(robots, robot);
  if (known == nullptr && robots.empty()) {
    print_notice(fmt::format("{}: the hub knows no robot yet; the model waits for it", robot));
    return Done{};
  }
  if (known == nullptr) {
    return bad_input(fmt::format("--for: the hub knows no robot '{}'; it knows {}", robot, names_of(robots)));
  }
  if (!known->health) {
    print_notice(fmt::format("{}: it has not told its arrays yet; the model waits for '{}'", robot, array));
    return Done{};
  }
  const live::fleet::ArrayHealth* const present = array_of(known, array);
  if (present == nullptr) {
    return bad_input(
        fmt::format("--for: robot '{}' has no array '{}'; it has {}", robot, array, names_of(known->health->arrays)));
  }
  const FrameShape shape = present->shape;
  if (shape.rows == of_model.rows && shape.cols == of_model.cols) return check_fit(hub, robot, array, of_model);
  return bad_input(fmt::format("--for: the model is of {}x{} taxels, {}/{} has {}x{}; push one of its size",
                               of_model.rows, of_model.cols, robot, array, shape.rows, shape.cols));
}

Result<Robots> robots_of(const std::string& text) {
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(text);
  if (!hub) return hub.error();
  return (*hub)->robots();
}

Status push(const ModelOptions& options) {
  const Result<Places> places = places_of(options);
  if (!places) return places.error();
  if (options.model.ends_with(".toml")) return bad_input(options.model + ": is no model file; calibrate writes one");
  const auto model = bytes::models::read_model(options.model);
  if (!model) return model.error();
  const Result<std::string> bytes = bytes::files::read_file(options.model, live::fleet::ModelManifest::kMostBytes);
  if (!bytes) return bytes.error();
  const Result<Robots> robots = robots_of(options.hub);
  if (!robots) return robots.error();
  const Result<live::fleet::BrokerAddress> hub = live::fleet::parse_broker_address(options.hub);
  if (!hub) return hub.error();
  for (const auto& [robot, array] : *places) {
    if (Status good = check_place(*hub, *robots, robot, array, model->array); !good) return good;
  }
  const std::string name = std::filesystem::path(options.model).filename().string();
  return for_arrays(options, *places,
                    [&](live::fleet::ModelStore& store, const std::string& robot, const std::string& array) {
                      return store.push(robot, array, name, *bytes);
                    });
}

Status roll_back(const ModelOptions& options) {
  const Result<Places> places = places_of(options);
  if (!places) return places.error();
  return for_arrays(options, *places,
                    [](live::fleet::ModelStore& store, const std::string& robot, const std::string& array) {
                      return store.roll_back(robot, array);
                    });
}

/// "in use", "refused", "wanted", or "-": as the array has told last.
std::string use_of(const live::fleet::ArrayHealth* array, std::uint64_t number, std::uint64_t wanted) {
  if (array != nullptr && array->used_model == number) return "in use";
  if (number != wanted) return "-";
  const bool is_refused = array != nullptr && array->wanted_model == number && !array->refusal.empty();
  return is_refused ? "refused" : "wanted";
}

void print_models(const live::fleet::ModelManifest& manifest, const Robots& robots) {
  const live::fleet::RobotState* const robot = robot_of(robots, manifest.robot);
  const live::fleet::ArrayHealth* const array = array_of(robot, manifest.array);
  for (const live::fleet::PushedModel& model : manifest.models) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(model.time).count();
    const std::string use = use_of(array, model.number, manifest.current);
    fmt::print("{:<24} {:>7} {} {:>10.1f} {:%Y-%m-%d %H:%M:%S}  {:<10} {}\n", manifest.robot + "/" + manifest.array,
               fmt::format("{}{}", model.number == manifest.current ? "*" : "", model.number),
               model.sha256.substr(0, kShownDigits), static_cast<double>(model.bytes) / 1e3,
               fmt::gmtime(static_cast<std::time_t>(seconds)), use, model.name);
    if (use == "refused") fmt::print("  {}\n", live::fleet::model_use(*array));
  }
}

Status show_models(const std::string& text) {
  const Result<std::unique_ptr<live::fleet::ModelStore>> store = connect_fleet<live::fleet::ModelStore>(text);
  if (!store) return store.error();
  std::vector<std::string> unreadable;
  const Result<std::vector<live::fleet::ModelManifest>> manifests = (*store)->all(unreadable);
  if (!manifests) return manifests.error();
  for (const std::string& line : unreadable) print_notice(line + "; push a model to that array again");
  const Result<Robots> robots = robots_of(text);
  if (!robots) return robots.error();
  fmt::print("{:<24} {:>7} {:<8} {:>10} {:<20} {:<10} {}\n", "robot/array", "number", "sha256", "kB", "pushed (UTC)",
             "use", "model");
  for (const live::fleet::ModelManifest& manifest : *manifests) print_models(manifest, *robots);
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
  Command models_command =
      command.subcommand("models", "The last models of each array: * is the one to use; in use, or refused and why");
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
  add_fleet_history(command);
  add_fleet_page(command);
  add_fleet_watch(command);
  add_fleet_try(command);

  add_model_commands(command);
}

}  // namespace dermis::app
