// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/stream/server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <cassert>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>  // Asio 1.74 forgets it

#include "stream/access.hpp"
#include "stream/client.hpp"
#include "stream/notice_limiter.hpp"

namespace dermis::stream {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using std::chrono::seconds;

constexpr std::size_t kMostChannels = 4096;
constexpr std::size_t kMostWaitingBytes = 64U << 20U;  // published, not yet handed to the clients
constexpr std::size_t kMostControlBytes = 16U << 20U;  // of a client that asks and does not read
constexpr std::size_t kMostMessageBytes = 1U << 20U;   // from a client
constexpr std::uint32_t kMostHeaderBytes = 8192;
constexpr std::size_t kShortestToken = 8;
constexpr int kMostRequests = 200;         // of a client in a second; the next has to wait
constexpr std::size_t kMostRefusals = 32;  // connections that are told so at the same time
constexpr int kSendBuffer = 256 << 10;     // [bytes]; what waits there cannot be dropped any more
constexpr seconds kRequestTime{10};
constexpr seconds kIdleTime{30};

constexpr const char* kContentSecurityPolicy =
    "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
    "frame-ancestors 'none'";

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

std::string random_session() {
  std::random_device device;
  constexpr const char* kDigits = "0123456789abcdef";
  std::string session;
  for (int i = 0; i < 16; ++i) session += kDigits[device() % 16U];
  return session;
}

Response make_response(const Request& request, http::status status, std::string_view type, std::string body) {
  Response response(status, request.version());
  response.set(http::field::server, "dermis");
  response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Content-Security-Policy", kContentSecurityPolicy);
  response.set("Referrer-Policy", "no-referrer");
  response.set(http::field::cache_control, "no-cache");
  response.keep_alive(request.keep_alive());
  response.content_length(body.size());
  if (request.method() != http::verb::head) response.body() = std::move(body);
  return response;
}

Response make_refusal(const Request& request, http::status status, const std::string& line) {
  return make_response(request, status, "text/plain; charset=utf-8", line + "\n");
}

Status in_use_or_forbidden(const ServerOptions& options, const error_code& error) {
  const std::string place = options.host + ":" + std::to_string(options.port);
  if (error == asio::error::address_in_use) {
    return failed("port " + std::to_string(options.port) + " is in use; choose another with --port, or 0 for any");
  }
  if (error == asio::error::access_denied) {
    return failed("port " + std::to_string(options.port) + " needs rights that you do not have; choose one above 1023");
  }
  return failed("cannot serve on " + place + ": " + error.message());
}

struct Document {
  std::string content_type;
  std::string content;
};

struct Published {
  ChannelId channel = 0;
  Nanos log_time{};
  SharedBytes bytes;
};

}  // namespace

