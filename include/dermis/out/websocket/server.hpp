// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/playback.hpp"
#include "dermis/touch/frames/result.hpp"

/// HTTP and WebSocket on one port; the stream is the Foxglove WebSocket protocol (docs/stream.md).
namespace dermis::out::websocket {

/// A file of the viewer, served over HTTP to anybody. The bytes must outlive the server.
struct Asset {
  std::string_view path;  ///< "/index.html"; that one is also served as "/".
  std::string_view content_type;
  bool is_gzip = false;  ///< The bytes are compressed: sent with Content-Encoding: gzip.
  std::span<const std::uint8_t> bytes;
};

struct ServerOptions {
  std::string host = "127.0.0.1";  ///< Address to bind to; anything but loopback needs a token.
  std::uint16_t port = 8080;       ///< 0: any free one; see Server::port().
  /// Asked of every client for the stream and the documents, as ?token=... or Authorization: Bearer; empty: none.
  /// At least 8 letters, digits and "-._~", as it stands in URLs.
  std::string token;
  std::string name = "dermis";    ///< Told to clients.
  std::size_t most_clients = 64;  ///< Clients of the stream, 1 ... 1000; more are refused with 503.
  /// Per client; beyond it the oldest data messages are dropped. A client with as many bytes of waiting answers is cut
  /// off.
  std::size_t client_queue_bytes = 2U << 20U;
  std::function<void(const std::string&)> notice{};  ///< One line for the log; called on the server's thread.

  /// Only this machine can connect.
  [[nodiscard]] bool is_local() const;
  /// Names the first field that is out of its range, as "host: ...".
  [[nodiscard]] Status validate() const;
};

using ChannelId = std::uint32_t;

enum class MessageKind : std::uint8_t {
  event,    ///< Says what happened: who is behind gets it all the same.
  picture,  ///< How it is now: who is behind is better served by the next one.
  piece,    ///< A part of a picture: who is behind gets all pieces of a time or none.
};

/// The value of a parameter; monostate: not set.
using ParameterValue = std::variant<std::monostate, bool, double, std::string, std::vector<double>>;

struct Parameter {
  std::string name;  ///< "/contacts/onset_sigma"
  ParameterValue value;
};

/// Requests of clients to the owner. They are called one at a time, with the services and the playback, on a separate
/// thread. A slow one delays the answers to clients, but not the stream.
struct Handlers {
  /// All parameters as they are now.
  std::function<std::vector<Parameter>()> parameters{};
  /// Sets one for the client at an address, such as "127.0.0.1:53412"; the line of an error goes to the client and to
  /// the log.
  std::function<Status(const Parameter&, const std::string& client)> set_parameter{};
};

/// Asked until it has the response. Empty: not yet; ask again within 50 ms.
using Later = std::function<std::optional<Result<std::string>>()>;

/// A service that clients call with JSON and that answers with JSON.
struct Service {
  std::string name;  ///< "/calibration/start"
  /// Request in, response out.
  std::function<Result<std::string>(std::string_view request)> call{};
  /// In the place of `call`, where the response takes its time.
  std::function<Result<Later>(std::string_view request)> begin{};
};

/// The playback of a recording, which clients control.
struct PlaybackService {
  Nanos start{};  ///< Time of the first and of
  Nanos end{};    ///< the last frame.
  std::function<PlaybackStatus(const PlaybackCommand&)> control{};
};

struct ServerStatistics {
  std::size_t clients = 0;
  std::uint64_t messages = 0;  ///< Handed to clients.
  std::uint64_t dropped = 0;   ///< Data messages that a slow client did not get.
  std::uint64_t refused = 0;   ///< Connections: token, origin, subprotocol, too many; or they made room for others.
};

/// Serves the assets and streams channels to many clients, on a thread of its own. A client that is slow, sends garbage
/// or is silent does not affect the others. Its queue is bounded, and its oldest data are dropped. Bytes that are not
/// the protocol close its connection with one line in the log. Thread-safe.
class Server {
 public:
  /// Binds the port. If the port is in use or not permitted, the error says what to do.
  [[nodiscard]] static Result<std::unique_ptr<Server>> create(const ServerOptions& options, std::vector<Asset> assets,
                                                              std::optional<PlaybackService> playback = {});
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  /// Does the same as stop().
  ~Server();

  [[nodiscard]] std::uint16_t port() const noexcept;

  /// Begins to serve: from now on the handlers and services may be called. Call it once.
  void start(Handlers handlers = {}, std::vector<Service> services = {});

  /// Closes all connections; waits for the handler or service that is at work, and calls none from then on.
  void stop();

  /// Advertised to all clients, also to those that are connected. At most 4096.
  ChannelId add_channel(std::string topic, std::string schema_name, std::string schema);

  /// Sets the content of "/name.json" from now on. Unlike the assets, only clients with the token get it.
  void set_document(std::string path, std::string content_type, std::string content);

  /// "/recordings/a.mcap" is that file from now on, to be saved by a browser, with the token only. It is read when it
  /// is asked for; links are not followed.
  void set_file(std::string path, std::string file);

  [[nodiscard]] bool has_subscribers(ChannelId channel) const noexcept;

  /// How often a client has subscribed to a channel so far.
  [[nodiscard]] std::uint64_t subscriptions() const noexcept;

  /// Queues a message for all subscribers of the channel and returns at once; copies the bytes, once for all clients.
  /// Clients that report the pictures they have taken get only as many as they can take.
  void publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message,
               MessageKind kind = MessageKind::event);

  /// Tells the clients that follow them that parameters have changed.
  void parameters_changed();
  void playback_changed(const PlaybackStatus& status);
  /// A line that clients show to their users; level as Foxglove's: 0 info, 1 warning, 2 error.
  void status(int level, std::string_view message);

  [[nodiscard]] ServerStatistics statistics() const;

 private:
  class Implementation;
  explicit Server(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::out::websocket
