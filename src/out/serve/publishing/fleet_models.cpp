// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/live/fleet/model_store.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/publishing/kept_models.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::chrono::seconds kLookEvery{5};
constexpr std::size_t kShownDigits = 8;

/// Takes models for the arrays from the hub of a fleet: looks for them on a thread of its own, uses them in a tick.
class FleetModels final : public Part {
 public:
  FleetModels(Host& host, live::fleet::PublisherOptions options);

  /// Those that were in use when the robot was on last.
  void use_kept();

  [[nodiscard]] Status prepare() override;
  void tick(std::int64_t tick) override;
  void model_changed(std::size_t array) override;
  void diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const override;
  void report(live::fleet::RobotHealth& health) const override;
  void finish() override { thread_.request_stop(); }

 private:
  struct Fetched {
    live::fleet::PushedModel pushed;
    std::shared_ptr<const touch::pipeline::Model> model;
  };
  struct Array {
    Array(std::string its_name, KeptModels its_kept) : name(std::move(its_name)), kept(std::move(its_kept)) {}

    const std::string name;
    const KeptModels kept;
    live::fleet::PushedModel used{};     ///< The last one that was usable. It and the next belong to the thread.
    live::fleet::PushedModel refused{};  ///< Not asked for again.
    std::optional<Fetched> waiting{};    ///< For a tick. This and all below are guarded by `mutex_`.
    std::uint64_t wanted = 0;            ///< Number of the model that the fleet wants; 0: not known.
    std::uint64_t in_use = 0;            ///< Number of a model of the fleet; 0: none is.
    std::string used_name{};             ///< Of its file.
    std::string refusal{};               ///< Why the newest one is not in use; empty: it is, or will be.
    Nanos refused_at{};                  ///< By UTC.
  };

  void work(const std::stop_token& stop);
  void look(const std::stop_token& stop);
  [[nodiscard]] Status look_for(Array& array);
  [[nodiscard]] Result<std::shared_ptr<const touch::pipeline::Model>> obtain(
      const Array& array, const live::fleet::ModelManifest& manifest);
  [[nodiscard]] bool use(std::size_t array, const Fetched& fetched);
  void want(Array& array, std::uint64_t number);
  void refuse(Array& array, const std::string& why);

  Host& host_;
  const live::fleet::PublisherOptions options_;
  std::deque<Array> arrays_;
  mutable std::mutex mutex_;
  std::unique_ptr<live::fleet::ModelStore>
      store_;  ///< Null: no server has answered yet. Made by the thread under `mutex_`.
  std::jthread thread_;
};

FleetModels::FleetModels(Host& host, live::fleet::PublisherOptions options)
    : host_(host), options_(std::move(options)) {
  for (const ServedArray& array : host.suit.arrays) {
    const std::filesystem::path beside = std::filesystem::path(array.model_path).parent_path();
    arrays_.emplace_back(array.name,
                         KeptModels(beside / "dermis-models" / options_.robot / array.name, array.description));
  }
}

void FleetModels::use_kept() {
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    Array& array = arrays_[k];
    const auto manifest = array.kept.manifest();
    if (manifest && !*manifest) continue;
    if (!manifest) {
      refuse(array, manifest.error().message);
      continue;
    }
    const live::fleet::PushedModel& pushed = (*manifest)->current_model();
    want(array, pushed.number);
    const auto model = array.kept.read(pushed);
    if (!model) {
      refuse(array, "that was in use: " + model.error().message);
    } else if (use(k, {pushed, *model})) {
      array.used = pushed;
    }
  }
}

Status FleetModels::prepare() {
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
  return Done{};
}

void FleetModels::work(const std::stop_token& stop) {
  const std::stop_callback stops_waiting(stop, [this] {
    const std::lock_guard lock(mutex_);
    if (store_) store_->stop();
  });
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  while (!stop.stop_requested()) {
    look(stop);
    stopped.wait_for(lock, stop, kLookEvery, [] { return false; });
  }
}

/// Without a hub nothing changes.
void FleetModels::look(const std::stop_token& stop) {
  if (!store_) {
    Result<std::unique_ptr<live::fleet::ModelStore>> connected = live::fleet::ModelStore::connect(options_.broker);
    if (!connected) return;
    const std::lock_guard lock(mutex_);
    store_ = *std::move(connected);
  }
  for (Array& array : arrays_) {
    if (stop.stop_requested() || !look_for(array)) return;
  }
}