Status ServerOptions::validate() const {
  if (!is_address(host)) return bad_input("--host: '" + host + "' is no address; give one like 127.0.0.1 or 0.0.0.0");
  if (token.empty() && !is_loopback(host)) {
    return bad_input("--host: others could reach " + host + "; give a --token that they must know, or use 127.0.0.1");
  }
  if (!token.empty() && token.size() < kShortestToken) return bad_input("--token: must have 8 characters or more");
  if (!is_url_safe(token)) return bad_input("--token: letters, digits and -._~ only, as it stands in a URL");
  if (most_clients < 1 || most_clients > 1000) return bad_input("most_clients: must be 1 ... 1000");
  if (client_queue_bytes < 65'536) return bad_input("client_queue_bytes: must be at least 65536");
  return Done{};
}

class Server::Implementation {
 public:
  Implementation(ServerOptions options, std::vector<Asset> assets, Offer offer)
      : options_(std::move(options)),
        assets_(std::move(assets)),
        offer_(std::move(offer)),
        subscribers_(kMostChannels),
        notices_(options_.notice) {}

  ~Implementation() {
    context_.stop();
    if (thread_.joinable()) thread_.join();
  }

  Status listen();
  void start();
  [[nodiscard]] std::uint16_t port() const { return port_; }
  ChannelId add_channel(std::string topic, std::string schema_name, std::string schema);
  void set_document(std::string path, std::string content_type, std::string content);
  [[nodiscard]] bool has_subscribers(ChannelId channel) const {
    return subscribers_[channel].load(std::memory_order_relaxed) > 0;
  }
  void publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message);

  /// Runs `tell` for each client, on the server's thread.
  template <typename Tell>
  void tell_clients(Tell tell);
  void parameters_changed();
  [[nodiscard]] ServerStatistics statistics() const;

 private:
  class Session;

  void accept();
  void admit(tcp::socket socket);
  void hand_out();
  void leave(const std::shared_ptr<Session>& session);
  void change_subscribers(ChannelId channel, int change);
  [[nodiscard]] std::vector<Channel> channels() const;
  [[nodiscard]] bool has_token(const Request& request) const;
  [[nodiscard]] Response answer(const Request& request) const;
  [[nodiscard]] std::shared_ptr<const Document> find_document(std::string_view path) const;
  [[nodiscard]] Response answer_with(const Request& request, const Asset& asset) const;
  [[nodiscard]] std::optional<Response> refuse_upgrade(const Request& request) const;
  void count(const ServerStatistics& more);

  const ServerOptions options_;
  const std::vector<Asset> assets_;
  const Offer offer_;
  const std::string session_name_ = random_session();
  std::vector<std::atomic<int>> subscribers_;  // [channel]; outlives the sessions that the context still holds, as does
  std::atomic<std::size_t> clients_{0};
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  asio::steady_timer pause_{context_};
  std::uint16_t port_ = 0;
  std::set<std::shared_ptr<Session>> sessions_;  // of the server's thread, as the next
  NoticeLimiter notices_;

  mutable std::mutex mutex_;  // guards all below but the atomics
  std::vector<Channel> channels_;
  std::map<std::string, std::shared_ptr<const Document>, std::less<>> documents_;
  std::vector<Published> waiting_;
  std::size_t waiting_bytes_ = 0;
  ServerStatistics statistics_;
  std::thread thread_;
};

