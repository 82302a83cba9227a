// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/frame_topics.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "out/serve/parts/host.hpp"
#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {
namespace {

using websocket::MessageKind;

constexpr std::size_t kBytesOfHeader = 128;
constexpr std::size_t kBytesOfAPoint = 20;
constexpr Nanos kPresent = std::chrono::milliseconds(500);
constexpr Nanos kLate = std::chrono::milliseconds(20);  // the machine does not follow
constexpr std::uint64_t kShownOfLate = 10;              // every one of so many
constexpr double kSlowestHz = 1.0;
constexpr double kFastestHz = 1000.0;

/// The stream is thinned, DDS is not.
Ends ends_of(bool is_due) {
  return is_due ? Ends::both : Ends::dds;
}

}  // namespace

std::size_t raw_frame_bytes(const ArrayDescription& array) {
  return 2 * kBytesOfHeader + (array.taxel_count() + array.temperature_sensors.size()) * sizeof(float);
}

FrameTopics::Array::Array(const ServedSuit& suit, std::size_t index)
    : served(suit.arrays[index]),
      shape{served.model->array.rows, served.model->array.cols},
      pitch{served.model->array.row_pitch_m, served.model->array.col_pitch_m},
      contacts(suit, index),
      is_as_recorded(served.played.has_value()) {}

Result<std::unique_ptr<FrameTopics>> FrameTopics::create(const ServedSuit& suit, Topics& topics) {
  std::unique_ptr<FrameTopics> created(new FrameTopics(suit, topics));
  if (Status added = created->add_topics(); !added) return added.error();
  return created;
}

FrameTopics::FrameTopics(const ServedSuit& suit, Topics& topics) : suit_(suit), topics_(topics), points_(suit) {
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) arrays_.emplace_back(suit, k);
}

Status FrameTopics::add_topics() {
  std::size_t taxels = 0;
  for (Array& array : arrays_) {
    if (Status added = add_topics_of(array); !added) return added;
    taxels += array.shape.taxel_count();
  }
  const Result<Topic> contacts = topics_.add({"/contacts", "/contacts"}, bytes::ros_messages::contacts_type());
  const Result<Topic> points = topics_.add({"/suit/points", "/suit/points"}, bytes::ros_messages::point_cloud_type(),
                                           kBytesOfHeader + taxels * kBytesOfAPoint);
  const Result<Topic> wrench = topics_.add({.dds = "/suit/wrench"}, bytes::ros_messages::wrench_type());
  for (const auto* topic : {&contacts, &points, &wrench}) {
    if (!*topic) return topic->error();
  }
  contacts_topic_ = *contacts;
  points_topic_ = *points;
  wrench_topic_ = *wrench;
  return Done{};
}

Status FrameTopics::add_topics_of(Array& array) {
  const std::string prefix = "/" + array.served.name;
  const std::size_t image_bytes = kBytesOfHeader + array.shape.taxel_count() * sizeof(float);
  const bytes::ros_messages::MessageType& image = bytes::ros_messages::image_type();
  const bytes::ros_messages::MessageType& grid = bytes::ros_messages::grid_type();
  struct Wanted {
    Topic& topic;
    TopicNames names;
    const bytes::ros_messages::MessageType& type;
    std::size_t bytes = 0;
  };
  const std::size_t frame_bytes = raw_frame_bytes(array.served.model->array);
  const bytes::ros_messages::MessageType& wrench = bytes::ros_messages::wrench_type();
  for (const Wanted& wanted :
       {Wanted{array.frame, {.dds = prefix + "/frame"}, bytes::ros_messages::raw_frame_type(), frame_bytes},
        Wanted{array.raw, {prefix + "/raw", prefix + "/raw"}, image, image_bytes},
        Wanted{array.conductance, {.stream = prefix + "/conductance"}, grid, image_bytes},
        Wanted{array.force_grid, {.stream = prefix + "/force"}, grid, image_bytes},
        Wanted{array.force, {.dds = prefix + "/force"}, image, image_bytes},
        Wanted{array.force_sigma, {.dds = prefix + "/force_sigma"}, image, image_bytes},
        Wanted{array.wrench, {.dds = prefix + "/wrench"}, wrench, image_bytes}}) {
    const Result<Topic> added = topics_.add(wanted.names, wanted.type, wanted.bytes);
    if (!added) return added.error();
    wanted.topic = *added;
  }
  return Done{};
}

