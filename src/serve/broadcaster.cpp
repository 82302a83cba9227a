// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/broadcaster.hpp"

#include <algorithm>

namespace dermis::serve {
namespace {

stream::ChannelId add_channel(stream::Server& server, const std::string& topic, const messages::MessageType& type) {
  return server.add_channel(topic, type.name, type.definition);
}

bool begins_or_ends(const ContactReport& report) {
  return std::any_of(report.contacts.begin(), report.contacts.end(),
                     [](const Contact& contact) { return contact.phase != ContactPhase::held; });
}

}  // namespace

Broadcaster::Broadcaster(const ServedSuit& suit, stream::Server& server) : server_(server), points_(suit) {
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    const ServedArray& array = suit.arrays[k];
    Channels& channels = arrays_.emplace_back(Channels{.array = &array, .contacts = ContactsInSuit(suit, k)});
    const ArrayDescription& description = array.model->array;
    channels.shape = {description.rows, description.cols};
    channels.pitch = {description.row_pitch_m, description.col_pitch_m};
    channels.raw = add_channel(server, "/" + array.name + "/raw", messages::image_type());
    channels.conductance = add_channel(server, "/" + array.name + "/conductance", messages::grid_type());
    channels.force = add_channel(server, "/" + array.name + "/force", messages::grid_type());
  }
  contacts_ = add_channel(server, "/contacts", messages::contacts_type());
  points_channel_ = add_channel(server, "/suit/points", messages::point_cloud_type());
}

void Broadcaster::publish(const live::ArrayResult& result) {
  Channels& channels = arrays_[result.array];
  const bool due = is_due(channels, result.raw.time);
  if (due) {
    publish_images(channels, result);
    if (server_.has_subscribers(points_channel_)) points_.keep(result.array, result.force);
    last_time_ns_ = result.raw.time.count();
  }
  if (due || begins_or_ends(result.report)) publish_contacts(channels, result);
}

/// Evenly, whatever the jitter of the frames: what was late does not make the next one late. A frame that comes again
/// is for somebody who has not seen it.
bool Broadcaster::is_due(Channels& channels, Nanos time) const noexcept {
  const Nanos period(static_cast<std::int64_t>(1e9 / rate_hz()));
  if (channels.last == time) return true;
  const bool went_back = channels.last && time < *channels.last;
  const bool due = !channels.last || went_back || time >= channels.due;
  if (due) channels.due = !went_back && time - channels.due < period ? channels.due + period : time + period;
  channels.last = time;
  return due;
}

void Broadcaster::publish_images(Channels& channels, const live::ArrayResult& result) {
  const std::string& frame_id = channels.array->name;
  std::vector<std::uint8_t>& message = channels.message;
  const Nanos time = result.raw.time;
  if (server_.has_subscribers(channels.raw) && result.raw.counts.size() == channels.shape.taxel_count()) {
    messages::encode_image(result.raw, channels.shape, frame_id, message);
    server_.publish(channels.raw, time, message, stream::MessageKind::picture);
  }
  const bool has_taxels = result.conductance.siemens.size() == channels.shape.taxel_count() &&
                          result.conductance.sigma_siemens.size() == channels.shape.taxel_count() &&
                          result.conductance.taxels.size() == channels.shape.taxel_count();
  if (server_.has_subscribers(channels.conductance) && has_taxels) {
    messages::encode_conductance_grid(result.conductance, channels.shape, channels.pitch, frame_id, message);
    server_.publish(channels.conductance, time, message, stream::MessageKind::picture);
  }
  if (server_.has_subscribers(channels.force)) {
    messages::encode_grid(result.force, channels.shape, channels.pitch, frame_id, message);
    server_.publish(channels.force, time, message, stream::MessageKind::picture);
  }
}

void Broadcaster::publish_contacts(Channels& channels, const live::ArrayResult& result) {
  if (!server_.has_subscribers(contacts_)) return;
  channels.contacts.take(result);
  channels.contacts.encode(result, channels.message);
  server_.publish(contacts_, result.raw.time, channels.message, stream::MessageKind::picture);
}

void Broadcaster::publish_points() {
  if (!server_.has_subscribers(points_channel_)) return;
  points_.encode(last_time(), points_message_);
  server_.publish(points_channel_, last_time(), points_message_, stream::MessageKind::picture);
}

}  // namespace dermis::serve
