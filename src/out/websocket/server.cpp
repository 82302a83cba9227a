// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/websocket/server.hpp"

#include <atomic>
#include <boost/asio.hpp>
#include <cassert>
#include <list>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>  // Asio 1.74 forgets it

#include "out/websocket/access.hpp"
#include "out/websocket/budget.hpp"
#include "out/websocket/client.hpp"
#include "out/websocket/notice_limiter.hpp"
#include "out/websocket/session.hpp"
#include "out/websocket/site.hpp"

namespace dermis::out::websocket {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMostChannels = 4096;
constexpr std::size_t kMostWaitingBytes = 64U << 20U;  // published, not yet handed to the clients
constexpr std::size_t kMostVisitors = 64;              // connections that are no clients of the stream
constexpr std::size_t kMostAtOnce = 16;                // connections that are taken in a row
constexpr double kMostConnects = 1000;                 // in a second, after as many at once as there are visitors
constexpr double kMostUpgrades = 100;                  // in a second: a new client gets the list of all channels
constexpr double kMostUpgradesAtOnce = 16;

std::string random_session() {
  std::random_device device;
  constexpr const char* kDigits = "0123456789abcdef";
  std::string session;
  for (int i = 0; i < 16; ++i) session += kDigits[device() % 16U];
  return session;
}

Status in_use_or_forbidden(const ServerOptions& options, const error_code& error) {
  const std::string place = options.host + ":" + std::to_string(options.port);
  if (error == asio::error::address_in_use) {
    return failed("port " + std::to_string(options.port) + " is in use; choose another, or 0 for any");
  }
  if (error == asio::error::access_denied) {
    return failed("port " + std::to_string(options.port) + " needs rights that you do not have; choose one above 1023");
  }
  return failed("cannot serve on " + place + ": " + error.message());
}

struct Published {
  ChannelId channel = 0;
  Nanos log_time{};
  SharedBytes bytes;
  MessageKind kind = MessageKind::event;
};

}  // namespace

class Server::Implementation final : public SessionOwner {
 public:
  Implementation(ServerOptions options, std::vector<Asset> assets, std::optional<PlaybackService> playback)
      : options_(std::move(options)),
        offer_{.playback = std::move(playback)},
        site_(options_, std::move(assets)),
        notices_(options_.notice) {}
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() override { stop(); }

  Status listen();
  void start(Handlers handlers, std::vector<Service> services);
  void stop();
  [[nodiscard]] std::uint16_t port() const { return port_; }
  ChannelId add_channel(std::string topic, std::string schema_name, std::string schema);
  void set_document(std::string path, std::string content_type, std::string content) {
    site_.set_document(std::move(path), std::move(content_type), std::move(content));
  }
  void set_file(std::string path, std::string file) { site_.set_file(std::move(path), std::move(file)); }
  [[nodiscard]] bool has_subscribers(ChannelId channel) const {
    return subscriptions_.now[channel].load(std::memory_order_relaxed) > 0;
  }
  [[nodiscard]] std::uint64_t subscriptions() const noexcept {
    return subscriptions_.so_far.load(std::memory_order_relaxed);
  }
  void publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message, MessageKind kind);

  /// Runs `send` for each client, on the server's thread.
  template <typename Send>
  void send_to_clients(Send send);
  void parameters_changed();
  [[nodiscard]] ServerStatistics statistics() const;

  [[nodiscard]] const Site& site() const override { return site_; }
  [[nodiscard]] bool enter(const std::shared_ptr<Session>& session) override;
  [[nodiscard]] Budget::Clock::time_point turn() override;
  [[nodiscard]] std::unique_ptr<Client> make_client(const std::string& peer, bool is_sdk, Ask ask) override;
  [[nodiscard]] asio::thread_pool& desk() override { return desk_; }
  void leave(const std::shared_ptr<Session>& session) override;
  void on_refused(const std::string& line) override;
  void on_cut(const std::string& line) override { notices_.notify("cut", line); }

 private:
  /// Between the owner's threads and the server's.
  struct Shared {
    mutable std::mutex mutex;  // guards the others
    std::vector<Channel> channels;
    std::vector<Published> waiting;
    std::size_t waiting_bytes = 0;
    ServerStatistics statistics;
  };

  /// Who is connected; of the server's thread.
  struct Connected {
    std::list<std::shared_ptr<Session>> visitors;  // the oldest first
    std::set<std::shared_ptr<Session>> clients;
  };

  /// Where connections come in.
  struct Door {
    explicit Door(asio::io_context& context) : acceptor(context), pause(context) {}
    tcp::acceptor acceptor;
    asio::steady_timer pause;
    Budget connects{kMostVisitors, kMostConnects};
    Budget upgrades{kMostUpgradesAtOnce, kMostUpgrades};
  };

  struct Subscriptions {
    std::vector<std::atomic<int>> now = std::vector<std::atomic<int>>(kMostChannels);  // [channel]
    std::atomic<std::uint64_t> so_far = 0;
  };

  void accept();
  void accept_waiting();
  void accept_at(Budget::Clock::time_point time);
  void admit(tcp::socket socket);
  void hand_out();
  void change_subscribers(ChannelId channel, int change);
  [[nodiscard]] std::vector<Channel> channels() const;
  void count_clients();
  void count(const ServerStatistics& more);

  const ServerOptions options_;
  Offer offer_;  // Complete when the server starts.
  Site site_;
  const std::string session_name_ = random_session();
  Subscriptions subscriptions_;  // outlives the sessions that the context still holds
  std::atomic<bool> parameters_pending_{false};
  asio::io_context context_{1};
  asio::thread_pool desk_{1};  // the owner's handlers and services run here, one at a time as promised
  Door door_{context_};
  std::uint16_t port_ = 0;
  Connected connected_;
  NoticeLimiter notices_;

  Shared shared_;
  std::thread thread_;
};

