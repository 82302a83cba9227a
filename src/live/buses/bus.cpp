// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/bus.hpp"

namespace dermis::live::buses {

void Bus::add(std::size_t array, const std::shared_ptr<ArrayFeed>& feed) {
  const std::lock_guard lock(mutex_);
  feeds_[array].push_back(feed);
}

std::vector<std::shared_ptr<ArrayFeed>> Bus::readers(std::size_t array) {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<ArrayFeed>> readers;
  std::erase_if(feeds_[array], [&](const std::weak_ptr<ArrayFeed>& feed) {
    std::shared_ptr<ArrayFeed> reader = feed.lock();
    const bool has_left = reader == nullptr;
    if (!has_left) readers.push_back(std::move(reader));
    return has_left;
  });
  return readers;
}

std::vector<std::size_t> Bus::wanted() {
  std::vector<std::size_t> wanted;
  for (std::size_t array = 0; array < arrays_.size(); ++array) {
    if (!readers(array).empty()) wanted.push_back(array);
  }
  return wanted;
}

std::vector<std::shared_ptr<ArrayFeed>> Bus::all_readers() {
  std::vector<std::shared_ptr<ArrayFeed>> all;
  for (std::size_t array = 0; array < arrays_.size(); ++array) {
    for (std::shared_ptr<ArrayFeed>& reader : readers(array)) all.push_back(std::move(reader));
  }
  return all;
}

void Bus::deliver(std::size_t array, const FrameShape& shape, const Arrival& arrival, RawFrame& frame) {
  frame.time = begin_.utc + (arrival.taken - begin_.steady);
  frame.acquisition.arrival_steady = arrival.steady;
  frame.acquisition.arrival_utc = arrival.utc;
  deliver_timed(array, shape, frame);
}

void Bus::deliver_timed(std::size_t array, const FrameShape& shape, const RawFrame& frame) {
  for (const std::shared_ptr<ArrayFeed>& reader : readers(array)) reader->push(shape, frame);
}

}  // namespace dermis::live::buses
