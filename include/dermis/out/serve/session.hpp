// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/dds/publisher.hpp"
#include "dermis/live/fleet/frame_publisher.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

struct SessionOptions {
  /// `notice` must be thread-safe: it gets lines of arrays and recordings, too.
  websocket::ServerOptions server{};
  std::vector<websocket::Asset> page{};  ///< The page for browsers; empty: there is the stream alone.
  /// A recording to begin with, .mcap; those that clients begin take their names from it. Empty: none.
  std::string record{};
  /// A recording in whose folder and with whose name clients record; empty: those of `record`.
  std::string recordings{};
  std::optional<live::dds::PublisherOptions> dds{};        ///< Topics for nodes of ROS 2 (docs/ros.md); empty: none.
  std::optional<live::fleet::PublisherOptions> publish{};  ///< Frames for a fleet (docs/fleet.md); empty: none.
};

/// A suit at work and the server that shows it.
class Session {
 public:
  /// Binds the port and begins to answer clients. Fails where the arrays cannot work, and as websocket::Server and the
  /// recording do.
  [[nodiscard]] static Result<std::unique_ptr<Session>> create(ServedSuit suit, const SessionOptions& options = {});
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session();

  [[nodiscard]] std::uint16_t port() const noexcept;

  /// Runs all arrays until `stop` is set, which must end sources that wait, too; a recording is complete then. Fails
  /// where it could not be written. Call it once.
  [[nodiscard]] Status run(const std::atomic<bool>& stop);

  /// In the place of run(), where there is one thread: does what is due now. Call it again and again, at least 30 times
  /// a second.
  void work();

 private:
  class Implementation;
  explicit Session(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::out::serve
