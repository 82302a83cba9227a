// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/serve/array_setup.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "dermis/files/array_toml.hpp"
#include "serve/json_request.hpp"

namespace dermis::serve {
namespace {

constexpr std::chrono::seconds kPatience{8};
constexpr std::chrono::milliseconds kPeriod{50};
constexpr std::chrono::milliseconds kToAnswer{300};  // until a client has what it asked for

/// What the source sends, as far as that tells the array.
struct FirstLook {
  std::optional<FrameShape> shape{};
  std::string message{};  ///< What the bytes are, or what they lack.
};

/// Sets a flag when another is set, or after kPatience.
class Patience {
 public:
  explicit Patience(const std::atomic<bool>* stop)
      : thread_([this, stop](const std::stop_token& token) {
          const auto end = std::chrono::steady_clock::now() + kPatience;
          const auto is_over = [&] { return std::chrono::steady_clock::now() >= end || (stop != nullptr && *stop); };
          while (!token.stop_requested() && !is_over()) std::this_thread::sleep_for(kPeriod);
          over_ = true;
        }) {}

  [[nodiscard]] const std::atomic<bool>* over() const noexcept { return &over_; }

 private:
  std::atomic<bool> over_ = false;
  std::jthread thread_;
};

Result<FirstLook> look(const sources::SourceName& name, sources::SourceOptions options) {
  FirstLook found;
  const Patience patience(options.stop);
  options.stop = patience.over();
  const auto log = std::move(options.notice);
  options.notice = [&](const std::string& line) {
    found.message = line;
    if (log) log(line);
  };
  const Result<std::unique_ptr<FrameSource>> source = sources::open_source(name, options);
  if (!source) return source.error();
  RawFrame frame;
  const Result<bool> came = (*source)->next(frame);
  if (!came && came.error().kind != ErrorKind::bad_input) return came.error();
  if (!came) found.message = came.error().message;
  if (came && *came) found.shape = (*source)->shape();
  if (came && !*came && found.message.empty()) found.message = "nothing came within 8 s";
  return found;
}

nlohmann::ordered_json json_of(const std::string& from, const FirstLook& found) {
  nlohmann::ordered_json json;
  json["name"] = "";
  json["arrays"] = nlohmann::ordered_json::array();
  nlohmann::ordered_json& setup = json["setup"];
  setup["from"] = from;
  setup["rows"] = found.shape ? nlohmann::ordered_json(found.shape->rows) : nlohmann::ordered_json();
  setup["cols"] = found.shape ? nlohmann::ordered_json(found.shape->cols) : nlohmann::ordered_json();
  setup["message"] = found.message;
  return json;
}

bool is_file_name(std::string_view name) {
  const auto is_plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
  return !name.empty() && std::ranges::all_of(name, is_plain);
}

Result<std::uint64_t> whole(const JsonRequest& request, const char* field, const char* wanted) {
  const Result<std::optional<std::uint64_t>> number = request.number(field, wanted);
  if (!number) return number.error();
  if (!*number) return bad_field(field, std::string("must be ") + wanted);
  return **number;
}

/// {"name": "mat", "rows": 12, "cols": 10, "pitch_um": 10000, "adc_bits": 12}
Result<ArrayDescription> array_of(std::string_view text) {
  const Result<JsonRequest> request = JsonRequest::parse(text);
  if (!request) return request.error();
  const Result<std::string> name = request->text("name");
  if (!name) return name.error();
  if (!is_file_name(*name)) return bad_field("name", "must be letters, digits, '_' and '-'");
  const auto rows = whole(*request, "rows", "1 to 1024");
  const auto cols = whole(*request, "cols", "1 to 1024");
  const auto pitch_um = whole(*request, "pitch_um", "a whole number of micrometres");
  const auto adc_bits = whole(*request, "adc_bits", "1 to 24");
  for (const auto* number : {&rows, &cols, &pitch_um, &adc_bits}) {
    if (!*number) return number->error();
  }
  ArrayDescription array;
  array.name = *name;
  array.rows = *rows;
  array.cols = *cols;
  array.row_pitch_m = array.col_pitch_m = 1e-6 * static_cast<double>(*pitch_um);
  array.readout.circuit = Circuit::automatic;
  array.readout.adc_bits = static_cast<int>(std::min<std::uint64_t>(*adc_bits, 99));
  if (Status valid = array.validate(); !valid) return valid.error();
  return array;
}

}  // namespace

class ArraySetup::Implementation {
 public:
  Implementation(std::unique_ptr<stream::Server> server, const std::string& suit_json) : server_(std::move(server)) {
    server_->set_document("/suit.json", "application/json", suit_json);
    server_->start({}, {{"/array/describe", [this](std::string_view request) { return describe(request); }}});
  }

  [[nodiscard]] std::uint16_t port() const noexcept { return server_->port(); }

  std::string run(const std::atomic<bool>& stop) {
    while (!stop) {
      if (std::string path = written(); !path.empty()) {
        std::this_thread::sleep_for(kToAnswer);
        return path;
      }
      std::this_thread::sleep_for(kPeriod);
    }
    return {};
  }

 private:
  [[nodiscard]] std::string written() {
    const std::lock_guard lock(mutex_);
    return written_;
  }

  Result<std::string> describe(std::string_view request) {
    const Result<ArrayDescription> array = array_of(request);
    if (!array) return array.error();
    const std::string path = array->name + ".toml";
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) {
      return bad_field("name",
                       path + " is there already: choose another name, or serve it as the model of this source");
    }
    if (Status status = files::write_array(path, *array); !status) return status.error();
    const std::lock_guard lock(mutex_);
    written_ = path;
    return json_text(nlohmann::json{{"file", path}});
  }

  std::mutex mutex_;
  std::string written_;
  std::unique_ptr<stream::Server> server_;
};

Result<std::unique_ptr<ArraySetup>> ArraySetup::create(const std::string& from, const SessionOptions& options,
                                                       sources::SourceOptions source_options) {
  const Result<sources::SourceName> name = sources::SourceName::parse(from);
  if (!name) return name.error();
  const Result<FirstLook> found = look(*name, std::move(source_options));
  if (!found) return found.error();
  Result<std::unique_ptr<stream::Server>> server = stream::Server::create(options.server, options.page);
  if (!server) return server.error();
  return std::unique_ptr<ArraySetup>(
      new ArraySetup(std::make_unique<Implementation>(*std::move(server), json_text(json_of(from, *found)))));
}

ArraySetup::ArraySetup(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

ArraySetup::~ArraySetup() = default;

std::uint16_t ArraySetup::port() const noexcept {
  return implementation_->port();
}

std::string ArraySetup::run(const std::atomic<bool>& stop) {
  return implementation_->run(stop);
}

}  // namespace dermis::serve
