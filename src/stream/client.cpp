// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "stream/client.hpp"

#include <algorithm>
#include <utility>

namespace dermis::stream {
namespace {

constexpr std::size_t kMostSubscriptions = 10'000;
constexpr std::size_t kMostFollowed = 10'000;
constexpr int kErrorLevel = 2;

}  // namespace

Client::Client(const Offer& offer, bool is_sdk, std::size_t queue_bytes, SubscriptionsChanged changed)
    : offer_(offer), is_sdk_(is_sdk), changed_(std::move(changed)), queue_(queue_bytes) {}

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

void Client::publish(ChannelId channel, Nanos log_time, const SharedBytes& bytes, ServerStatistics& statistics) {
  const auto subscription = subscription_of_.find(channel);
  if (subscription == subscription_of_.end()) return;
  statistics.dropped += queue_.push_data(subscription->second, log_time, bytes);
  ++statistics.messages;
}

void Client::tell_parameters(std::span<const Parameter> all) {
  std::vector<Parameter> followed;
  std::copy_if(all.begin(), all.end(), std::back_inserter(followed),
               [this](const Parameter& parameter) { return followed_.contains(parameter.name); });
  if (!followed.empty()) queue_.push_text(parameter_values_text(followed, {}));
}

void Client::tell_playback(const PlaybackState& state, std::string_view request_id) {
  if (is_sdk_) queue_.push_binary(playback_state(state, request_id));
}

void Client::tell_status(int level, std::string_view message) {
  queue_.push_text(status_text(level, message));
}

void Client::handle(const Subscribe& request) {
  for (const auto& [id, channel] : request.subscriptions) {
    if (channel_of_.size() >= kMostSubscriptions) return tell_status(kErrorLevel, "too many subscriptions");
    if (subscription_of_.contains(channel) || !channel_of_.emplace(id, channel).second) {
      tell_status(kErrorLevel, "subscription " + std::to_string(id) + " or its channel is subscribed already");
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

std::vector<Parameter> Client::parameters(const std::set<std::string, std::less<>>& names) const {
  if (!offer_.handlers.parameters) return {};
  std::vector<Parameter> all = offer_.handlers.parameters();
  if (!names.empty()) {
    std::erase_if(all, [&](const Parameter& parameter) { return !names.contains(parameter.name); });
  }
  return all;
}

void Client::handle(const GetParameters& request) {
  queue_.push_text(parameter_values_text(parameters({request.names.begin(), request.names.end()}), request.id));
}

void Client::handle(const SetParameters& request) {
  std::set<std::string, std::less<>> names;
  for (const Parameter& parameter : request.parameters) {
    names.insert(parameter.name);
    if (!offer_.handlers.set_parameter) continue;
    const Status set = offer_.handlers.set_parameter(parameter);
    if (!set) tell_status(kErrorLevel, set.error().message);
  }
  if (!request.id.empty()) queue_.push_text(parameter_values_text(parameters(names), request.id));
}

/// No names: all.
void Client::handle(const FollowParameters& request) {
  std::vector<std::string> names = request.names;
  if (names.empty()) {
    for (const Parameter& parameter : parameters({})) names.push_back(parameter.name);
  }
  for (const std::string& name : names) {
    if (!request.follow) {
      followed_.erase(name);
    } else if (followed_.size() < kMostFollowed) {
      followed_.insert(name);
    }
  }
  if (request.follow && !followed_.empty()) tell_parameters(parameters(followed_));
}

void Client::handle(const ServiceCall& request) {
  if (request.service >= offer_.services.size()) {
    return queue_.push_text(service_failure_text(request, "there is no such service"));
  }
  if (request.encoding != "json") return queue_.push_text(service_failure_text(request, "the encoding must be 'json'"));
  const Result<std::string> answer = offer_.services[request.service].call(request.request);
  if (!answer) return queue_.push_text(service_failure_text(request, answer.error().message));
  queue_.push_binary(service_response(request, *answer));
}

void Client::handle(const PlaybackRequest& request) {
  if (offer_.playback) tell_playback(offer_.playback->control(request.control), request.id);
}

}  // namespace dermis::stream