/// One connection: HTTP, until the client asks for the stream.
class Server::Implementation::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Implementation& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    error_code ignored;
    stream_.next_layer().socket().set_option(tcp::no_delay(true), ignored);
    stream_.next_layer().socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    const tcp::endpoint peer = stream_.next_layer().socket().remote_endpoint(ignored);
    if (!ignored) peer_ = peer.address().to_string(ignored) + ":" + std::to_string(peer.port());
  }

  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    if (client_) --server_.clients_;
  }

  void start(bool is_admitted) {
    is_admitted_ = is_admitted;
    read_request();
  }

  /// The client of the stream; null while this is plain HTTP.
  [[nodiscard]] Client* client() { return client_ ? &*client_ : nullptr; }

  /// Sends what is queued.
  void flush() {
    if (client_->queue().control_bytes() > kMostControlBytes) return cut("asks and does not read");
    if (is_writing_ || client_->queue().empty()) return;
    is_writing_ = true;
    outgoing_ = client_->queue().pop();
    const std::size_t header_size = outgoing_.header ? outgoing_.header->size() : 0;
    const std::array<asio::const_buffer, 2> buffers{
        asio::buffer(outgoing_.header ? outgoing_.header->data() : nullptr, header_size),
        asio::buffer(*outgoing_.bytes)};
    stream_.text(outgoing_.is_text);
    stream_.async_write(buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
      self->is_writing_ = false;
      if (error) return self->end();
      self->flush();
    });
  }

 private:
  void read_request() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    parser_->body_limit(0);
    stream_.next_layer().expires_after(kRequestTime);
    http::async_read(stream_.next_layer(), buffer_, *parser_,
                     [self = shared_from_this()](const error_code& error, std::size_t) { self->on_request(error); });
  }

  void on_request(const error_code& error) {
    if (error == http::error::end_of_stream || error == beast::error::timeout) return end();
    if (error) return cut("sent no HTTP: " + error.message());
    const Request& request = parser_->get();
    if (!is_admitted_) {
      return respond(make_refusal(request, http::status::service_unavailable, "too many clients; close one of them"));
    }
    if (!websocket::is_upgrade(request)) return respond(server_.answer(request));
    if (std::optional<Response> refusal = server_.refuse_upgrade(request)) {
      server_.notices_.say("refused", peer_ + ": refused: " + refusal->body().substr(0, refusal->body().size() - 1));
      server_.count({0, 0, 0, 1});
      return respond(std::move(*refusal));
    }
    upgrade(request);
  }

  void respond(Response response) {
    response_.emplace(std::move(response));
    if (!is_admitted_) response_->keep_alive(false);
    stream_.next_layer().expires_after(kIdleTime);
    http::async_write(stream_.next_layer(), *response_,
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        if (error || !self->response_->keep_alive()) return self->end();
                        self->response_.reset();
                        self->read_request();
                      });
  }

  void upgrade(const Request& request) {
    const std::string_view subprotocol = choose_subprotocol(view(request[http::field::sec_websocket_protocol]));
    stream_.next_layer().expires_never();  // the stream has time-outs of its own
    stream_.set_option(websocket::stream_base::timeout{kRequestTime, kIdleTime, true});
    stream_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, beast::string_view(subprotocol.data(), subprotocol.size()));
      response.set(http::field::server, "dermis");
    }));
    stream_.read_message_max(kMostMessageBytes);
    stream_.auto_fragment(false);
    stream_.async_accept(request, [self = shared_from_this(), is_sdk = subprotocol == kSdkSubprotocol](
                                      const error_code& error) { self->on_upgrade(error, is_sdk); });
  }

  void on_upgrade(const error_code& error, bool is_sdk) {
    if (error) return end();
    client_.emplace(server_.offer_, is_sdk, server_.options_.client_queue_bytes,
                    [&server = server_](ChannelId channel, int change) { server.change_subscribers(channel, change); });
    client_->greet(server_.options_.name, server_.session_name_, server_.channels());
    ++server_.clients_;
    flush();
    read_message();
  }

  void read_message() {
    const auto now = std::chrono::steady_clock::now();
    if (now >= requests_until_.expiry()) {
      requests_until_.expires_at(now + seconds(1));
      requests_ = 0;
    }
    buffer_.clear();
    stream_.async_read(buffer_,
                       [self = shared_from_this()](const error_code& error, std::size_t) { self->on_message(error); });
  }

  void on_message(const error_code& error) {
    if (error == websocket::error::message_too_big) return cut("sent a message of more than 1 MB");
    if (error.category() == make_error_code(websocket::error::bad_opcode).category() &&
        error != websocket::error::closed) {
      return cut("sent no WebSocket frames: " + error.message());
    }
    if (error == beast::error::timeout) return cut("said nothing for " + std::to_string(kIdleTime.count()) + " s");
    if (error) return end();
    const asio::const_buffer bytes = buffer_.cdata();
    const Status received =
        client_->receive({static_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, stream_.got_text());
    if (!received) return cut("does not speak the protocol: " + received.error().message);
    flush();
    if (++requests_ <= kMostRequests || std::chrono::steady_clock::now() >= requests_until_.expiry()) {
      return read_message();
    }
    requests_until_.async_wait([self = shared_from_this()](const error_code& ended) {
      if (!ended) self->read_message();
    });
  }

  /// Ends the connection of a client that does what it must not.
  void cut(const std::string& why) {
    server_.notices_.say("cut", peer_ + ": closed: it " + why);
    end();
  }

  void end() {
    error_code ignored;
    stream_.next_layer().socket().close(ignored);
    requests_until_.cancel();
    server_.leave(shared_from_this());
  }

  Implementation& server_;
  websocket::stream<beast::tcp_stream> stream_;
  std::string peer_ = "a client";
  bool is_admitted_ = true;
  beast::flat_buffer buffer_{2 * kMostMessageBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<Response> response_;
  std::optional<Client> client_;
  OutgoingMessage outgoing_;
  bool is_writing_ = false;
  asio::steady_timer requests_until_{server_.context_};  // the end of the second in which requests_ are counted
  int requests_ = 0;
};

Status Server::Implementation::listen() {
  error_code error;
  const std::string host = options_.host == "localhost" ? "127.0.0.1" : options_.host;
  const tcp::endpoint endpoint(asio::ip::make_address(host, error), options_.port);
  if (!error) acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) return in_use_or_forbidden(options_, error);
  port_ = acceptor_.local_endpoint(error).port();
  return Done{};
}

void Server::Implementation::start() {
  accept();
  thread_ = std::thread([this] { context_.run(); });
}

void Server::Implementation::accept() {
  acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      admit(std::move(socket));
      return accept();
    }
    notices_.say("accept", "cannot take a connection: " + error.message());
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](const error_code&) { accept(); });
  });
}

