// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/out/serve/session.hpp"
#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/parts/part_list.hpp"
#include "out/serve/suit/models_in_use.hpp"

namespace dermis::out::serve {

class MarkBook;
class SuitRecorder;
class Topics;

/// The objects that all parts of a server use. Requests of a part to all parts go through here. Thread-safe as its
/// members are; they outlive it.
struct Host {
  ServedSuit& suit;
  const SessionOptions options;
  ModelsInUse& models;
  websocket::Server& server;
  live::suits::LiveSuit& live;
  Topics& topics;
  SuitRecorder& recorder;
  MarkBook& marks;
  PartList& parts;
  std::unique_ptr<std::mutex> changing =
      std::make_unique<std::mutex>();  ///< One change of models and classes at a time.
  const Nanos utc_minus_steady =
      std::chrono::system_clock::now().time_since_epoch() - std::chrono::steady_clock::now().time_since_epoch();

  /// Takes a model into use for an array, and notifies all parts and clients.
  [[nodiscard]] Status use_model(std::size_t array, const std::shared_ptr<const touch::pipeline::Model>& model);
  [[nodiscard]] Status use_classes(std::size_t array, learn::recognition::Classes classes);

  /// /suit.json, as the suit is now.
  void show_suit() const;

  /// By the clock of the recording that is played, else by that of the frames. When the clock of the machine is set,
  /// it does not follow.
  [[nodiscard]] Nanos now() const;

  void log(const std::string& line) const;
  /// The log and all clients.
  void tell_error(const std::string& line) const;
  void notify(const std::string& line) const;
};

/// Makes a part; nothing where the suit has no use for it. Errors end the session.
using PartMaker = Result<std::unique_ptr<Part>>(Host& host);

}  // namespace dermis::out::serve
