// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/session.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

namespace dermis::out::websocket {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using std::chrono::seconds;

constexpr std::size_t kMostMessageBytes = 1U << 20U;  // from a client
constexpr std::uint32_t kMostHeaderBytes = 8192;
constexpr double kMostRequests = 200;              // at once, and then in a second; the next has to wait
constexpr double kMostRequestBytes = 256U << 10U;  // in a second, after a message of the most bytes
constexpr int kSendBuffer = 256 << 10;             // [bytes]; data waiting there cannot be dropped any more
constexpr seconds kRequestTime{5};                 // from the connection, or the last answer, to the end of the request
constexpr seconds kIdleTime{30};
constexpr std::chrono::milliseconds kAgain{20};  // a question that has no answer yet is asked

/// The bytes that came are wrong, rather than at their end.
bool is_no_http(const beast::error_code& error) {
  return error.category() == make_error_code(http::error::bad_method).category() &&
         error != http::error::end_of_stream && error != http::error::partial_message;
}

bool is_no_websocket(const beast::error_code& error) {
  return error.category() == make_error_code(websocket::error::bad_opcode).category() &&
         error != websocket::error::closed;
}

Answer answer_to(const Question& question) {
  for (;;) {
    if (Answer answer = question()) return answer;
    std::this_thread::sleep_for(kAgain);
  }
}

}  // namespace

Session::Session(SessionOwner& owner, tcp::socket socket)
    : owner_(owner),
      stream_(std::move(socket)),
      buffer_(2 * kMostMessageBytes),
      requests_{Budget(kMostRequests, kMostRequests), Budget(kMostMessageBytes, kMostRequestBytes)},
      pause_(stream_.get_executor()) {
  ErrorCode ignored;
  tcp::socket& connection = stream_.next_layer().socket();
  connection.set_option(tcp::no_delay(true), ignored);
  connection.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  const tcp::endpoint peer = connection.remote_endpoint(ignored);
  if (!ignored) peer_ = peer.address().to_string(ignored) + ":" + std::to_string(peer.port());
}

void Session::at(Budget::Clock::time_point time, std::function<void()> then) {
  if (time <= Budget::Clock::now()) return then();
  pause_.expires_at(time);
  pause_.async_wait([self = shared_from_this(), then = std::move(then)](const ErrorCode& ended) {
    if (!ended) then();
  });
}

Budget::Clock::time_point Session::next_request() const {
  return std::max(requests_.count.free_at(), requests_.bytes.free_at());
}

void Session::await_request() {
  at(next_request(), [this] { read_request(); });
}

void Session::read_request() {
  parser_.emplace();
  parser_->header_limit(kMostHeaderBytes);
  parser_->body_limit(0);
  stream_.next_layer().expires_after(kRequestTime);
  http::async_read(stream_.next_layer(), buffer_, *parser_,
                   [self = shared_from_this()](const ErrorCode& error, std::size_t) { self->on_request(error); });
}

void Session::on_request(const ErrorCode& error) {
  if (is_no_http(error)) return cut("sent no HTTP: " + error.message());
  if (error) return end();
  requests_.count.spend(1);
  const Request& request = parser_->get();
  if (!websocket::is_upgrade(request)) {
    if (const std::optional<std::string> file = owner_.site().file(request)) return send_file(*file);
    return respond(owner_.site().answer(request));
  }
  if (std::optional<Response> refusal = owner_.site().refuse_upgrade(request)) return refuse(*std::move(refusal));
  if (!owner_.enter(shared_from_this())) {
    return refuse(make_refusal(request, http::status::service_unavailable, "too many clients; close one of them"));
  }
  at(owner_.turn(), [this] { upgrade(); });
}

void Session::refuse(Response refusal) {
  owner_.on_refused(peer_ + ": refused: " + refusal.body().substr(0, refusal.body().size() - 1));
  respond(std::move(refusal));
}

void Session::respond(Response response) {
  response_.emplace(std::move(response));
  stream_.next_layer().expires_after(kIdleTime);
  http::async_write(stream_.next_layer(), *response_, [self = shared_from_this()](const ErrorCode& error, std::size_t) {
    if (error || !self->response_->keep_alive()) return self->end();
    self->response_.reset();
    self->await_request();
  });
}

void Session::send_file(const std::string& path) {
  file_ = std::make_shared<FileOnItsWay>();
  read_file([path](FileOnItsWay& file) { return file.open(path); },
            [this, path](bool is_open) {
              if (is_open) return send_head(path);
              respond(make_refusal(parser_->get(), http::status::not_found, "the file is not there any more"));
            });
}

