// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "bindings.hpp"
#include "dermis/live/dds/publisher.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/out/serve/session.hpp"
#include "own_process.hpp"
#include "viewer/viewer_assets.hpp"

namespace dermis::python {
namespace {

/// A session in the background.
class Server {
 public:
  Server(const out::serve::SuitPlace& place, out::serve::SessionOptions options) : options_(std::move(options)) {
    const auto assets = viewer::assets();
    options_.page.assign(assets.begin(), assets.end());
    const Status started = [&] {
      const py::gil_scoped_release release;
      return start(place);
    }();
    raise_where_failed(started);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server() { end(); }

  /// Ends the session; raises where its recording could not be written.
  void stop() {
    if (!process_.is_this()) return;
    end();
    raise_where_failed(std::exchange(status_, Done{}));
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string url() const {
    const bool is_ipv6 = options_.server.host.find(':') != std::string::npos;
    const std::string host = is_ipv6 ? "[" + options_.server.host + "]" : options_.server.host;
    const std::string token = options_.server.token.empty() ? "" : "?token=" + options_.server.token;
    return "http://" + host + ":" + std::to_string(port_) + "/" + token;
  }

 private:
  Status start(const out::serve::SuitPlace& place) {
    Result<out::serve::ServedSuit> suit = out::serve::open_suit(place, {.stop = &stop_});
    if (!suit) return suit.error();
    Result<std::unique_ptr<out::serve::Session>> session = out::serve::Session::create(*std::move(suit), options_);
    if (!session) return session.error();
    session_ = *std::move(session);
    port_ = session_->port();
    thread_ = std::thread([this] { status_ = session_->run(stop_); });
    return Done{};
  }

  void end() {
    const py::gil_scoped_release release;
    stop_ = true;
    const std::lock_guard lock(end_mutex_);
    if (thread_.joinable()) thread_.join();
    session_.reset();
  }

  const OwnProcess process_;
  out::serve::SessionOptions options_;
  std::mutex end_mutex_;  // two threads of Python may end it
  std::atomic<bool> stop_ = false;
  std::unique_ptr<out::serve::Session> session_;
  std::uint16_t port_ = 0;
  Status status_ = Done{};
  std::thread thread_;
};

std::string text_of(const py::object& path) {
  return path.is_none() ? std::string() : path_of(path);
}

}  // namespace

void bind_serve(py::module_& module) {
  const out::websocket::ServerOptions defaults;
  py::class_<Server, HeldByItsProcess<Server>>(module, "Server")
      .def_property_readonly("port", &Server::port)
      .def_property_readonly("url", &Server::url)
      .def("stop", &Server::stop)
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Server& server, const py::args&) { server.stop(); });
  module.def(
      "serve",
      [](const py::object& uri, const py::object& model, const py::object& suit, const py::object& classes,
         const py::object& threats, const py::object& record, const std::string& host, std::uint16_t port,
         const std::string& token, bool dds, std::optional<std::uint64_t> domain) {
        const out::serve::SuitPlace place = {.from = text_of(uri),
                                             .model = text_of(model),
                                             .suit = text_of(suit),
                                             .classes = text_of(classes),
                                             .threats = text_of(threats)};
        out::serve::SessionOptions options;
        options.server.host = host;
        options.server.port = port;
        options.server.token = token;
        options.record = text_of(record);
        if (domain && !dds) raise_where_failed(bad_field("domain", "is that of dds=True"));
        if (dds) options.dds = value_or_raise(live::dds::options_of_environment(domain));
        raise_where_failed(options.server.validate());
        return HeldByItsProcess<Server>(new Server(place, std::move(options)));
      },
      py::arg("uri") = py::none(), py::arg("model") = py::none(), py::kw_only(), py::arg("suit") = py::none(),
      py::arg("classes") = py::none(), py::arg("threats") = py::none(), py::arg("record") = py::none(),
      py::arg("host") = defaults.host, py::arg("port") = defaults.port, py::arg("token") = defaults.token,
      py::arg("dds") = false, py::arg("domain") = py::none());
}

}  // namespace dermis::python
