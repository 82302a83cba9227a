// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/bag_arrays.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "bytes/recordings/bag_messages.hpp"
#include "bytes/recordings/message_kind.hpp"
#include "bytes/recordings/recording_description.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::size_t kMostLooked = 4096;
constexpr std::size_t kMostArrays = 4096;

std::string topic_of(const std::string& topic, const std::string& part) {
  const bool is_apart = !part.empty() && part.front() != '[';
  return topic + (is_apart ? "." : "") + part;
}

class Search {
 public:
  explicit Search(McapReader& mcap) : mcap_(mcap) {
    if (!mcap.statistics()) return;
    const auto& counts = mcap.statistics()->channel_messages;
    missing_.emplace();
    for (const auto& [id, channel] : mcap.channels()) {
      if (counts.contains(id) && may_be_readings(channel)) missing_->insert(id);
    }
  }

  std::vector<BagArray> arrays() {
    McapMessage message;
    for (std::size_t looked = 0; looked < kMostLooked && !has_all(); ++looked) {
      const Result<bool> more = mcap_.next(message);
      if (!more || !*more) break;
      if (looked == 0 && !descriptions_of(mcap_).empty()) return {};
      look(message);
    }
    leave_cameras();
    return std::move(arrays_);
  }
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  [[nodiscard]] bool has_all() const { return missing_ && missing_->empty(); }

  void look(const McapMessage& message) {
    if (seen_.contains(message.channel)) return;
    const McapChannel& channel = mcap_.channels().at(message.channel);
    if (!may_be_readings(channel)) return;
    const Status read = read_readings(channel, message.data, readings_);
    if (read && readings_.empty()) return;  // a later one may hold some
    seen_.insert(message.channel);
    if (missing_) missing_->erase(message.channel);
    if (!read) {
      if (why_.empty()) {
        why_ = "the first message of " + printable(channel.topic) + " cannot be read: " + read.error().message;
      }
      return;
    }
    for (const BagReading& reading : readings_) {
      if (arrays_.size() == kMostArrays) return;
      arrays_.push_back({message.channel, reading.part, topic_of(channel.topic, reading.part)});
    }
  }

  void leave_cameras() {
    const auto is_touch = [&](const BagArray& array) { return is_tactile_state(mcap_.channels().at(array.channel)); };
    if (std::ranges::none_of(arrays_, is_touch)) return;
    std::erase_if(arrays_, [&](const BagArray& array) {
      return !is_touch(array) && kind_of(mcap_.channels().at(array.channel)) == MessageKind::image;
    });
  }

  McapReader& mcap_;
  std::set<std::uint16_t> seen_;
  std::optional<std::set<std::uint16_t>> missing_;  // topics by the summary that have not come
  std::vector<BagReading> readings_;
  std::vector<BagArray> arrays_;
  std::string why_;
};

}  // namespace

std::vector<BagArray> find_bag_arrays(McapReader& mcap) {
  if (!descriptions_of(mcap).empty()) return {};
  std::vector<BagArray> arrays = Search(mcap).arrays();
  mcap.rewind();
  return arrays;
}

std::string why_no_array(McapReader& mcap) {
  Search search(mcap);
  static_cast<void>(search.arrays());
  return search.why();
}

}  // namespace dermis::bytes::recordings