void Server::Implementation::admit(tcp::socket socket) {
  const bool is_admitted = sessions_.size() < options_.most_clients;
  if (!is_admitted) {
    notices_.say("many", "more than " + std::to_string(options_.most_clients) + " connections: refused");
    count({0, 0, 0, 1});
    if (sessions_.size() >= options_.most_clients + kMostRefusals) return;
  }
  const auto session = std::make_shared<Session>(*this, std::move(socket));
  sessions_.insert(session);
  session->start(is_admitted);
}

void Server::Implementation::leave(const std::shared_ptr<Session>& session) {
  sessions_.erase(session);
}

ChannelId Server::Implementation::add_channel(std::string topic, std::string schema_name, std::string schema) {
  Channel channel;
  {
    const std::lock_guard lock(mutex_);
    assert(channels_.size() < kMostChannels);
    channel = {static_cast<ChannelId>(channels_.size()), std::move(topic), std::move(schema_name), std::move(schema)};
    channels_.push_back(channel);
  }
  tell_clients([channel](Client& client) { client.advertise(channel); });
  return channel.id;
}

std::vector<Channel> Server::Implementation::channels() const {
  const std::lock_guard lock(mutex_);
  return channels_;
}

void Server::Implementation::set_document(std::string path, std::string content_type, std::string content) {
  auto document = std::make_shared<const Document>(Document{std::move(content_type), std::move(content)});
  const std::lock_guard lock(mutex_);
  documents_.insert_or_assign(std::move(path), std::move(document));
}

void Server::Implementation::change_subscribers(ChannelId channel, int change) {
  if (channel < kMostChannels) subscribers_[channel].fetch_add(change, std::memory_order_relaxed);
}

void Server::Implementation::publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message) {
  if (!has_subscribers(channel)) return;
  Published published{channel, log_time,
                      std::make_shared<const std::vector<std::uint8_t>>(message.begin(), message.end())};
  {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ + message.size() > kMostWaitingBytes) {
      ++statistics_.dropped;
      return;
    }
    waiting_bytes_ += message.size();
    waiting_.push_back(std::move(published));
    if (waiting_.size() > 1) return;  // the server's thread knows already
  }
  asio::post(context_, [this] { hand_out(); });
}

void Server::Implementation::hand_out() {
  std::vector<Published> published;
  {
    const std::lock_guard lock(mutex_);
    published.swap(waiting_);
    waiting_bytes_ = 0;
  }
  ServerStatistics handed;
  const auto sessions = std::vector(sessions_.begin(), sessions_.end());
  for (const auto& session : sessions) {
    if (session->client() == nullptr) continue;
    for (const Published& message : published) {
      session->client()->publish(message.channel, message.log_time, message.bytes, handed);
    }
    session->flush();
  }
  count(handed);
}

template <typename Tell>
void Server::Implementation::tell_clients(Tell tell) {
  asio::post(context_, [this, tell = std::move(tell)]() mutable {
    const auto sessions = std::vector(sessions_.begin(), sessions_.end());
    for (const auto& session : sessions) {
      if (session->client() == nullptr) continue;
      tell(*session->client());
      session->flush();
    }
  });
}

void Server::Implementation::parameters_changed() {
  tell_clients([this, all = std::optional<std::vector<Parameter>>()](Client& client) mutable {
    if (!client.follows_parameters() || !offer_.handlers.parameters) return;
    if (!all) all = offer_.handlers.parameters();
    client.tell_parameters(*all);
  });
}

void Server::Implementation::count(const ServerStatistics& more) {
  const std::lock_guard lock(mutex_);
  statistics_.messages += more.messages;
  statistics_.dropped += more.dropped;
  statistics_.refused += more.refused;
}

ServerStatistics Server::Implementation::statistics() const {
  const std::lock_guard lock(mutex_);
  ServerStatistics statistics = statistics_;
  statistics.clients = clients_.load();
  return statistics;
}

bool Server::Implementation::has_token(const Request& request) const {
  if (options_.token.empty()) return true;
  const std::string_view bearer = bearer_token(view(request[http::field::authorization]));
  const std::string_view query = query_value(view(request.target()), "token");
  return equal_in_constant_time(bearer.empty() ? query : bearer, options_.token);
}

