// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/byte_stream.hpp"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <utility>  // Asio 1.74 forgets it

#include "bytes/devices/asio_stream.hpp"
#include "bytes/devices/descriptor_stream.hpp"
#include "bytes/devices/serial_stream.hpp"

namespace dermis::bytes::devices {
namespace {

using asio::ip::tcp;
using asio::ip::udp;

constexpr int kReceiveBuffer = 8 << 20;  // [bytes], less where the system allows less

std::string host_and_port(const std::string& host, unsigned port) {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

template <typename Protocol>
Result<typename Protocol::resolver::results_type> resolve(asio::io_context& context, const SourceUri& uri) {
  error_code error;
  typename Protocol::resolver resolver(context);
  auto found = resolver.resolve(uri.host, std::to_string(uri.port), asio::ip::resolver_base::numeric_service, error);
  if (error || found.empty()) {
    return failed("the host " + in_quotes(uri.host) + " is not known: check the name, or give its address");
  }
  return found;
}

/// A peer that vanished without a word is noticed after some 8 s; requests leave at once.
void watch_peer(tcp::socket& socket) {
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  const int descriptor = socket.native_handle();
  const auto set = [&](int option, int value) { ::setsockopt(descriptor, IPPROTO_TCP, option, &value, sizeof value); };
  set(TCP_KEEPIDLE, 5);
  set(TCP_KEEPINTVL, 1);
  set(TCP_KEEPCNT, 3);
}

class TcpStream : public AsioStream {
 public:
  explicit TcpStream(const SourceUri& uri) : uri_(uri) {}

  Transferred read(std::span<std::uint8_t> into, Nanos timeout) override {
    if (timeout > Nanos{}) return read_some(socket_, into, timeout, End::closed);
    error_code error;
    const std::size_t bytes = socket_.read_some(asio::buffer(into.data(), into.size()), error);
    return {bytes, end_of(error, End::closed)};
  }
  Transferred write(std::span<const std::uint8_t> bytes, Nanos timeout) override {
    return write_some(socket_, bytes, timeout, End::closed);
  }
  [[nodiscard]] int descriptor() const override { return descriptor_; }
  [[nodiscard]] std::string name() const override { return host_and_port(uri_.host, uri_.port); }

 protected:
  /// Goes on with an attempt to connect or accept that may take several calls of open().
  Result<bool> wait_for_peer(Nanos timeout) {
    context_.restart();
    context_.run_for(timeout);
    if (pending_) return false;
    if (outcome_) return error_of(outcome_);
    watch_peer(socket_);
    error_code ignored;
    socket_.non_blocking(true, ignored);
    descriptor_ = socket_.native_handle();
    return true;
  }

  void begin_attempt() {
    error_code ignored;
    socket_.close(ignored);
    pending_ = true;
  }
  void end_attempt(const error_code& outcome) {
    pending_ = false;
    outcome_ = outcome;
  }

  [[nodiscard]] virtual Error error_of(const error_code& error) const = 0;

  SourceUri uri_;
  tcp::socket socket_{context_};
  int descriptor_ = -1;
  bool pending_ = false;
  error_code outcome_;
};

class TcpClient final : public TcpStream {
 public:
  using TcpStream::TcpStream;

  Result<bool> open(Nanos timeout) override {
    if (endpoints_.empty()) {
      auto found = resolve<tcp>(context_, uri_);
      if (!found) return found.error();
      endpoints_ = std::move(*found);
    }
    if (!pending_) {
      begin_attempt();
      asio::async_connect(socket_, endpoints_,
                          [this](const error_code& error, const tcp::endpoint&) { end_attempt(error); });
    }
    return wait_for_peer(timeout);
  }

 private:
  [[nodiscard]] Error error_of(const error_code& error) const override {
    if (error == asio::error::connection_refused) {
      return failed("nothing listens on " + name() + ": is the device on, and is this its port?");
    }
    return failed("cannot connect to " + name() + ": " + error.message() + "; check the address and the network");
  }

  tcp::resolver::results_type endpoints_;  // looked up once: a name server may be slow
};

Error cannot_listen(const SourceUri& uri, const error_code& error) {
  const std::string place = host_and_port(uri.host, uri.port);
  if (error == asio::error::address_in_use) {
    return failed("the port of " + place + " is in use by another program: close it or choose another port");
  }
  if (error == asio::error::access_denied) {
    return failed("no permission to listen on " + place + ": choose a port above 1023");
  }
  if (error == boost::system::errc::address_not_available) {
    return failed(in_quotes(uri.host) + " is no address of this computer: 0.0.0.0 listens on all of them");
  }
  return failed("cannot listen on " + place + ": " + error.message());
}

class TcpListener final : public TcpStream {
 public:
  using TcpStream::TcpStream;

  Result<bool> open(Nanos timeout) override {
    if (!acceptor_.is_open()) {
      if (const Status listening = listen(); !listening) return listening.error();
    }
    if (!pending_) {
      begin_attempt();
      acceptor_.async_accept(socket_, [this](const error_code& error) { end_attempt(error); });
    }
    return wait_for_peer(timeout);
  }

 private:
  Status listen() {
    const auto found = resolve<tcp>(context_, uri_);
    if (!found) return found.error();
    const tcp::endpoint place = found->begin()->endpoint();
    error_code error;
    acceptor_.open(place.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(place, error);
    if (!error) acceptor_.listen(1, error);  // one device at a time
    if (error) {
      const Error reason = cannot_listen(uri_, error);
      acceptor_.close(error);
      return reason;
    }
    uri_.port = acceptor_.local_endpoint(error).port();
    return Done{};
  }

  [[nodiscard]] Error error_of(const error_code& error) const override { return cannot_listen(uri_, error); }

  tcp::acceptor acceptor_{context_};
};

class UdpStream final : public AsioStream {
 public:
  enum class Role { receiver, sender };
  UdpStream(const SourceUri& uri, Role role) : uri_(uri), role_(role) {}

  Result<bool> open(Nanos /*timeout*/) override {
    const auto found = resolve<udp>(context_, uri_);
    if (!found) return found.error();
    const udp::endpoint place = found->begin()->endpoint();
    error_code error;
    socket_.close(error);
    socket_.open(place.protocol(), error);
    if (!error && role_ == Role::receiver) socket_.bind(place, error);
    if (!error && role_ == Role::sender) socket_.connect(place, error);
    if (error) {
      const Error reason = cannot_listen(uri_, error);
      socket_.close(error);
      return reason;
    }
    socket_.set_option(asio::socket_base::receive_buffer_size(kReceiveBuffer), error);
    socket_.non_blocking(true, error);
    descriptor_ = socket_.native_handle();
    if (role_ == Role::receiver) uri_.port = socket_.local_endpoint(error).port();
    return true;
  }
  Transferred read(std::span<std::uint8_t> into, Nanos timeout) override {
    if (timeout <= Nanos{}) {
      error_code ignored;
      return {socket_.receive_from(asio::buffer(into.data(), into.size()), peer_, 0, ignored)};
    }
    return ignoring_unheard(transfer(socket_, timeout, End::none, [&](auto handler) {
      socket_.async_receive_from(asio::buffer(into.data(), into.size()), peer_, handler);
    }));
  }
  /// The receiver answers whom it heard last.
  Transferred write(std::span<const std::uint8_t> bytes, Nanos timeout) override {
    const auto buffer = asio::buffer(bytes.data(), std::min(bytes.size(), kMaxDatagram));
    if (role_ == Role::receiver && peer_.port() == 0) return {bytes.size()};
    return ignoring_unheard(transfer(socket_, timeout, End::none, [&](auto handler) {
      if (role_ == Role::sender) socket_.async_send(buffer, handler);
      if (role_ == Role::receiver) socket_.async_send_to(buffer, peer_, handler);
    }));
  }
  [[nodiscard]] int descriptor() const override { return descriptor_; }
  [[nodiscard]] std::string name() const override { return host_and_port(uri_.host, uri_.port); }

 private:
  /// The stream goes on when nobody listens there (ICMP): somebody may, soon.
  static Transferred ignoring_unheard(Transferred transferred) { return {transferred.bytes, End::none}; }

  static constexpr std::size_t kMaxDatagram = 1400;  // one Ethernet frame: no fragments that are lost together
  SourceUri uri_;
  Role role_;
  udp::socket socket_{context_};
  int descriptor_ = -1;
  udp::endpoint peer_;
};

Result<std::unique_ptr<ByteStream>> make_stream(const SourceUri& uri, UdpStream::Role udp_role) {
  try {
    switch (uri.transport) {
      case Transport::serial: return make_serial_stream(uri.path, uri.baud);
      case Transport::tcp: return std::unique_ptr<ByteStream>(std::make_unique<TcpClient>(uri));
      case Transport::tcp_listen: return std::unique_ptr<ByteStream>(std::make_unique<TcpListener>(uri));
      case Transport::udp: return std::unique_ptr<ByteStream>(std::make_unique<UdpStream>(uri, udp_role));
      case Transport::standard_input: return make_standard_input();
      case Transport::file: return make_file_stream(uri.path);
      case Transport::pseudo_terminal: return make_pseudo_terminal();
      case Transport::standard_output: return make_standard_output();
      case Transport::simulation: break;
    }
  } catch (const std::exception& error) {  // Asio found no descriptor for its event queue
    return failed(in_quotes(uri.text) + ": " + error.what());
  }
  return bad_input(in_quotes(uri.text) + ": the simulator gives frames, not bytes");
}

}  // namespace

Result<std::unique_ptr<ByteStream>> make_source_stream(const SourceUri& uri) {
  return make_stream(uri, UdpStream::Role::receiver);
}

Result<std::unique_ptr<ByteStream>> make_target_stream(const SourceUri& uri) {
  return make_stream(uri, UdpStream::Role::sender);
}

}  // namespace dermis::bytes::devices