Status Server::Implementation::listen() {
  error_code error;
  const tcp::endpoint endpoint(asio::ip::make_address(numeric_address(options_.host), error), options_.port);
  if (!error) door_.acceptor.open(endpoint.protocol(), error);
  if (!error) door_.acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) door_.acceptor.bind(endpoint, error);
  if (!error) door_.acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) door_.acceptor.non_blocking(true, error);
  if (error) return in_use_or_forbidden(options_, error);
  port_ = door_.acceptor.local_endpoint(error).port();
  return Done{};
}

void Server::Implementation::start(Handlers handlers, std::vector<Service> services) {
  offer_.handlers = std::move(handlers);
  offer_.services = std::move(services);
  accept();
  thread_ = std::thread([this] { context_.run(); });
}

void Server::Implementation::stop() {
  context_.stop();
  if (thread_.joinable()) thread_.join();
  desk_.stop();
  desk_.join();
}

void Server::Implementation::accept() {
  door_.acceptor.async_wait(tcp::acceptor::wait_read, [this](const error_code& error) {
    if (!error) accept_waiting();
  });
}

/// Accepts several at a time: with many newcomers, one for each round of other work would keep the last waiting long.
/// Who comes back without end waits in the queue of the system, so that the streams have the time of this thread.
void Server::Implementation::accept_waiting() {
  error_code error;
  for (std::size_t i = 0; i < kMostAtOnce && !error; ++i) {
    if (door_.connects.free_at() > Budget::Clock::now()) return accept_at(door_.connects.free_at());
    tcp::socket socket(context_);
    door_.acceptor.accept(socket, error);
    if (error) break;
    door_.connects.spend(1);
    admit(std::move(socket));
  }
  if (!error || error == asio::error::would_block) return accept();
  notices_.notify("accept", "cannot take a connection: " + error.message());
  accept_at(Budget::Clock::now() + std::chrono::milliseconds(100));
}

void Server::Implementation::accept_at(Budget::Clock::time_point time) {
  door_.pause.expires_at(time);
  door_.pause.async_wait([this](const error_code&) { accept(); });
}

/// A silent or slow peer has to make room: a new connection is always taken.
void Server::Implementation::admit(tcp::socket socket) {
  if (connected_.visitors.size() >= kMostVisitors) {
    notices_.notify(
        "many", "more than " + std::to_string(kMostVisitors) + " connections beside the stream's: the oldest closed");
    count({.refused = 1});
    const std::shared_ptr<Session> oldest = connected_.visitors.front();
    oldest->end();
  }
  connected_.visitors.push_back(std::make_shared<Session>(*this, std::move(socket)));
  connected_.visitors.back()->start();
}

bool Server::Implementation::enter(const std::shared_ptr<Session>& session) {
  if (connected_.clients.size() >= options_.most_clients) return false;
  connected_.visitors.remove(session);
  connected_.clients.insert(session);
  count_clients();
  return true;
}

Budget::Clock::time_point Server::Implementation::turn() {
  const Budget::Clock::time_point free = door_.upgrades.free_at();
  door_.upgrades.spend(1);
  return free;
}

std::unique_ptr<Client> Server::Implementation::make_client(const std::string& peer, bool is_sdk, Ask ask) {
  const auto changed = [this](ChannelId channel, int change) { change_subscribers(channel, change); };
  auto client = std::make_unique<Client>(offer_, peer, is_sdk, options_.client_queue_bytes, changed, std::move(ask));
  client->greet(options_.name, session_name_, channels());
  return client;
}

void Server::Implementation::leave(const std::shared_ptr<Session>& session) {
  connected_.visitors.remove(session);
  connected_.clients.erase(session);
  count_clients();
}

void Server::Implementation::on_refused(const std::string& line) {
  notices_.notify("refused", line);
  count({.refused = 1});
}

ChannelId Server::Implementation::add_channel(std::string topic, std::string schema_name, std::string schema) {
  Channel channel;
  {
    const std::lock_guard lock(shared_.mutex);
    assert(shared_.channels.size() < kMostChannels);
    channel = {static_cast<ChannelId>(shared_.channels.size()), std::move(topic), std::move(schema_name),
               std::move(schema)};
    shared_.channels.push_back(channel);
  }
  send_to_clients([channel](Client& client) { client.advertise(channel); });
  return channel.id;
}

