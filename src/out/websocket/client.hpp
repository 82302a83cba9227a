// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/websocket/foxglove_protocol.hpp"
#include "out/websocket/outgoing_queue.hpp"
#include "out/websocket/taken_window.hpp"

namespace dermis::out::websocket {

/// The addressees of clients' requests: the owner of the server, and its offers.
struct Offer {
  Handlers handlers{};
  std::vector<Service> services{};
  std::optional<PlaybackService> playback{};
};

/// Told when the number of subscriptions to a channel changes, by +1 or -1.
using SubscriptionsChanged = std::function<void(ChannelId channel, int change)>;

class Client;
/// The question to the owner, which may take its time, and the following action for the client. An empty one: not yet;
/// the question is to be asked again within 50 ms.
using Answer = std::function<void(Client&)>;
using Question = std::function<Answer()>;
/// Has a question answered, one after the other, on any thread; the answer comes on the client's, if that is still
/// there.
using Ask = std::function<void(Question)>;

/// One client of the stream, as the protocol has it: its requests and its waiting messages. Knows no socket. Not
/// thread-safe. Many members: its subscriptions, its waiting messages, and its progress.
class Client {
 public:
  /// `offer` must outlive it and its questions. `address`: "127.0.0.1:53412". `is_sdk`: speaks foxglove.sdk.v1, which
  /// has playback.
  Client(const Offer& offer, std::string address, bool is_sdk, std::size_t queue_bytes, SubscriptionsChanged changed,
         Ask ask);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client();

  /// Announces the offer. Call it once.
  void greet(const std::string& name, const std::string& session, std::span<const Channel> channels);
  /// Once for each channel, in the order of their ids; those that it knows by greet() are left out.
  void advertise(const Channel& channel);

  /// A message of the client, which asks once at most. An error: it does not speak the protocol.
  [[nodiscard]] Status receive(std::span<const std::uint8_t> bytes, bool is_text);

  /// Queues the message where the client has subscribed to the channel; messages and drops are counted on. Where the
  /// client is behind, pictures are left out, and pieces: all those of a time, or none.
  void publish(ChannelId channel, Nanos log_time, const SharedBytes& bytes, MessageKind kind,
               ServerStatistics& statistics);
  void send_parameters(std::span<const Parameter> all);
  /// `answered`: the request that it answers, if it answers one.
  void send_playback(const PlaybackStatus& status, const PlaybackRequest& answered = {});
  void send_status(int level, std::string_view message);

  [[nodiscard]] OutgoingQueue& queue() noexcept { return queue_; }
  /// More than its greeting and `queue_bytes` wait for it that are no data.
  [[nodiscard]] bool asks_and_does_not_read() const noexcept { return queue_.control_bytes() > most_control_bytes_; }

 private:
  void handle(const OtherRequest&) {}
  void handle(const Subscribe& request);
  void handle(const Unsubscribe& request);
  void handle(const GetParameters& request);
  void handle(const SetParameters& request);
  void handle(const FollowParameters& request);
  void handle(const ServiceCall& request);
  void handle(const PlaybackRequest& request);
  void handle(const Taken& taken);
  void ask(Question question);
  void follow(const FollowParameters& request, std::span<const Parameter> all);

  /// The pieces of one time, between which those of other arrays may come.
  struct Moment {
    Nanos time{};
    ChannelId first = 0;
    bool is_taken = true;
  };
  [[nodiscard]] bool takes_piece(ChannelId channel, Nanos time);
  [[nodiscard]] bool takes_picture();

  const Offer& offer_;
  std::string address_;
  bool is_sdk_;
  SubscriptionsChanged changed_;
  Ask ask_;
  OutgoingQueue queue_;
  std::size_t most_control_bytes_;
  ChannelId next_channel_ = 0;                          // the first that it has not heard of
  std::map<std::uint32_t, ChannelId> channel_of_;       // by subscription
  std::map<ChannelId, std::uint32_t> subscription_of_;  // by channel; one each
  std::set<std::string, std::less<>> followed_;
  TakenWindow taken_;
  std::deque<Moment> moments_;       // the last few
  bool has_taken_ = true;            // the last picture
  std::uint64_t picture_begin_ = 0;  // of queue_.binary_bytes()
  std::uint64_t picture_bytes_ = 0;  // of the last picture that it took
  bool is_asking_ = false;           // its messages meanwhile are not read
};

}  // namespace dermis::out::websocket