/// Fails where the hub cannot be reached.
Status FleetModels::look_for(Array& array) {
  const auto manifest = store_->manifest(options_.robot, array.name);
  if (!manifest && manifest.error().kind == ErrorKind::failed) return manifest.error();
  if (!manifest) {
    refuse(array, manifest.error().message);
    return Done{};
  }
  if (!*manifest) return Done{};
  const live::fleet::PushedModel& pushed = (*manifest)->current_model();
  want(array, pushed.number);
  if (pushed == array.refused) return Done{};
  if (pushed == array.used) {
    const std::lock_guard lock(mutex_);
    array.refusal.clear();
    return Done{};
  }
  auto model = obtain(array, **manifest);
  if (!model && model.error().kind == ErrorKind::failed) return model.error();
  if (!model) {
    array.refused = pushed;
    refuse(array, model.error().message);
    return Done{};
  }
  array.used = pushed;
  const std::lock_guard lock(mutex_);
  array.waiting = {pushed, *std::move(model)};
  return Done{};
}

/// The current model, from the robot's disk or from the hub. It is on the disk then, also for the next start.
Result<std::shared_ptr<const touch::pipeline::Model>> FleetModels::obtain(const Array& array,
                                                                          const live::fleet::ModelManifest& manifest) {
  const live::fleet::PushedModel& pushed = manifest.current_model();
  auto model = array.kept.read(pushed);
  if (!model) {
    const Result<std::string> bytes = store_->fetch(manifest);
    if (!bytes) return bytes.error();
    if (const Status written = array.kept.write(pushed, *bytes); !written) return bad_input(written.error().message);
    model = array.kept.read(pushed);
  }
  if (!model) {
    array.kept.remove(pushed);
    return bad_input(model.error().message);
  }
  if (const Status used = array.kept.use(manifest); !used) return bad_input(used.error().message);
  return model;
}

void FleetModels::tick(std::int64_t /*tick*/) {
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    std::optional<Fetched> fetched;
    {
      const std::lock_guard lock(mutex_);
      fetched = std::exchange(arrays_[k].waiting, std::nullopt);
    }
    if (fetched) static_cast<void>(use(k, *fetched));
  }
}

bool FleetModels::use(std::size_t array, const Fetched& fetched) {
  const live::fleet::PushedModel& pushed = fetched.pushed;
  if (const Status used = host_.use_model(array, fetched.model); !used) {
    refuse(arrays_[array], used.error().message);
    return false;
  }
  {
    const std::lock_guard lock(mutex_);
    arrays_[array].in_use = pushed.number;
    arrays_[array].used_name = pushed.name;
    arrays_[array].refusal.clear();
  }
  host_.notify(fmt::format("{}: model {} of the fleet is in use ({}, {})", arrays_[array].name, pushed.number,
                           pushed.name, pushed.sha256.substr(0, kShownDigits)));
  return true;
}

void FleetModels::refuse(Array& array, const std::string& why) {
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    if (array.refusal == why) return;
    array.refusal = why;
    array.refused_at = std::chrono::system_clock::now().time_since_epoch();
    number = array.wanted;
  }
  host_.tell_error(fmt::format("{}: model of the fleet: {}{}", array.name,
                               number > 0 ? fmt::format("{} is refused: ", number) : "", why));
}

/// The fleet wants this model. Another one is no longer refused.
void FleetModels::want(Array& array, std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  if (std::exchange(array.wanted, number) != number) array.refusal.clear();
}

/// The model may be of a calibration here; use() knows better afterwards.
void FleetModels::model_changed(std::size_t array) {
  const std::lock_guard lock(mutex_);
  arrays_[array].in_use = 0;
}

void FleetModels::report(live::fleet::RobotHealth& health) const {
  using Level = live::fleet::ArrayHealth::Level;
  const std::lock_guard lock(mutex_);
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    live::fleet::ArrayHealth& array = health.arrays[k];
    array.wanted_model = arrays_[k].wanted;
    array.used_model = arrays_[k].in_use;
    if (array.used_model > 0) array.model = arrays_[k].used_name;
    array.refusal = arrays_[k].refusal;
    if (array.refusal.empty()) continue;
    array.refused = arrays_[k].refused_at;
    if (array.level != Level::good) continue;
    array.level = Level::warning;
    array.message.clear();  // the refusal says it
  }
}

void FleetModels::diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const {
  bytes::ros_messages::Diagnosis diagnosis;
  diagnosis.name = "models of the fleet";
  diagnosis.message = "models of the fleet are in use where there are some";
  const std::lock_guard lock(mutex_);
  for (const Array& array : arrays_) {
    if (array.in_use > 0) diagnosis.values.emplace_back(array.name, std::to_string(array.in_use));
    if (array.refusal.empty()) continue;
    diagnosis.level = bytes::ros_messages::Diagnosis::Level::warning;
    diagnosis.message = "the newest model of the fleet is refused";
    diagnosis.values.emplace_back(array.name + ", refused", array.refusal);
  }
  diagnoses.push_back(std::move(diagnosis));
}

}  // namespace

Result<std::unique_ptr<Part>> make_fleet_models(Host& host) {
  if (!host.options.publish) return std::unique_ptr<Part>();
  auto part = std::make_unique<FleetModels>(host, *host.options.publish);
  part->use_kept();
  return std::unique_ptr<Part>(std::move(part));
}

}  // namespace dermis::out::serve
