// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/dds_topics.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "serve/suit_transforms.hpp"

namespace dermis::serve {
namespace {

constexpr std::size_t kBytesOfHeader = 128;
constexpr std::size_t kBytesOfAPoint = 20;
constexpr Nanos kPresent = std::chrono::milliseconds(500);

}  // namespace

DdsTopics::Array::Array(const ServedSuit& suit, std::size_t index)
    : name(suit.arrays[index].name),
      shape{suit.arrays[index].model->array.rows, suit.arrays[index].model->array.cols},
      suit_from_array(suit.arrays[index].suit_from_array),
      contacts(suit, index) {}

Result<std::unique_ptr<DdsTopics>> DdsTopics::create(const ServedSuit& suit, const dds::PublisherOptions& options) {
  Result<std::unique_ptr<dds::Publisher>> publisher = dds::Publisher::create(options);
  if (!publisher) return publisher.error();
  std::unique_ptr<DdsTopics> topics(new DdsTopics(suit, *std::move(publisher)));
  if (Status added = topics->add_topics(); !added) return added.error();
  topics->publish_transforms();
  return topics;
}

DdsTopics::DdsTopics(const ServedSuit& suit, std::unique_ptr<dds::Publisher> publisher)
    : suit_(suit), publisher_(std::move(publisher)), points_(suit) {
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) arrays_.emplace_back(suit, k);
}

Status DdsTopics::add_topics() {
  struct Wanted {
    dds::TopicId& id;
    dds::Topic topic;
  };
  std::vector<Wanted> wanted;
  std::size_t taxels = 0;
  for (Array& array : arrays_) {
    const std::string prefix = "/" + array.name;
    const std::size_t image_bytes = kBytesOfHeader + array.shape.taxel_count() * sizeof(float);
    wanted.push_back({array.raw, {prefix + "/raw", messages::image_type(), image_bytes}});
    wanted.push_back({array.force, {prefix + "/force", messages::image_type(), image_bytes}});
    wanted.push_back({array.force_sigma, {prefix + "/force_sigma", messages::image_type(), image_bytes}});
    wanted.push_back({array.wrench, {prefix + "/wrench", messages::wrench_type()}});
    taxels += array.shape.taxel_count();
  }
  wanted.push_back({contacts_topic_, {"/contacts", messages::contacts_type()}});
  wanted.push_back(
      {points_topic_, {"/suit/points", messages::point_cloud_type(), kBytesOfHeader + taxels * kBytesOfAPoint}});
  wanted.push_back({wrench_topic_, {"/suit/wrench", messages::wrench_type()}});
  wanted.push_back({diagnostics_topic_, {"/diagnostics", messages::diagnostics_type()}});
  wanted.push_back({transforms_topic_, {.name = "/tf_static", .type = messages::transforms_type(), .is_kept = true}});
  for (const Wanted& one : wanted) {
    const Result<dds::TopicId> added = publisher_->add_topic(one.topic);
    if (!added) return added.error();
    one.id = *added;
  }
  return Done{};
}

void DdsTopics::publish_transforms() {
  messages::encode_transforms(suit_transforms(suit_), std::chrono::system_clock::now().time_since_epoch(), message_);
  publisher_->publish(transforms_topic_, message_);
}

void DdsTopics::publish(const live::ArrayResult& result) {
  Array& array = arrays_[result.array];
  publish_images(array, result);
  array.contacts.take(result);
  if (publisher_->has_subscribers(contacts_topic_)) {
    array.contacts.encode(result, array.message);
    publisher_->publish(contacts_topic_, array.message);
  }
  if (!has(result.force.status, FrameStatus::rejected)) publish_wrench(array, result);
  if (publisher_->has_subscribers(points_topic_)) points_.keep(result.array, result.force);
}

void DdsTopics::publish_images(Array& array, const live::ArrayResult& result) {
  const std::size_t taxels = array.shape.taxel_count();
  if (publisher_->has_subscribers(array.raw) && result.raw.counts.size() == taxels) {
    messages::encode_image(result.raw, array.shape, array.name, array.message);
    publisher_->publish(array.raw, array.message);
  }
  publish_values(array, array.force, result.force.newtons, result.force.time);
  publish_values(array, array.force_sigma, result.force.sigma_newtons, result.force.time);
}

void DdsTopics::publish_values(Array& array, dds::TopicId topic, std::span<const float> values, Nanos time) {
  if (!publisher_->has_subscribers(topic)) return;
  messages::encode_value_image(values, time, array.shape, array.name, array.message);
  publisher_->publish(topic, array.message);
}

void DdsTopics::publish_wrench(Array& array, const live::ArrayResult& result) {
  const Nanos time = result.force.time;
  if (publisher_->has_subscribers(array.wrench)) {
    messages::encode_wrench(wrench_of(result.contacts, array.suit_from_array), time, array.name, array.message);
    publisher_->publish(array.wrench, array.message);
  }
  const std::lock_guard lock(array.press_mutex);
  array.press = {time, wrench_of(array.contacts.contacts())};
}

void DdsTopics::take_presses() {
  presses_.clear();
  for (Array& array : arrays_) {
    const std::lock_guard lock(array.press_mutex);
    presses_.push_back(array.press);
  }
}

void DdsTopics::publish_suit() {
  const std::uint64_t moved = suit_.body ? suit_.body->version() : 0;
  if (std::exchange(body_version_, moved) != moved) publish_transforms();
  take_presses();
  const std::optional<Nanos> newest = std::ranges::max(presses_, {}, &Press::time).time;
  if (!newest) return;
  if (publisher_->has_subscribers(points_topic_)) {
    points_.encode(*newest, message_);
    publisher_->publish(points_topic_, message_);
  }
  if (publisher_->has_subscribers(wrench_topic_)) publish_suit_wrench(*newest);
}

/// Nothing where an array is silent: without it the sum would be too low.
void DdsTopics::publish_suit_wrench(Nanos newest) {
  Wrench sum;
  for (const Press& press : presses_) {
    if (!press.time || newest - *press.time > kPresent) return;
    sum += press.in_suit;
  }
  messages::encode_wrench(sum, newest, kSuitFrame, message_);
  publisher_->publish(wrench_topic_, message_);
}

void DdsTopics::publish_health(std::span<const messages::Diagnosis> diagnoses, Nanos time) {
  if (!publisher_->has_subscribers(diagnostics_topic_)) return;
  messages::encode_diagnostics(diagnoses, time, kSuitFrame, message_);
  publisher_->publish(diagnostics_topic_, message_);
}

}  // namespace dermis::serve