std::vector<LiveParameter> FrameTopics::parameters() {
  const auto set = [this](double value) -> Status {
    if (!(value >= kSlowestHz && value <= kFastestHz)) return bad_input("/stream/rate_hz: must be 1 to 1000");
    rate_hz_ = value;
    return Done{};
  };
  return {{.name = "/stream/rate_hz", .value = [this] { return rate_hz_.load(); }, .set_number = set}};
}

void FrameTopics::keep(std::size_t index, const RawFrame& frame) {
  Array& array = arrays_[index];
  if (!array.frame.is_wanted() || frame.counts.size() != array.shape.taxel_count()) return;
  bytes::ros_messages::encode_raw_frame(frame, array.shape, array.served.name, array.message);
  array.frame.publish(frame.time, array.message);
}

void FrameTopics::hear(const live::suits::ArrayResult& result) {
  Array& array = arrays_[result.array];
  if (is_as_recorded(array, result)) return hear_played(array, result);
  const bool due = array.pace.is_due(result.raw.time, rate_hz_) && has_time_for(array, result);
  publish_frame(array, result, due);
  publish_contacts(array, result, due);
  if (topics_.has_dds() && !has(result.force.status, FrameStatus::rejected)) publish_wrench(array, result);
}

void FrameTopics::publish_frame(Array& array, const live::suits::ArrayResult& result, bool is_due) {
  publish_images(array, result, is_due);
  if (points_topic_.is_wanted(ends_of(is_due))) points_.keep(result.array, result.force);
  if (is_due) stream_time_ns_ = result.raw.time.count();
  last_time_ns_ = result.raw.time.count();
}

/// The frames that were recorded with their forces are shown, with the same bits. `dermis record` writes no contacts.
void FrameTopics::hear_played(Array& array, const live::suits::ArrayResult& result) {
  const live::suits::PlayedResults played = suit_.playback->results(*array.served.played, result.raw.time);
  const Result<FrameShape> shape = bytes::ros_messages::decode_grid(played.force, array.played);
  if (shape && *shape == array.shape) {
    publish_frame(array,
                  {result.array, result.raw, result.conductance, array.played, result.report, result.contacts,
                   result.latency, result.tares},
                  true);
  }
  if (played.contacts.empty() && shape) return publish_contacts(array, result, true);
  if (played.contacts.empty() || !contacts_topic_.is_wanted()) return;
  contacts_topic_.publish(result.raw.time, played.contacts, Ends::both, MessageKind::piece);
}

/// Until somebody who looks on tares, or takes another model.
bool FrameTopics::is_as_recorded(const Array& array, const live::suits::ArrayResult& result) const {
  return array.is_as_recorded && result.tares == 0 && suit_.playback->has_results(*array.served.played);
}

void FrameTopics::model_changed(std::size_t array) {
  arrays_[array].is_as_recorded = false;
}

/// Contacts go before viewers: these get fewer of the frames that are late already.
bool FrameTopics::has_time_for(Array& array, const live::suits::ArrayResult& result) {
  if (result.latency < kLate || ++array.late % kShownOfLate == 0) return true;
  topics_.thin();
  return false;
}

