// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// websocket::Server for the page that the module is part of: the same protocol, without sockets.
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bindings/browser/page_link.hpp"
#include "dermis/out/websocket/server.hpp"
#include "out/websocket/access.hpp"
#include "out/websocket/client.hpp"

namespace dermis {
namespace browser {
namespace {

PageLink* made_last = nullptr;

}  // namespace

PageLink* page_link() noexcept {
  return made_last;
}

}  // namespace browser

namespace out::websocket {

/// Nobody else reaches a page.
bool is_loopback(std::string_view /*host*/) {
  return true;
}

class Server::Implementation final : public browser::PageLink {
 public:
  Implementation(ServerOptions options, std::optional<PlaybackService> playback)
      : options_(std::move(options)), offer_{.playback = std::move(playback)} {
    browser::made_last = this;
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() override {
    if (browser::made_last == this) browser::made_last = nullptr;
  }

  void start(Handlers handlers, std::vector<Service> services) {
    offer_.handlers = std::move(handlers);
    offer_.services = std::move(services);
  }
  void stop() { client_.reset(); }
  ChannelId add_channel(std::string topic, std::string schema_name, std::string schema) {
    const auto id = static_cast<ChannelId>(channels_.size());
    channels_.push_back({id, std::move(topic), std::move(schema_name), std::move(schema)});
    subscribers_.push_back(0);
    if (client_) client_->advertise(channels_.back());
    return id;
  }
  void set_document(std::string path, std::string content) { documents_[std::move(path)] = std::move(content); }
  void set_file(std::string path, std::string file) { files_[std::move(path)] = std::move(file); }
  [[nodiscard]] bool has_subscribers(ChannelId channel) const { return subscribers_[channel] > 0; }
  [[nodiscard]] std::uint64_t subscriptions() const noexcept { return subscriptions_; }
  void publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message, MessageKind kind);
  /// Runs `send` for the client, if there is one.
  template <typename Send>
  void send(Send send) {
    if (client_) send(*client_);
  }
  void parameters_changed() {
    if (offer_.handlers.parameters) send([&](Client& client) { client.send_parameters(offer_.handlers.parameters()); });
  }
  [[nodiscard]] ServerStatistics statistics() const {
    ServerStatistics statistics = statistics_;
    statistics.clients = client_ ? 1 : 0;
    return statistics;
  }

  void connect() override;
  [[nodiscard]] Status receive(std::span<const std::uint8_t> bytes, bool is_text) override;
  [[nodiscard]] Status work() override;
  void tell(int level, std::string_view line) override {
    send([&](Client& client) { client.send_status(level, line); });
  }
  [[nodiscard]] std::optional<OutgoingMessage> next() override;
  [[nodiscard]] const std::string* document(const std::string& path) const override {
    const auto found = documents_.find(path);
    return found == documents_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] const std::string* file(const std::string& path) const override {
    const auto found = files_.find(path);
    return found == files_.end() ? nullptr : &found->second;
  }

 private:
  struct Published {
    ChannelId channel = 0;
    Nanos log_time{};
    SharedBytes bytes;
    MessageKind kind = MessageKind::event;
  };

  struct Received {
    std::vector<std::uint8_t> bytes;
    bool is_text = false;
  };

  /// Asks the question, which stays where there is no answer yet.
  void ask();
  /// Queues for the client all that was published since the last time.
  void hand_out();

  const ServerOptions options_;
  Offer offer_;
  std::vector<Channel> channels_;
  std::vector<int> subscribers_;  // [channel]
  std::uint64_t subscriptions_ = 0;
  ServerStatistics statistics_;
  std::map<std::string, std::string> documents_;
  std::map<std::string, std::string> files_;
  std::vector<Published> published_;  // that the client has not got yet
  std::deque<Received> received_;     // that the client said while its question waited
  Question question_;                 // of the client; empty: none waits for its answer
  std::optional<Client> client_;      // the last: it tells of its subscriptions when it goes
};

void Server::Implementation::publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message,
                                     MessageKind kind) {
  if (!client_ || !has_subscribers(channel)) return;
  published_.push_back(
      {channel, log_time, std::make_shared<const std::vector<std::uint8_t>>(message.begin(), message.end()), kind});
}

void Server::Implementation::hand_out() {
  if (!client_ || published_.empty()) return;
  for (const Published& one : std::exchange(published_, {})) {
    client_->publish(one.channel, one.log_time, one.bytes, one.kind, statistics_);
  }
}

void Server::Implementation::connect() {
  client_.reset();
  published_.clear();
  received_.clear();
  question_ = {};
  const auto changed = [this](ChannelId channel, int change) {
    if (channel < subscribers_.size()) subscribers_[channel] += change;
    if (change > 0) ++subscriptions_;
  };
  client_.emplace(offer_, "this page", true, options_.client_queue_bytes, changed, [this](Question question) {
    question_ = std::move(question);
    ask();
  });
  client_->greet(options_.name, "page", channels_);
}

Status Server::Implementation::receive(std::span<const std::uint8_t> bytes, bool is_text) {
  if (!client_) return Done{};
  if (!question_) return client_->receive(bytes, is_text);
  received_.push_back({{bytes.begin(), bytes.end()}, is_text});
  return Done{};
}

void Server::Implementation::ask() {
  const Answer answer = question_();
  if (!answer) return;
  question_ = {};
  answer(*client_);
}

Status Server::Implementation::work() {
  if (question_) ask();
  while (!question_ && !received_.empty()) {
    const Received next = std::move(received_.front());
    received_.pop_front();
    if (Status received = client_->receive(next.bytes, next.is_text); !received) return received;
  }
  return Done{};
}

std::optional<OutgoingMessage> Server::Implementation::next() {
  hand_out();
  if (!client_ || client_->queue().empty()) return std::nullopt;
  return client_->queue().pop();
}

Server::Server(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::create(const ServerOptions& options, std::vector<Asset> /*assets*/,
                                               std::optional<PlaybackService> playback) {
  return std::unique_ptr<Server>(new Server(std::make_unique<Implementation>(options, std::move(playback))));
}

std::uint16_t Server::port() const noexcept {
  return 0;
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

void Server::set_document(std::string path, std::string /*content_type*/, std::string content) {
  implementation_->set_document(std::move(path), std::move(content));
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
  implementation_->send([&](Client& client) { client.send_playback(status); });
}

void Server::status(int level, std::string_view message) {
  implementation_->send([&](Client& client) { client.send_status(level, message); });
}

ServerStatistics Server::statistics() const {
  return implementation_->statistics();
}

}  // namespace out::websocket
}  // namespace dermis