Response Server::Implementation::answer(const Request& request) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    Response refusal = make_refusal(request, http::status::method_not_allowed, "only GET and HEAD");
    refusal.set(http::field::allow, "GET, HEAD");
    return refusal;
  }
  if (is_loopback(options_.host) && !is_loopback_authority(view(request[http::field::host]))) {
    return make_refusal(request, http::status::forbidden, "the Host is not this machine's loopback");
  }
  const std::string_view asked = path_of(view(request.target()));
  const std::string_view path = asked == "/" ? "/index.html" : asked;
  const auto asset = std::find_if(assets_.begin(), assets_.end(), [&](const Asset& a) { return a.path == path; });
  if (asset != assets_.end()) return answer_with(request, *asset);

  const std::shared_ptr<const Document> document = find_document(path);
  if (!document) return make_refusal(request, http::status::not_found, "there is no such page");
  if (!has_token(request)) return make_refusal(request, http::status::unauthorized, "the token is missing or wrong");
  return make_response(request, http::status::ok, document->content_type, document->content);
}

std::shared_ptr<const Document> Server::Implementation::find_document(std::string_view path) const {
  const std::lock_guard lock(mutex_);
  const auto found = documents_.find(path);
  return found == documents_.end() ? nullptr : found->second;
}

Response Server::Implementation::answer_with(const Request& request, const Asset& asset) const {
  Response response = make_response(request, http::status::ok, asset.content_type,
                                    {reinterpret_cast<const char*>(asset.bytes.data()), asset.bytes.size()});
  if (asset.is_gzip) response.set(http::field::content_encoding, "gzip");
  // The build names these by their content.
  if (asset.path.starts_with("/assets/")) {
    response.set(http::field::cache_control, "public, max-age=31536000, immutable");
  }
  return response;
}

std::optional<Response> Server::Implementation::refuse_upgrade(const Request& request) const {
  const std::string_view host = view(request[http::field::host]);
  if (is_loopback(options_.host) && !is_loopback_authority(host)) {
    return make_refusal(request, http::status::forbidden, "the Host is not this machine's loopback");
  }
  if (!has_token(request)) return make_refusal(request, http::status::unauthorized, "the token is missing or wrong");
  if (options_.token.empty() && !is_same_origin(view(request[http::field::origin]), host)) {
    return make_refusal(request, http::status::forbidden,
                        "a page of another origin; to allow it, serve with --token and give it the token");
  }
  if (choose_subprotocol(view(request[http::field::sec_websocket_protocol])).empty()) {
    return make_refusal(request, http::status::bad_request,
                        "the subprotocol must be foxglove.sdk.v1 or foxglove.websocket.v1");
  }
  return std::nullopt;
}

Server::Server(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::create(const ServerOptions& options, std::vector<Asset> assets,
                                               Handlers handlers, std::vector<Service> services,
                                               std::optional<Playback> playback) {
  if (Status valid = options.validate(); !valid) return valid.error();
  auto implementation = std::make_unique<Implementation>(
      options, std::move(assets), Offer{std::move(handlers), std::move(services), std::move(playback)});
  if (Status listening = implementation->listen(); !listening) return listening.error();
  return std::unique_ptr<Server>(new Server(std::move(implementation)));
}

std::uint16_t Server::port() const noexcept {
  return implementation_->port();
}

void Server::start() {
  implementation_->start();
}

ChannelId Server::add_channel(std::string topic, std::string schema_name, std::string schema) {
  return implementation_->add_channel(std::move(topic), std::move(schema_name), std::move(schema));
}

void Server::set_document(std::string path, std::string content_type, std::string content) {
  implementation_->set_document(std::move(path), std::move(content_type), std::move(content));
}

bool Server::has_subscribers(ChannelId channel) const noexcept {
  return implementation_->has_subscribers(channel);
}

void Server::publish(ChannelId channel, Nanos log_time, std::span<const std::uint8_t> message) {
  implementation_->publish(channel, log_time, message);
}

void Server::parameters_changed() {
  implementation_->parameters_changed();
}

void Server::playback_changed(const PlaybackState& state) {
  implementation_->tell_clients([state](Client& client) { client.tell_playback(state); });
}

void Server::status(int level, std::string_view message) {
  implementation_->tell_clients(
      [level, line = std::string(message)](Client& client) { client.tell_status(level, line); });
}

ServerStatistics Server::statistics() const {
  return implementation_->statistics();
}

}  // namespace dermis::stream
