// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

// clang-format off: Asio 1.74 forgets it
#include <utility>
// clang-format on
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "out/websocket/budget.hpp"
#include "out/websocket/client.hpp"
#include "out/websocket/file_on_its_way.hpp"
#include "out/websocket/site.hpp"

namespace dermis::out::websocket {

class Session;

/// The server, as its connections know it. Called on its thread.
class SessionOwner {
 public:
  SessionOwner() = default;
  virtual ~SessionOwner() = default;
  SessionOwner(const SessionOwner&) = delete;
  SessionOwner& operator=(const SessionOwner&) = delete;

  [[nodiscard]] virtual const Site& site() const = 0;
  /// Takes a connection among the clients of the stream; false where there are too many.
  [[nodiscard]] virtual bool enter(const std::shared_ptr<Session>& session) = 0;
  /// When the connection that has entered may become a client.
  [[nodiscard]] virtual Budget::Clock::time_point turn() = 0;
  [[nodiscard]] virtual std::unique_ptr<Client> make_client(const std::string& peer, bool is_sdk, Ask ask) = 0;
  /// Where the owner of the server may take its time for the clients' requests.
  [[nodiscard]] virtual boost::asio::thread_pool& desk() = 0;
  /// Known no more; twice does no harm.
  virtual void leave(const std::shared_ptr<Session>& session) = 0;
  virtual void on_refused(const std::string& line) = 0;
  virtual void on_cut(const std::string& line) = 0;
};

/// One connection: HTTP, until the client asks for the stream. Used by the server's thread.
class Session : public std::enable_shared_from_this<Session> {
 public:
  /// `owner` must outlive it.
  Session(SessionOwner& owner, boost::asio::ip::tcp::socket socket);

  void start() { await_request(); }

  /// The client of the stream; null while this is plain HTTP.
  [[nodiscard]] Client* client() noexcept { return client_.get(); }

  /// Sends what is queued for the client.
  void flush();

  void end();

 private:
  using ErrorCode = boost::beast::error_code;

  /// Limits on reading them.
  struct Requests {
    Budget count;
    Budget bytes;
  };

  void at(Budget::Clock::time_point time, std::function<void()> then);
  /// When it may ask again.
  [[nodiscard]] Budget::Clock::time_point next_request() const;
  void await_request();
  void read_request();
  void on_request(const ErrorCode& error);
  void refuse(Response refusal);
  void respond(Response response);
  void send_file(const std::string& path);
  void send_head(const std::string& path);
  void send_pieces();
  void send_piece();
  /// Reads on the owner's threads, so that a stalling disk holds no stream up; then goes on here.
  void read_file(std::function<bool(FileOnItsWay&)> read, std::function<void(bool)> then);
  void upgrade();
  void on_upgrade(const ErrorCode& error, bool is_sdk);
  void read_on();
  void read_message();
  void on_message(const ErrorCode& error);
  void ask(Question question);
  void on_answer(const Answer& answer);
  void cut(const std::string& why);

  SessionOwner& owner_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  std::string peer_ = "a client";
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
  std::optional<Response> response_;
  std::shared_ptr<FileOnItsWay> file_;  // null: none is on its way
  std::optional<FileHead> head_;
  std::unique_ptr<Client> client_;
  OutgoingMessage outgoing_;
  bool is_writing_ = false;
  bool is_reading_ = false;
  bool awaits_answer_ = false;
  Requests requests_;
  boost::asio::steady_timer pause_;
};

}  // namespace dermis::out::websocket
