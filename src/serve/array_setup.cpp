// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/serve/array_setup.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "dermis/acquisition/serial_ports.hpp"
#include "dermis/files/array_toml.hpp"
#include "serve/array_request.hpp"
#include "serve/first_look.hpp"
#include "serve/json_request.hpp"
#include "serve/touch_watch.hpp"

namespace dermis::serve {
namespace {

using nlohmann::ordered_json;
using sources::SourceName;

constexpr std::chrono::milliseconds kPeriod{50};
constexpr std::chrono::milliseconds kToAnswer{300};  // until a client has what it asked for
constexpr std::size_t kMostPath = 255;

/// /suit.json of an array that is not described yet.
std::string suit_json(const std::string& from, const FirstLook& found) {
  ordered_json json;
  json["name"] = "";
  json["arrays"] = ordered_json::array();
  ordered_json& setup = json["setup"];
  setup["from"] = from;
  setup["rows"] = found.shape ? ordered_json(found.shape->rows) : ordered_json();
  setup["cols"] = found.shape ? ordered_json(found.shape->cols) : ordered_json();
  setup["message"] = found.message;
  return json_text(json);
}

Result<std::string> list_ports() {
  ordered_json answer;
  answer["ports"] = ordered_json::array();
  for (const acquisition::SerialPort& port : acquisition::serial_ports()) {
    answer["ports"].push_back({{"device", port.device}, {"path", port.path}, {"product", port.product}});
  }
  return json_text(answer);
}

/// {"path": one of those that are listed, "baud": 115200}; without a baud it is that of most boards.
Result<SourceName> port_request(std::string_view text) {
  const Result<JsonRequest> request = JsonRequest::parse(text);
  if (!request) return request.error();
  const Result<std::string> path = request->text("path", kMostPath);
  if (!path) return path.error();
  const auto baud = request->number("baud", "50 to 20000000");
  if (!baud) return baud.error();
  const std::vector<acquisition::SerialPort> ports = acquisition::serial_ports();
  if (std::ranges::find(ports, *path, &acquisition::SerialPort::path) == ports.end()) {
    return bad_field("path", "is none of the serial ports of this machine");
  }
  std::string uri = "serial://" + *path;
  if (*baud) uri += "?baud=" + std::to_string(**baud);
  return SourceName::parse(uri);
}

}  // namespace

class ArraySetup::Implementation {
 public:
  /// `name`: empty where clients choose it.
  Implementation(std::unique_ptr<stream::Server> server, std::optional<SourceName> name, const FirstLook& found,
                 sources::SourceOptions options)
      : name_(std::move(name)), options_(std::move(options)), server_(std::move(server)) {
    const bool is_chosen = name_.has_value();
    show(found);
    server_->start({}, services(!is_chosen));
  }

  [[nodiscard]] std::uint16_t port() const noexcept { return server_->port(); }

  DescribedArray run(const std::atomic<bool>& stop) {
    while (!stop) {
      if (DescribedArray array = described(); !array.model.empty()) {
        std::this_thread::sleep_for(kToAnswer);
        return array;
      }
      std::this_thread::sleep_for(kPeriod);
    }
    return {};
  }

 private:
  using Call = Result<std::string> (Implementation::*)(std::string_view);

  std::vector<stream::Service> services(bool with_ports) {
    const auto service = [this](const char* name, Call call) {
      return stream::Service{name, [this, call](std::string_view request) { return (this->*call)(request); }};
    };
    std::vector<stream::Service> services = {service("/array/describe", &Implementation::describe),
                                             service("/array/watch", &Implementation::watch),
                                             service("/array/touch", &Implementation::touch)};
    if (!with_ports) return services;
    services.push_back({"/ports/list", [](std::string_view) { return list_ports(); }});
    services.push_back(service("/ports/open", &Implementation::open_port));
    return services;
  }

  void show(const FirstLook& found) {
    server_->set_document("/suit.json", "application/json", suit_json(name_ ? name_->text : "", found));
  }

  [[nodiscard]] DescribedArray described() {
    const std::lock_guard lock(mutex_);
    return described_;
  }

  Result<std::string> open_port(std::string_view request) {
    Result<SourceName> name = port_request(request);
    if (!name) return name.error();
    watch_.reset();
    const Result<FirstLook> found = first_look(*name, options_);
    if (!found) return found.error();
    name_ = *std::move(name);
    show(*found);
    return json_text(nlohmann::json{{"from", name_->text}});
  }

  Result<std::string> describe(std::string_view request) {
    if (!name_) return bad_input("choose a serial port first");
    const Result<ArrayDescription> array = array_request(request);
    if (!array) return array.error();
    const std::string path = array->name + ".toml";
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) {
      return bad_field("name",
                       path + " is there already: choose another name, or serve it as the model of this source");
    }
    if (Status status = files::write_array(path, *array); !status) return status.error();
    const std::lock_guard lock(mutex_);
    described_ = {name_->text, path};
    return json_text(nlohmann::json{{"file", path}});
  }

  /// From now on touch() tells where the array is touched; `request` says the shape of what its source sends.
  Result<std::string> watch(std::string_view request) {
    if (!name_) return bad_input("choose a serial port first");
    const Result<FrameShape> shape = shape_request(request);
    if (!shape) return shape.error();
    watch_.reset();  // a device can be opened once
    watch_ = std::make_unique<TouchWatch>(*name_, *shape, options_);
    return std::string("{}");
  }

  Result<std::string> touch(std::string_view /*request*/) {
    if (!watch_) return bad_input("nothing is watched");
    const TouchWatch::Seen seen = watch_->seen();
    const std::size_t cols = watch_->shape().cols;
    ordered_json answer;
    answer["ready"] = seen.is_ready;
    answer["touched"] = seen.taxel ? ordered_json{*seen.taxel / cols, *seen.taxel % cols} : ordered_json();
    answer["problem"] = seen.problem;
    return json_text(answer);
  }

  std::mutex mutex_;
  DescribedArray described_;
  std::optional<SourceName> name_;  // this and the rest: of the services, which are called one at a time
  sources::SourceOptions options_;
  std::unique_ptr<TouchWatch> watch_;  // null: nobody asked for it
  std::unique_ptr<stream::Server> server_;
};

Result<std::unique_ptr<ArraySetup>> ArraySetup::create(const std::string& from, const SessionOptions& options,
                                                       sources::SourceOptions source_options) {
  if (from.empty() && !options.server.is_local()) {
    return bad_input("host: others reach this server, so clients may not choose a device; name its URI");
  }
  std::optional<SourceName> name;
  FirstLook found;
  if (!from.empty()) {
    Result<SourceName> parsed = SourceName::parse(from);
    if (!parsed) return parsed.error();
    name = *std::move(parsed);
    Result<FirstLook> looked = first_look(*name, source_options);
    if (!looked) return looked.error();
    found = *std::move(looked);
  }
  Result<std::unique_ptr<stream::Server>> server = stream::Server::create(options.server, options.page);
  if (!server) return server.error();
  return std::unique_ptr<ArraySetup>(new ArraySetup(
      std::make_unique<Implementation>(*std::move(server), std::move(name), found, std::move(source_options))));
}

ArraySetup::ArraySetup(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

ArraySetup::~ArraySetup() = default;

std::uint16_t ArraySetup::port() const noexcept {
  return implementation_->port();
}

DescribedArray ArraySetup::run(const std::atomic<bool>& stop) {
  return implementation_->run(stop);
}

}  // namespace dermis::serve
