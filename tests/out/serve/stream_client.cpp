// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/stream_client.hpp"

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <cstring>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace dermis::out::serve {

using nlohmann::json;
namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;

class StreamClient::Implementation {
 public:
  explicit Implementation(std::uint16_t port) : socket_(context_) {
    socket_.next_layer().connect({asio::ip::make_address("127.0.0.1"), port});
    socket_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(boost::beast::http::field::sec_websocket_protocol, "foxglove.sdk.v1");
    }));
    socket_.handshake("127.0.0.1", "/");
  }

  void send(const json& request) {
    socket_.text(true);
    socket_.write(asio::buffer(request.dump()));
  }

  void subscribe(const std::vector<std::string>& topics) {
    json list = json::array();
    for (const std::string& topic : topics) {
      while (!channels_.contains(topic)) receive();
      topics_[channels_[topic]] = topic;
      list.push_back({{"id", channels_[topic]}, {"channelId", channels_[topic]}});
    }
    send({{"op", "subscribe"}, {"subscriptions", list}});
  }

  Message next_message() {
    while (messages_.empty()) receive();
    Message message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }

  std::string parameters(json request) {
    request["id"] = "asked";
    send(request);
    return answer();
  }

  std::string call(const std::string& service, const std::string& request) {
    while (!services_.contains(service)) receive();
    std::string bytes(1, '\x02');
    const auto append = [&](std::uint32_t number) { bytes.append(reinterpret_cast<const char*>(&number), 4); };
    append(services_[service]);
    append(1);
    append(4);
    bytes += "json" + request;
    socket_.binary(true);
    socket_.write(asio::buffer(bytes));
    return answer();
  }

 private:
  std::string answer() {
    while (!answer_) receive();
    return *std::exchange(answer_, std::nullopt);
  }

  void receive() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer);
    const auto* const data = static_cast<const std::uint8_t*>(buffer.data().data());
    const std::vector<std::uint8_t> bytes(data, data + buffer.size());
    socket_.got_text() ? take_text(json::parse(bytes)) : take_binary(bytes);
  }

  void take_text(const json& message) {
    const std::string operation = message["op"];
    if (operation == "advertise") {
      for (const json& channel : message["channels"]) channels_[channel["topic"]] = channel["id"];
    } else if (operation == "advertiseServices") {
      for (const json& service : message["services"]) services_[service["name"]] = service["id"];
    } else if (operation == "parameterValues" && message.contains("id")) {
      answer_ = message["parameters"].dump();
    } else if (operation == "serviceCallFailure") {
      answer_ = message["message"];
    }
  }

  void take_binary(const std::vector<std::uint8_t>& bytes) {
    const auto number_at = [&]<typename Number>(std::size_t at, Number number) {
      std::memcpy(&number, bytes.data() + at, sizeof number);
      return number;
    };
    const auto rest_from = [&](std::size_t at) {
      return std::vector<std::uint8_t>(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end());
    };
    if (bytes.at(0) == 1) {
      const Nanos time(static_cast<std::int64_t>(number_at(5, std::uint64_t{})));
      messages_.push_back({topics_.at(number_at(1, std::uint32_t{})), time, rest_from(13)});
    } else if (bytes.at(0) == 3) {
      const std::vector<std::uint8_t> response = rest_from(13 + number_at(9, std::uint32_t{}));
      answer_ = std::string(response.begin(), response.end());
    }
  }

  asio::io_context context_;
  websocket::stream<asio::ip::tcp::socket> socket_;
  std::map<std::string, std::uint32_t> channels_;
  std::map<std::string, std::uint32_t> services_;
  std::map<std::uint32_t, std::string> topics_;  // by subscription
  std::deque<Message> messages_;
  std::optional<std::string> answer_;
};

StreamClient::StreamClient(std::uint16_t port) : implementation_(std::make_unique<Implementation>(port)) {}

StreamClient::~StreamClient() = default;

void StreamClient::subscribe(const std::vector<std::string>& topics) {
  implementation_->subscribe(topics);
  parameters();
}

StreamClient::Message StreamClient::next_message() {
  return implementation_->next_message();
}

StreamClient::Message StreamClient::next_message(const std::string& topic) {
  for (;;) {
    Message message = next_message();
    if (message.topic == topic) return message;
  }
}

std::string StreamClient::parameters() {
  return implementation_->parameters({{"op", "getParameters"}, {"parameterNames", json::array()}});
}

std::string StreamClient::set_parameter(const std::string& name, const std::string& value) {
  return implementation_->parameters(
      {{"op", "setParameters"}, {"parameters", {{{"name", name}, {"value", json::parse(value)}}}}});
}

std::string StreamClient::call(const std::string& service, const std::string& request) {
  return implementation_->call(service, request);
}

}  // namespace dermis::out::serve