std::vector<Channel> Server::Implementation::channels() const {
  const std::lock_guard lock(shared_.mutex);
  return shared_.channels;
}

void Server::Implementation::change_subscribers(ChannelId channel, int change) {
  if (channel < kMostChannels) subscriptions_.now[channel].fetch_add(change, std::memory_order_relaxed);
  if (change > 0) subscriptions_.so_far.fetch_add(1, std::memory_order_relaxed);
}

void Server::Implementation::publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message,
                                     MessageKind kind) {
  if (!has_subscribers(channel)) return;
  Published published{channel, log_time,
                      std::make_shared<const std::vector<std::uint8_t>>(message.begin(), message.end()), kind};
  {
    const std::lock_guard lock(shared_.mutex);
    if (shared_.waiting_bytes + message.size() > kMostWaitingBytes) {
      ++shared_.statistics.dropped;
      return;
    }
    shared_.waiting_bytes += message.size();
    shared_.waiting.push_back(std::move(published));
    if (shared_.waiting.size() > 1) return;  // the server's thread knows already
  }
  asio::post(context_, [this] { hand_out(); });
}

void Server::Implementation::hand_out() {
  std::vector<Published> published;
  {
    const std::lock_guard lock(shared_.mutex);
    published.swap(shared_.waiting);
    shared_.waiting_bytes = 0;
  }
  ServerStatistics handed;
  const auto sessions = std::vector(connected_.clients.begin(), connected_.clients.end());
  for (const auto& session : sessions) {
    if (session->client() == nullptr) continue;  // its handshake goes on
    for (const Published& message : published) {
      session->client()->publish(message.channel, message.log_time, message.bytes, message.kind, handed);
    }
    session->flush();
  }
  count(handed);
}

template <typename Send>
void Server::Implementation::send_to_clients(Send send) {
  asio::post(context_, [this, send = std::move(send)] {
    const auto sessions = std::vector(connected_.clients.begin(), connected_.clients.end());
    for (const auto& session : sessions) {
      if (session->client() == nullptr) continue;
      send(*session->client());
      session->flush();
    }
  });
}

/// Once, however many have changed until then.
void Server::Implementation::parameters_changed() {
  if (!offer_.handlers.parameters || parameters_pending_.exchange(true)) return;
  asio::post(desk_, [this] {
    parameters_pending_ = false;
    send_to_clients([all = offer_.handlers.parameters()](Client& client) { client.send_parameters(all); });
  });
}

void Server::Implementation::count_clients() {
  const std::lock_guard lock(shared_.mutex);
  shared_.statistics.clients = connected_.clients.size();
}

void Server::Implementation::count(const ServerStatistics& more) {
  const std::lock_guard lock(shared_.mutex);
  shared_.statistics.messages += more.messages;
  shared_.statistics.dropped += more.dropped;
  shared_.statistics.refused += more.refused;
}

ServerStatistics Server::Implementation::statistics() const {
  const std::lock_guard lock(shared_.mutex);
  return shared_.statistics;
}

Server::Server(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::create(const ServerOptions& options, std::vector<Asset> assets,
                                               std::optional<PlaybackService> playback) {
  if (Status valid = options.validate(); !valid) return valid.error();
  auto implementation = std::make_unique<Implementation>(options, std::move(assets), std::move(playback));
  if (Status listening = implementation->listen(); !listening) return listening.error();
  return std::unique_ptr<Server>(new Server(std::move(implementation)));
}

std::uint16_t Server::port() const noexcept {
  return implementation_->port();
}

void Server::start(Handlers handlers, std::vector<Service> services) {
  implementation_->start(std::move(handlers), std::move(services));
}

void Server::stop() {
  implementation_->stop();
}

ChannelId Server::add_channel(std::string topic, std::string schema_name, std::string schema) {
  return implementation_->add_channel(std::move(topic), std::move(schema_name), std::move(schema));
}

void Server::set_document(std::string path, std::string content_type, std::string content) {
  implementation_->set_document(std::move(path), std::move(content_type), std::move(content));
}

void Server::set_file(std::string path, std::string file) {
  implementation_->set_file(std::move(path), std::move(file));
}

bool Server::has_subscribers(ChannelId channel) const noexcept {
  return implementation_->has_subscribers(channel);
}

std::uint64_t Server::subscriptions() const noexcept {
  return implementation_->subscriptions();
}

void Server::publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message, MessageKind kind) {
  implementation_->publish(channel, log_time, message, kind);
}

void Server::parameters_changed() {
  implementation_->parameters_changed();
}

void Server::playback_changed(const PlaybackStatus& status) {
  implementation_->send_to_clients([status](Client& client) { client.send_playback(status); });
}

void Server::status(int level, std::string_view message) {
  implementation_->send_to_clients(
      [level, line = std::string(message)](Client& client) { client.send_status(level, line); });
}

ServerStatistics Server::statistics() const {
  return implementation_->statistics();
}

}  // namespace dermis::out::websocket
