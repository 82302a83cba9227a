// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/foxglove_protocol.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace dermis::out::websocket {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "numbers are copied as the machine holds them");

constexpr std::size_t kMostItems = 10'000;  // subscriptions, names, parameters in one request
constexpr int kDeepest = 8;                 // levels of JSON in a request

constexpr std::uint8_t kServiceCallRequest = 2;
constexpr std::uint8_t kPlaybackControl = 3;
constexpr std::uint8_t kMessageData = 1;
constexpr std::uint8_t kServiceCallResponse = 3;
constexpr std::uint8_t kPlaybackState = 5;

/// nlohmann parses any depth by recursion in its destructors: too deep a text is refused before.
bool is_shallow(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) return false;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return true;
}

const json* find_array(const json& object, const char* key) {
  const auto found = object.find(key);
  const bool usable = found != object.end() && found->is_array() && found->size() <= kMostItems;
  return usable ? &*found : nullptr;
}

std::optional<std::uint32_t> as_id(const json& value) {
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    return static_cast<std::uint32_t>(number);
  }
  const auto number = value.get<std::int64_t>();
  if (number < 0 || number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::uint32_t> find_id(const json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) return std::nullopt;
  return as_id(*found);
}

std::string find_text(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Error no_list(const char* key) {
  return bad_input(std::string("'") + key + "' is not a list of what it should hold");
}

Result<ClientRequest> parse_subscribe(const json& message) {
  const json* list = find_array(message, "subscriptions");
  if (list == nullptr) return no_list("subscriptions");
  Subscribe request;
  for (const json& entry : *list) {
    const std::optional<std::uint32_t> id = find_id(entry, "id");
    const std::optional<std::uint32_t> channel = find_id(entry, "channelId");
    if (!id || !channel) return no_list("subscriptions");
    request.subscriptions.push_back({*id, *channel});
  }
  return ClientRequest(std::move(request));
}

Result<ClientRequest> parse_unsubscribe(const json& message) {
  const json* list = find_array(message, "subscriptionIds");
  if (list == nullptr) return no_list("subscriptionIds");
  Unsubscribe request;
  for (const json& entry : *list) {
    const std::optional<std::uint32_t> id = as_id(entry);
    if (!id) return no_list("subscriptionIds");
    request.ids.push_back(*id);
  }
  return ClientRequest(std::move(request));
}

Result<std::vector<std::string>> parse_names(const json& message) {
  const json* list = find_array(message, "parameterNames");
  if (list == nullptr) return no_list("parameterNames");
  std::vector<std::string> names;
  for (const json& entry : *list) {
    if (!entry.is_string()) return no_list("parameterNames");
    names.push_back(entry.get<std::string>());
  }
  return names;
}

std::optional<ParameterValue> parse_value(const json& value) {
  if (value.is_boolean()) return ParameterValue(value.get<bool>());
  if (value.is_number()) return ParameterValue(value.get<double>());
  if (value.is_string()) return ParameterValue(value.get<std::string>());
  if (!value.is_array() || value.size() > kMostItems) return std::nullopt;
  std::vector<double> numbers;
  for (const json& entry : value) {
    if (!entry.is_number()) return std::nullopt;
    numbers.push_back(entry.get<double>());
  }
  return ParameterValue(std::move(numbers));
}

Result<ClientRequest> parse_set_parameters(const json& message) {
  const json* list = find_array(message, "parameters");
  if (list == nullptr) return no_list("parameters");
  SetParameters request{{}, find_text(message, "id")};
  for (const json& entry : *list) {
    if (!entry.is_object()) return no_list("parameters");
    Parameter parameter{find_text(entry, "name"), {}};
    if (parameter.name.empty()) return no_list("parameters");
    if (const auto value = entry.find("value"); value != entry.end() && !value->is_null()) {
      std::optional<ParameterValue> parsed = parse_value(*value);
      if (!parsed) return bad_input("a parameter has a value of no known type");
      parameter.value = std::move(*parsed);
    }
    request.parameters.push_back(std::move(parameter));
  }
  return ClientRequest(std::move(request));
}

Result<ClientRequest> parse_get_parameters(const json& message) {
  Result<std::vector<std::string>> names = parse_names(message);
  if (!names) return names.error();
  return ClientRequest(GetParameters{std::move(*names), find_text(message, "id")});
}

Result<ClientRequest> parse_follow_parameters(const json& message, bool follow) {
  Result<std::vector<std::string>> names = parse_names(message);
  if (!names) return names.error();
  return ClientRequest(FollowParameters{std::move(*names), follow});
}

Result<ClientRequest> parse_taken(const json& message) {
  const auto bytes = message.find("bytes");
  if (bytes == message.end() || !bytes->is_number_unsigned()) return bad_input("'taken' without its bytes");
  return ClientRequest(Taken{bytes->get<std::uint64_t>()});
}

/// Reads a binary message; missing parts read as 0 or empty, and good() is false from then on.
class BinaryReader {
 public:
  explicit BinaryReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] bool at_end() const noexcept { return rest_.empty(); }

  template <typename T>
  T read() {
    T value{};
    const std::string_view bytes = read_text(sizeof(T));
    if (good_) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  std::string_view read_text(std::size_t size) {
    good_ = good_ && size <= rest_.size();
    if (!good_) return {};
    const std::string_view taken(reinterpret_cast<const char*>(rest_.data()), size);
    rest_ = rest_.subspan(size);
    return taken;
  }
  std::string_view read_rest() { return read_text(rest_.size()); }

 private:
  std::span<const std::uint8_t> rest_;
  bool good_ = true;
};

Result<ClientRequest> parse_service_call(BinaryReader reader) {
  ServiceCall call;
  call.service = reader.read<std::uint32_t>();
  call.call = reader.read<std::uint32_t>();
  call.encoding = reader.read_text(reader.read<std::uint32_t>());
  call.request = reader.read_rest();
  if (!reader.good()) return bad_input("a service call that ends too early");
  return ClientRequest(std::move(call));
}

Result<ClientRequest> parse_playback_control(BinaryReader reader) {
  const auto command = reader.read<std::uint8_t>();
  PlaybackRequest request;
  request.command.play = command == 0;
  const auto speed = reader.read<float>();
  const bool seeks = reader.read<std::uint8_t>() != 0;
  const auto nanos = reader.read<std::uint64_t>();
  request.id = reader.read_text(reader.read<std::uint32_t>());
  if (!reader.good() || command > 1) return bad_input("a playback control that is none");
  const bool speed_is_good = speed > 0.0F && speed <= 1e6F;
  if (!speed_is_good) return bad_input("a playback control with a speed that is not above 0");
  request.command.speed = static_cast<double>(speed);
  if (seeks) {
    if (nanos > static_cast<std::uint64_t>(Nanos::max().count())) return bad_input("a seek to a time out of range");
    request.command.seek = Nanos(static_cast<std::int64_t>(nanos));
  }
  return ClientRequest(std::move(request));
}

std::string dump(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

json time_json(Nanos time) {
  const std::int64_t seconds = time.count() / 1'000'000'000;
  return {{"sec", seconds}, {"nsec", time.count() - seconds * 1'000'000'000}};
}

json parameter_json(const Parameter& parameter) {
  json entry = {{"name", parameter.name}};
  if (const auto* flag = std::get_if<bool>(&parameter.value)) entry["value"] = *flag;
  if (const auto* text = std::get_if<std::string>(&parameter.value)) entry["value"] = *text;
  if (const auto* number = std::get_if<double>(&parameter.value)) {
    entry["value"] = *number;
    entry["type"] = "float64";
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&parameter.value)) {
    entry["value"] = *numbers;
    entry["type"] = "float64_array";
  }
  return entry;
}

template <typename T>
void append(std::vector<std::uint8_t>& bytes, T value) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof(T));
  std::memcpy(bytes.data() + size, &value, sizeof(T));
}

void append_text(std::vector<std::uint8_t>& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

std::uint8_t code_of(PlaybackStatus::State state) {
  switch (state) {
    case PlaybackStatus::State::playing: return 0;
    case PlaybackStatus::State::paused: return 1;
    case PlaybackStatus::State::ended: break;
  }
  return 3;  // 2 is "buffering"
}

}  // namespace

std::string_view choose_subprotocol(std::string_view offered) {
  std::string_view chosen;
  while (!offered.empty()) {
    const std::size_t comma = std::min(offered.find(','), offered.size());
    std::string_view name = offered.substr(0, comma);
    offered.remove_prefix(std::min(comma + 1, offered.size()));
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    if (name == kSdkSubprotocol) return kSdkSubprotocol;
    if (name == kWebsocketSubprotocol) chosen = kWebsocketSubprotocol;
  }
  return chosen;
}

Result<ClientRequest> parse_text_request(std::string_view text) {
  if (!is_shallow(text)) return bad_input("JSON of more than " + std::to_string(kDeepest) + " levels");
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return bad_input("a text that is not a JSON object");
  const std::string operation = find_text(message, "op");
  if (operation == "subscribe") return parse_subscribe(message);
  if (operation == "unsubscribe") return parse_unsubscribe(message);
  if (operation == "getParameters") return parse_get_parameters(message);
  if (operation == "setParameters") return parse_set_parameters(message);
  if (operation == "subscribeParameterUpdates") return parse_follow_parameters(message, true);
  if (operation == "unsubscribeParameterUpdates") return parse_follow_parameters(message, false);
  if (operation == "taken") return parse_taken(message);
  if (operation.empty()) return bad_input("a JSON object without 'op'");
  return ClientRequest(OtherRequest{});
}

Result<ClientRequest> parse_binary_request(std::span<const std::uint8_t> bytes) {
  BinaryReader reader(bytes);
  switch (reader.read<std::uint8_t>()) {
    case kServiceCallRequest: return parse_service_call(reader);
    case kPlaybackControl: return parse_playback_control(reader);
    default: return bad_input("a binary message of no known opcode");
  }
}

std::string server_info_text(const ServerInfo& info) {
  json capabilities = json::array();
  if (info.has_parameters) capabilities.insert(capabilities.end(), {"parameters", "parametersSubscribe"});
  if (info.has_services) capabilities.push_back("services");
  if (info.playback) capabilities.push_back("playbackControl");
  json message = {{"op", "serverInfo"},
                  {"name", info.name},
                  {"capabilities", std::move(capabilities)},
                  {"sessionId", info.session},
                  {"supportedEncodings", json::array({"json"})}};
  if (info.playback) {
    message["dataStartTime"] = time_json(info.playback->first);
    message["dataEndTime"] = time_json(info.playback->second);
  }
  return dump(message);
}

std::string advertise_text(std::span<const Channel> channels) {
  json list = json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel.schema_name},
                    {"schemaEncoding", "ros2msg"},
                    {"schema", channel.schema}});
  }
  return dump({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string advertise_services_text(std::span<const Service> services) {
  const json any = {{"encoding", "json"},
                    {"schemaName", "object"},
                    {"schemaEncoding", "jsonschema"},
                    {"schema", R"({"type":"object"})"}};
  json list = json::array();
  for (std::size_t i = 0; i < services.size(); ++i) {
    list.push_back(
        {{"id", i}, {"name", services[i].name}, {"type", services[i].name}, {"request", any}, {"response", any}});
  }
  return dump({{"op", "advertiseServices"}, {"services", std::move(list)}});
}

std::string parameter_values_text(std::span<const Parameter> parameters, std::string_view id) {
  json list = json::array();
  for (const Parameter& parameter : parameters) list.push_back(parameter_json(parameter));
  json message = {{"op", "parameterValues"}, {"parameters", std::move(list)}};
  if (!id.empty()) message["id"] = id;
  return dump(message);
}

std::string status_text(int level, std::string_view message) {
  return dump({{"op", "status"}, {"level", level}, {"message", message}});
}

std::string service_failure_text(const ServiceCall& call, std::string_view message) {
  return dump({{"op", "serviceCallFailure"}, {"serviceId", call.service}, {"callId", call.call}, {"message", message}});
}

MessageDataHeader message_data_header(std::uint32_t subscription, Nanos log_time) {
  MessageDataHeader header{kMessageData};
  const auto nanos = static_cast<std::uint64_t>(log_time.count());
  std::memcpy(header.data() + 1, &subscription, sizeof(subscription));
  std::memcpy(header.data() + 5, &nanos, sizeof(nanos));
  return header;
}

std::vector<std::uint8_t> service_response(const ServiceCall& call, std::string_view response) {
  std::vector<std::uint8_t> bytes;
  append(bytes, kServiceCallResponse);
  append(bytes, call.service);
  append(bytes, call.call);
  append(bytes, static_cast<std::uint32_t>(call.encoding.size()));
  append_text(bytes, call.encoding);
  append_text(bytes, response);
  return bytes;
}

std::vector<std::uint8_t> playback_state(const PlaybackStatus& status, const PlaybackRequest& answered) {
  std::vector<std::uint8_t> bytes;
  append(bytes, kPlaybackState);
  append(bytes, code_of(status.state));
  append(bytes, static_cast<std::uint64_t>(status.now.count()));
  append(bytes, static_cast<float>(status.speed));
  append(bytes, static_cast<std::uint8_t>(answered.command.seek ? 1 : 0));
  append(bytes, static_cast<std::uint32_t>(answered.id.size()));
  append_text(bytes, answered.id);
  return bytes;
}

}  // namespace dermis::out::websocket