void FrameTopics::publish_images(Array& array, const live::suits::ArrayResult& result, bool is_due) {
  const std::string& frame_id = array.served.name;
  const std::size_t taxels = array.shape.taxel_count();
  const Nanos time = result.raw.time;
  if (array.raw.is_wanted(ends_of(is_due)) && result.raw.counts.size() == taxels) {
    bytes::ros_messages::encode_image(result.raw, array.shape, frame_id, array.message);
    array.raw.publish(time, array.message, ends_of(is_due), MessageKind::piece);
  }
  publish_values(array, array.force, result.force.newtons, result.force.time);
  publish_values(array, array.force_sigma, result.force.sigma_newtons, result.force.time);
  if (!is_due) return;
  const bool has_taxels = result.conductance.siemens.size() == taxels &&
                          result.conductance.sigma_siemens.size() == taxels &&
                          result.conductance.taxels.size() == taxels;
  if (array.conductance.is_wanted() && has_taxels) {
    bytes::ros_messages::encode_conductance_grid(result.conductance, array.shape, array.pitch, frame_id, array.message);
    array.conductance.publish(time, array.message, Ends::both, MessageKind::piece);
  }
  if (array.force_grid.is_wanted()) {
    bytes::ros_messages::encode_grid(result.force, array.shape, array.pitch, frame_id, array.message);
    array.force_grid.publish(time, array.message, Ends::both, MessageKind::piece);
  }
}

void FrameTopics::publish_values(Array& array, const Topic& topic, std::span<const float> values, Nanos time) {
  if (!topic.is_wanted()) return;
  bytes::ros_messages::encode_value_image(values, time, array.shape, array.served.name, array.message);
  topic.publish(time, array.message);
}

/// Clients hear of each contact that begins or ends, also between the frames that are due.
void FrameTopics::publish_contacts(Array& array, const live::suits::ArrayResult& result, bool is_due) {
  const Ends ends = ends_of(is_due || begins_or_ends(result.report));
  const bool is_wanted = contacts_topic_.is_wanted(ends);
  if (is_wanted || topics_.has_dds()) array.contacts.take(result);
  if (!is_wanted) return;
  array.contacts.encode(result, array.message);
  contacts_topic_.publish(result.raw.time, array.message, ends, MessageKind::piece);
}

void FrameTopics::publish_wrench(Array& array, const live::suits::ArrayResult& result) {
  const Nanos time = result.force.time;
  if (array.wrench.is_wanted()) {
    bytes::ros_messages::encode_wrench(wrench_of(result.contacts, array.served.suit_from_array), time,
                                       array.served.name, array.message);
    array.wrench.publish(time, array.message);
  }
  const std::lock_guard lock(array.press_mutex);
  array.press = {time, wrench_of(array.contacts.contacts())};
}

void FrameTopics::tick(std::int64_t /*tick*/) {
  const Nanos last(last_time_ns_.load());
  publish_points(Nanos(stream_time_ns_.load()), Ends::stream);
  if (last != Nanos{}) publish_points(last, Ends::dds);
  if (wrench_topic_.is_wanted()) publish_suit_wrench();
}

void FrameTopics::publish_points(Nanos time, Ends ends) {
  if (!points_topic_.is_wanted(ends)) return;
  points_.encode(time, message_);
  points_topic_.publish(time, message_, ends, MessageKind::picture);
}

/// Nothing where an array is silent: without it the sum would be too low.
void FrameTopics::publish_suit_wrench() {
  std::vector<Press> presses;
  for (Array& array : arrays_) {
    const std::lock_guard lock(array.press_mutex);
    presses.push_back(array.press);
  }
  const std::optional<Nanos> newest = std::ranges::max(presses, {}, &Press::time).time;
  Wrench sum;
  for (const Press& press : presses) {
    if (!press.time || *newest - *press.time > kPresent) return;
    sum += press.in_suit;
  }
  bytes::ros_messages::encode_wrench(sum, *newest, kSuitFrame, message_);
  wrench_topic_.publish(*newest, message_);
}

Result<std::unique_ptr<Part>> make_frame_topics(Host& host) {
  Result<std::unique_ptr<FrameTopics>> part = FrameTopics::create(host.suit, host.topics);
  if (!part) return part.error();
  return std::unique_ptr<Part>(*std::move(part));
}

}  // namespace dermis::out::serve