void Session::read_file(std::function<bool(FileOnItsWay&)> read, std::function<void(bool)> then) {
  asio::post(owner_.desk(), [weak = weak_from_this(), executor = stream_.get_executor(), file = file_,
                             read = std::move(read), then = std::move(then)] {
    asio::post(executor, [weak, then, done = read(*file)] {
      if (const auto self = weak.lock()) then(done);
    });
  });
}

void Session::send_head(const std::string& path) {
  head_.emplace(make_file_head(parser_->get(), std::filesystem::path(path).filename().string(), file_->size()));
  stream_.next_layer().expires_after(kIdleTime);
  http::async_write(stream_.next_layer(), *head_, [self = shared_from_this()](const ErrorCode& error, std::size_t) {
    error ? self->end() : self->send_pieces();
  });
}

void Session::send_pieces() {
  read_file([](FileOnItsWay& file) { return file.read_piece(); },
            [this](bool is_more) { is_more ? send_piece() : end(); });
}

void Session::send_piece() {
  stream_.next_layer().expires_after(kIdleTime);
  asio::async_write(
      stream_.next_layer(), asio::buffer(file_->piece()),
      [self = shared_from_this()](const ErrorCode& error, std::size_t) { error ? self->end() : self->send_pieces(); });
}

void Session::upgrade() {
  const Request& request = parser_->get();
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
                                    const ErrorCode& error) { self->on_upgrade(error, is_sdk); });
}

void Session::on_upgrade(const ErrorCode& error, bool is_sdk) {
  if (error) return end();
  client_ = owner_.make_client(peer_, is_sdk, [this](Question question) { ask(std::move(question)); });
  flush();
  read_on();
}

void Session::flush() {
  if (client_->asks_and_does_not_read()) return cut("asks and does not read");
  if (is_writing_ || client_->queue().empty()) return;
  is_writing_ = true;
  outgoing_ = client_->queue().pop();
  const std::size_t header_size = outgoing_.header ? outgoing_.header->size() : 0;
  const std::array<asio::const_buffer, 2> buffers{
      asio::buffer(outgoing_.header ? outgoing_.header->data() : nullptr, header_size), asio::buffer(*outgoing_.bytes)};
  stream_.text(outgoing_.is_text);
  stream_.async_write(buffers, [self = shared_from_this()](const ErrorCode& error, std::size_t) {
    self->is_writing_ = false;
    if (error) return self->end();
    self->flush();
    self->read_on();
  });
}

/// Reads the next message, once the last one is answered and the answer on its way. A client that asks and does not
/// read is not read either.
void Session::read_on() {
  if (is_reading_ || awaits_answer_ || client_->queue().control_bytes() > 0) return;
  is_reading_ = true;
  at(next_request(), [this] { read_message(); });
}

void Session::read_message() {
  buffer_.clear();
  buffer_.shrink_to_fit();  // a large one is not kept
  stream_.async_read(buffer_,
                     [self = shared_from_this()](const ErrorCode& error, std::size_t) { self->on_message(error); });
}

void Session::on_message(const ErrorCode& error) {
  is_reading_ = false;
  if (error == websocket::error::message_too_big) return cut("sent a message of more than 1 MB");
  if (is_no_websocket(error)) return cut("sent no WebSocket frames: " + error.message());
  if (error == beast::error::timeout) return cut("said nothing for " + std::to_string(kIdleTime.count()) + " s");
  if (error) return end();
  const asio::const_buffer bytes = buffer_.cdata();
  requests_.count.spend(1);
  requests_.bytes.spend(static_cast<double>(bytes.size()));
  const Status received =
      client_->receive({static_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, stream_.got_text());
  if (!received) return cut("does not speak the protocol: " + received.error().message);
  flush();
  read_on();
}

void Session::ask(Question question) {
  awaits_answer_ = true;
  asio::post(owner_.desk(),
             [weak = weak_from_this(), executor = stream_.get_executor(), question = std::move(question)] {
               asio::post(executor, [weak, answer = answer_to(question)] {
                 if (const auto self = weak.lock()) self->on_answer(answer);
               });
             });
}

void Session::on_answer(const Answer& answer) {
  awaits_answer_ = false;
  answer(*client_);
  flush();
  read_on();
}

/// Ends the connection of a client that breaks the rules.
void Session::cut(const std::string& why) {
  owner_.on_cut(peer_ + ": closed: it " + why);
  end();
}

void Session::end() {
  ErrorCode ignored;
  stream_.next_layer().socket().close(ignored);
  pause_.cancel();
  owner_.leave(shared_from_this());
}

}  // namespace dermis::out::websocket
