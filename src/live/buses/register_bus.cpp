// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/register_bus.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "dermis/bytes/system/thread_priority.hpp"

namespace dermis::live::buses {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr Nanos kTick = 20ms;
constexpr Nanos kRetryAfter = 200ms;
constexpr int kMostUnanswered = 3;  // questions on the way to a device that is there

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

std::vector<BusArray> arrays_of(const RegisterMap& map) {
  std::vector<BusArray> arrays;
  for (const RegisterArray& array : map.arrays) arrays.push_back({array.name, array.shape});
  return arrays;
}

std::string name_of(const ModbusPlace& place) {
  return place.host.empty() ? place.path : place.host + ":" + std::to_string(place.port);
}

}  // namespace

Result<std::shared_ptr<Bus>> RegisterBus::open(const BusAddress& address) {
  auto place = std::get<ModbusPlace>(address.place);
  Result<RegisterMap> map = read_register_map(place.map);
  if (!map) return bad_input("'" + address.text + "': " + map.error().message);
  if (place.port == 0) place.port = map->port;
  if (place.unit == 0) place.unit = map->unit;
  Result<std::unique_ptr<RegisterReader>> reader = make_register_reader(place);
  if (!reader) return reader.error();
  std::string name = name_of(place);
  if (const Status connected = (*reader)->connect(); !connected) {
    return failed("'" + address.text + "': " + name + " does not answer: " + connected.error().message +
                  "; check the address, and that the device is on");
  }
  return std::shared_ptr<Bus>(new RegisterBus(std::move(place), *std::move(map), *std::move(reader), std::move(name)));
}

RegisterBus::RegisterBus(ModbusPlace place, RegisterMap map, std::unique_ptr<RegisterReader> reader, std::string name)
    : Bus(arrays_of(map)),
      place_(std::move(place)),
      map_(std::move(map)),
      reader_(std::move(reader)),
      name_(std::move(name)),
      words_(map_.arrays.size()),
      filled_(map_.arrays.size()),
      has_come_(map_.arrays.size()) {
  for (std::size_t k = 0; k < words_.size(); ++k) words_[k].resize(map_.arrays[k].words());
  thread_ = std::thread([this] { run(); });
}

RegisterBus::~RegisterBus() {
  stop_ = true;
  thread_.join();
}

/// All arrays that somebody reads, once a round.
void RegisterBus::run() {
  raise_thread_priority();
  std::vector<std::size_t> planned;
  std::vector<RegisterRead> reads;
  Nanos due = steady_now();
  while (!stop_) {
    std::vector<std::size_t> asked = wanted();
    if (asked != planned) {
      reads = plan_reads(map_, asked);
      planned = std::move(asked);
    }
    if (planned.empty()) {
      sleep_until(steady_now() + kTick);
      continue;
    }
    for (const RegisterRead& read : reads) {
      if (!stop_) ask(read);
    }
    if (!place_.rate_hz) continue;
    due = std::max(due + Nanos(static_cast<std::int64_t>(1e9 / *place_.rate_hz)), steady_now());
    sleep_until(due);
  }
}

void RegisterBus::ask(const RegisterRead& read) {
  answer_.resize(read.words);
  const Answer answer = reader_->read(map_.input, read.address, answer_);
  if (answer == Answer::read) {
    unanswered_ = 0;
    return fill(read);
  }
  if (answer == Answer::refused) return refuse(read);
  count_damaged(read);
  if (answer == Answer::nothing && ++unanswered_ < kMostUnanswered) return;
  unanswered_ = 0;
  come_back();
}

/// A frame is made of the answers to one round of questions, or it is none.
void RegisterBus::fill(const RegisterRead& read) {
  const Arrival arrival;
  for (const RegisterPart& part : read.parts) {
    std::vector<std::uint16_t>& words = words_[part.array];
    std::size_t& filled = filled_[part.array];
    if (part.array_begin == 0) filled = 0;
    if (part.array_begin != filled) continue;
    std::copy_n(answer_.begin() + static_cast<std::ptrdiff_t>(part.read_begin), part.words,
                words.begin() + static_cast<std::ptrdiff_t>(part.array_begin));
    filled += part.words;
    if (filled < words.size()) continue;
    decode_registers(map_.arrays[part.array], words, frame_);
    has_come_[part.array] = true;
    deliver(part.array, map_.arrays[part.array].shape, arrival, frame_);
  }
}

/// A device that has never given an array is another device.
void RegisterBus::refuse(const RegisterRead& read) {
  const Error error = bad_input(name_ + " does not give " + std::to_string(read.words) + " registers from " +
                                std::to_string(read.address) + " on: " + reader_->reason() + "; is '" + place_.map +
                                "' the map of this device, and " + std::to_string(place_.unit) + " its unit?");
  for (const RegisterPart& part : read.parts) {
    for (const std::shared_ptr<ArrayFeed>& reader : readers(part.array)) {
      has_come_[part.array] ? reader->count_damaged() : reader->end(error);
    }
  }
  sleep_until(steady_now() + kTick);
}

void RegisterBus::count_damaged(const RegisterRead& read) {
  for (const RegisterPart& part : read.parts) {
    for (const std::shared_ptr<ArrayFeed>& reader : readers(part.array)) reader->count_damaged();
  }
}

void RegisterBus::come_back() {
  const std::string seconds =
      std::to_string(std::chrono::duration_cast<std::chrono::seconds>(place_.reconnect).count());
  tell(name_ + " does not answer (" + reader_->reason() + "): waiting up to " + seconds + " s for it to come back");
  const Nanos last = steady_now() + place_.reconnect;
  while (!stop_ && steady_now() < last) {
    if (reader_->connect()) {
      tell(name_ + " is back");
      for (const std::shared_ptr<ArrayFeed>& reader : all_readers()) reader->count_reconnection();
      return;
    }
    sleep_until(steady_now() + kRetryAfter);
  }
  const Error error = failed(name_ + " has not come back within " + seconds + " s");
  for (const std::shared_ptr<ArrayFeed>& reader : all_readers()) reader->end(error);
}

/// Once, however many arrays it has.
void RegisterBus::tell(const std::string& text) {
  const std::vector<std::shared_ptr<ArrayFeed>> all = all_readers();
  if (!all.empty()) all.front()->tell(text);
}

void RegisterBus::sleep_until(Nanos due) const {
  for (Nanos rest = due - steady_now(); rest > Nanos{} && !stop_; rest = due - steady_now()) {
    std::this_thread::sleep_for(std::min(rest, kTick));
  }
}

}  // namespace dermis::live::buses
