// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/live/fleet/model_manifest.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

class Broker;

/// SHA-256 as 64 small hexadecimal digits. Fails where the plugin is not there.
[[nodiscard]] Result<std::string> sha256(std::string_view bytes);

/// The models that a hub has for the arrays of its robots. A model is there whole or not at all: its pieces are stored
/// before the manifest that names them. Robots read through their own servers. Thread-safe.
class ModelStore {
 public:
  /// Fails where the plugin is not there, and where no server answers.
  [[nodiscard]] static Result<std::unique_ptr<ModelStore>> connect(const BrokerAddress& address);
  ModelStore(const ModelStore&) = delete;
  ModelStore& operator=(const ModelStore&) = delete;
  ~ModelStore();

  /// Stores a model file for an array, which is to use it; on a hub. Models that are no longer in the manifest are
  /// removed. One of two pushes to an array at the same time may be lost.
  [[nodiscard]] Result<ModelManifest> push(const std::string& robot, const std::string& array, const std::string& name,
                                           std::string_view bytes);
  /// The array is to use the model before its current one; on a hub.
  [[nodiscard]] Result<ModelManifest> roll_back(const std::string& robot, const std::string& array);
  /// For all arrays; on a hub. `unreadable` gets a line for each list that cannot be read, which costs no other.
  [[nodiscard]] Result<std::vector<ModelManifest>> all(std::vector<std::string>& unreadable);

  /// For an array, from the hub behind the server, or else the server itself; empty where there was no push. Failures
  /// are bad_input where what the hub has is wrong, else the hub cannot be reached.
  [[nodiscard]] Result<std::optional<ModelManifest>> manifest(const std::string& robot, const std::string& array);
  /// The bytes of the current model, whose SHA-256 is right. Fails as manifest() does.
  [[nodiscard]] Result<std::string> fetch(const ModelManifest& manifest);
  /// All fail at once from now on, as do those that wait.
  void stop();

 private:
  explicit ModelStore(std::unique_ptr<Broker> broker);
  [[nodiscard]] Result<std::string> read(const std::string& subject);
  [[nodiscard]] Status store(const std::string& subject, std::string_view bytes);
  [[nodiscard]] Status prepare_hub();
  [[nodiscard]] Status remove_unnamed(const ModelManifest& manifest);

  std::unique_ptr<Broker> broker_;
};

}  // namespace dermis::live::fleet
