// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/client.hpp"

#include <algorithm>
#include <utility>

namespace dermis::out::websocket {
namespace {

constexpr std::size_t kMostSubscriptions = 10'000;
constexpr std::size_t kMostMoments = 8;  // frames that arrays are sending at once
constexpr int kErrorLevel = 2;

using Names = std::set<std::string, std::less<>>;

/// Those of these names; no names: all.
std::vector<Parameter> parameters_of(const Offer& offer, const Names& names) {
  if (!offer.handlers.parameters) return {};
  std::vector<Parameter> all = offer.handlers.parameters();
  if (!names.empty()) {
    std::erase_if(all, [&](const Parameter& parameter) { return !names.contains(parameter.name); });
  }
  return all;
}

/// Returns the errors.
std::vector<std::string> set_parameters(const Offer& offer, std::span<const Parameter> parameters,
                                        const std::string& client) {
  std::vector<std::string> errors;
  if (!offer.handlers.set_parameter) return errors;
  for (const Parameter& parameter : parameters) {
    const Status set = offer.handlers.set_parameter(parameter, client);
    if (!set) errors.push_back(set.error().message);
  }
  return errors;
}

Later answer_of(const Service& service, const std::string& request) {
  Result<Later> begun = service.begin ? service.begin(request)
                                      : Later([answer = service.call(request)] { return std::optional(answer); });
  if (begun) return *std::move(begun);
  return [error = begun.error()] { return std::optional<Result<std::string>>(error); };
}

}  // namespace

Client::Client(const Offer& offer, std::string address, bool is_sdk, std::size_t queue_bytes,
               SubscriptionsChanged changed, Ask ask)
    : offer_(offer),
      address_(std::move(address)),
      is_sdk_(is_sdk),
      changed_(std::move(changed)),
      ask_(std::move(ask)),
      queue_(queue_bytes),
      most_control_bytes_(queue_bytes) {}

Client::~Client() {
  for (const auto& [subscription, channel] : channel_of_) changed_(channel, -1);
}

void Client::greet(const std::string& name, const std::string& session, std::span<const Channel> channels) {
  ServerInfo info{name, session, offer_.handlers.parameters != nullptr, !offer_.services.empty()};
  if (is_sdk_ && offer_.playback) info.playback.emplace(offer_.playback->start, offer_.playback->end);
  queue_.push_text(server_info_text(info));
  if (!channels.empty()) {
    queue_.push_text(advertise_text(channels));
    next_channel_ = channels.back().id + 1;
  }
  if (!offer_.services.empty()) queue_.push_text(advertise_services_text(offer_.services));
  most_control_bytes_ += queue_.control_bytes();
}

void Client::advertise(const Channel& channel) {
  if (channel.id < next_channel_) return;
  queue_.push_text(advertise_text({&channel, 1}));
  next_channel_ = channel.id + 1;
}

Status Client::receive(std::span<const std::uint8_t> bytes, bool is_text) {
  const Result<ClientRequest> request =
      is_text ? parse_text_request({reinterpret_cast<const char*>(bytes.data()), bytes.size()})
              : parse_binary_request(bytes);
  if (!request) return request.error();
  std::visit([this](const auto& known) { handle(known); }, *request);
  return Done{};
}

void Client::publish(ChannelId channel, Nanos log_time, const SharedBytes& bytes, MessageKind kind,
                     ServerStatistics& statistics) {
  const auto subscription = subscription_of_.find(channel);
  if (subscription == subscription_of_.end()) return;
  const bool is_taken =
      kind == MessageKind::event || (kind == MessageKind::picture ? takes_picture() : takes_piece(channel, log_time));
  if (!is_taken) {
    ++statistics.dropped;
    return;
  }
  statistics.dropped += queue_.push_data(subscription->second, log_time, bytes);
  ++statistics.messages;
}

/// As the first piece of its time. Where that comes again, the picture does: in a recording that is shown once more.
bool Client::takes_piece(ChannelId channel, Nanos time) {
  const auto known = std::ranges::find(moments_, time, &Moment::time);
  if (known == moments_.end()) {
    if (moments_.size() == kMostMoments) moments_.pop_front();
    moments_.push_back({time, channel, takes_picture()});
    return moments_.back().is_taken;
  }
  const bool goes_on = known->is_taken && time == moments_.back().time;  // with another array of the same time
  if (known->first == channel && !goes_on) known->is_taken = takes_picture();
  return known->is_taken;
}

bool Client::takes_picture() {
  // Old messages that were dropped meanwhile may leave less than there was.
  const std::uint64_t bytes = queue_.binary_bytes();
  if (has_taken_) picture_bytes_ = bytes - std::min(picture_begin_, bytes);
  picture_begin_ = bytes;
  has_taken_ = is_asking_ || taken_.is_open(bytes, picture_bytes_);
  return has_taken_;
}

void Client::send_parameters(std::span<const Parameter> all) {
  std::vector<Parameter> followed;
  std::copy_if(all.begin(), all.end(), std::back_inserter(followed),
               [this](const Parameter& parameter) { return followed_.contains(parameter.name); });
  if (!followed.empty()) queue_.push_text(parameter_values_text(followed, {}));
}

void Client::send_playback(const PlaybackStatus& status, const PlaybackRequest& answered) {
  if (is_sdk_) queue_.push_binary(playback_state(status, answered));
}

void Client::send_status(int level, std::string_view message) {
  queue_.push_text(status_text(level, message));
}

void Client::handle(const Subscribe& request) {
  for (const auto& [id, channel] : request.subscriptions) {
    if (channel_of_.size() >= kMostSubscriptions) return send_status(kErrorLevel, "too many subscriptions");
    if (subscription_of_.contains(channel) || !channel_of_.emplace(id, channel).second) {
      send_status(kErrorLevel, "subscription " + std::to_string(id) + " or its channel is subscribed already");
      continue;
    }
    subscription_of_.emplace(channel, id);
    changed_(channel, +1);
  }
}

void Client::handle(const Unsubscribe& request) {
  for (const std::uint32_t id : request.ids) {
    const auto found = channel_of_.find(id);
    if (found == channel_of_.end()) continue;
    subscription_of_.erase(found->second);
    changed_(found->second, -1);
    channel_of_.erase(found);
  }
}

void Client::handle(const Taken& taken) {
  taken_.take(taken.bytes, queue_.binary_bytes(), TakenWindow::Clock::now());
}

/// Until it is answered, nothing else of the client is read.
void Client::ask(Question question) {
  is_asking_ = true;
  ask_([question = std::move(question)]() -> Answer {
    Answer answer = question();
    if (!answer) return answer;
    return [answer = std::move(answer)](Client& client) {
      client.is_asking_ = false;
      answer(client);
    };
  });
}

void Client::handle(const GetParameters& request) {
  ask([&offer = offer_, request]() -> Answer {
    const Names names(request.names.begin(), request.names.end());
    return [text = parameter_values_text(parameters_of(offer, names), request.id)](Client& client) {
      client.queue_.push_text(text);
    };
  });
}

void Client::handle(const SetParameters& request) {
  ask([&offer = offer_, request, address = address_]() -> Answer {
    const std::vector<std::string> errors = set_parameters(offer, request.parameters, address);
    Names names;
    for (const Parameter& parameter : request.parameters) names.insert(parameter.name);
    std::string text;
    if (!request.id.empty()) text = parameter_values_text(parameters_of(offer, names), request.id);
    return [errors, text](Client& client) {
      for (const std::string& error : errors) client.send_status(kErrorLevel, error);
      if (!text.empty()) client.queue_.push_text(text);
    };
  });
}

void Client::handle(const FollowParameters& request) {
  ask([&offer = offer_, request]() -> Answer {
    return [request, all = parameters_of(offer, {})](Client& client) { client.follow(request, all); };
  });
}

/// No names: all.
void Client::follow(const FollowParameters& request, std::span<const Parameter> all) {
  const Names names(request.names.begin(), request.names.end());
  for (const Parameter& parameter : all) {
    if (!names.empty() && !names.contains(parameter.name)) continue;
    if (request.follow) {
      followed_.insert(parameter.name);
    } else {
      followed_.erase(parameter.name);
    }
  }
  if (request.follow) send_parameters(all);
}

void Client::handle(const ServiceCall& request) {
  if (request.service >= offer_.services.size()) {
    return queue_.push_text(service_failure_text(request, "there is no such service"));
  }
  if (request.encoding != "json") return queue_.push_text(service_failure_text(request, "the encoding must be 'json'"));
  ask([&offer = offer_, request, later = Later()]() mutable -> Answer {
    if (!later) later = answer_of(offer.services[request.service], request.request);
    const std::optional<Result<std::string>> answer = later();
    if (!answer) return {};
    return [request, answer = *answer](Client& client) {
      if (!answer) return client.queue_.push_text(service_failure_text(request, answer.error().message));
      client.queue_.push_binary(service_response(request, *answer));
    };
  });
}

void Client::handle(const PlaybackRequest& request) {
  if (!offer_.playback) return;
  ask([&offer = offer_, request]() -> Answer {
    return [request, status = offer.playback->control(request.command)](Client& client) {
      client.send_playback(status, request);
    };
  });
}

}  // namespace dermis::out::websocket
