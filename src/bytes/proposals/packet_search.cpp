// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/packet_search.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "bytes/proposals/escaped_packets.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kSmallest = 6;  // bytes of a packet
constexpr std::size_t kLargest = 65536;
constexpr std::size_t kFewest = 3;  // packets
constexpr std::size_t kMostPackets = 2000;
constexpr std::size_t kMostPairs = 24;  // whose distances are looked at
constexpr std::size_t kMostMarks = 3;
constexpr std::size_t kLongestMark = 8;
constexpr std::size_t kMostInTurn = 4;  // packets of which each has a beginning of its own
constexpr std::size_t kMostSizes = 4;
constexpr double kSame = 0.95;

/// Two bytes that come again at the same distance.
struct Pair {
  std::uint16_t bytes = 0;
  std::size_t distance = 0;
  std::size_t count = 0;
};

std::vector<Pair> pairs_in(std::span<const std::uint8_t> bytes) {
  std::vector<std::size_t> last(65536, 0);  // place + 1
  std::unordered_map<std::uint64_t, std::size_t> counts;
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    const auto pair = static_cast<std::uint16_t>(bytes[i] << 8U | bytes[i + 1]);
    const std::size_t before = std::exchange(last[pair], i + 1);
    if (before == 0) continue;
    const std::size_t distance = i + 1 - before;
    if (distance >= kSmallest && distance <= kLargest) ++counts[std::uint64_t{distance} << 16U | pair];
  }
  std::vector<Pair> pairs;
  for (const auto& [key, count] : counts) {
    if (count + 1 >= kFewest)
      pairs.push_back({static_cast<std::uint16_t>(key & 0xFFFFU), static_cast<std::size_t>(key >> 16U), count});
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tuple(a.count * a.distance, a.bytes, a.distance) >
           std::tuple(b.count * b.distance, b.bytes, b.distance);
  });
  if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
  return pairs;
}

/// Where packets of that size begin, one behind the other, by two bytes that all or every second of them have.
std::vector<std::size_t> places_of(std::span<const std::uint8_t> bytes, const Pair& pair, std::size_t size) {
  const auto is_at = [&](std::size_t at) {
    return at + 1 < bytes.size() && (bytes[at] << 8U | bytes[at + 1]) == pair.bytes;
  };
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at + pair.distance < bytes.size() && places.size() < kMostPackets;) {
    if (!is_at(at) || !is_at(at + pair.distance)) {
      ++at;
      continue;
    }
    for (std::size_t step = 0; step < pair.distance; step += size) places.push_back(at + step);
    at += pair.distance;
  }
  return places;
}

/// Places that have another one a packet before or behind them; the others are readings that look like the mark.
std::vector<std::size_t> those_in_a_row(const std::vector<std::size_t>& places, std::size_t size) {
  std::vector<std::size_t> kept;
  for (const std::size_t place : places) {
    const bool is_in_packet = !kept.empty() && place < kept.back() + size;
    const bool has_next = std::binary_search(places.begin(), places.end(), place + size);
    const bool has_last = place >= size && std::binary_search(places.begin(), places.end(), place - size);
    if (!is_in_packet && (has_next || has_last)) kept.push_back(place);
  }
  return kept;
}

/// The bytes of which nearly all come again at one distance, and that distance.
std::vector<std::pair<std::size_t, std::vector<std::size_t>>> single_marks_in(std::span<const std::uint8_t> bytes) {
  std::array<std::vector<std::size_t>, 256> places;
  for (std::size_t i = 0; i < bytes.size(); ++i) places[bytes[i]].push_back(i);
  std::vector<std::pair<std::size_t, std::vector<std::size_t>>> found;
  for (std::vector<std::size_t>& at : places) {
    if (at.size() < kFewest) continue;
    std::map<std::size_t, std::size_t> gaps;
    for (std::size_t k = 1; k < at.size(); ++k) ++gaps[at[k] - at[k - 1]];
    const auto most = std::ranges::max_element(gaps, {}, [](const auto& gap) { return gap.second; });
    const bool is_even = 10 * most->second >= 9 * (at.size() - 1) && most->first >= kSmallest;
    if (is_even && 2 * most->first * at.size() >= bytes.size())
      found.emplace_back(most->first, those_in_a_row(at, most->first));
  }
  return found;
}

Packets cut(std::span<const std::uint8_t> bytes, const std::vector<std::size_t>& places, std::size_t size) {
  Packets packets{.size = size};
  for (const std::size_t place : places) {
    if (packets.packets.size() == kMostPackets) break;
    if (place + size > bytes.size()) break;
    packets.places.push_back(place);
    packets.packets.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(place),
                                 bytes.begin() + static_cast<std::ptrdiff_t>(place + size));
  }
  return packets;
}

/// How many packets follow each other, less those that do not.
std::ptrdiff_t evenness_of(const Packets& packets) {
  std::ptrdiff_t evenness = 0;
  for (std::size_t k = 1; k < packets.places.size(); ++k)
    evenness += packets.places[k] - packets.places[k - 1] == packets.size ? 1 : -1;
  return evenness;
}

struct Run {
  std::size_t begin = 0;
  std::size_t size = 0;
  double rarity = 0.0;
  bool is_at_end = false;  ///< Of the packets.
};

/// Bytes side by side that are the same in all packets, also over the end of one into the next.
std::vector<Run> constant_runs(const Packets& packets) {
  const std::size_t size = packets.size;
  std::vector<std::uint8_t> is_same(size);
  for (std::size_t at = 0; at < size; ++at) is_same[at] = is_constant(packets, at) ? 1 : 0;
  const Bytes& first = packets.packets.front();
  std::vector<Run> runs;
  for (std::size_t at = 0; at < size; ++at) {
    if (is_same[at] == 0 || first[at] == 0 ||
        (is_same[(at + size - 1) % size] != 0 && first[(at + size - 1) % size] != 0))
      continue;
    Run run{.begin = at};
    while (run.size < size && is_same[(at + run.size) % size] != 0) ++run.size;
    while (run.size > 1 && first[(at + run.size - 1) % size] == 0) --run.size;
    runs.push_back(run);
  }
  return runs;
}

/// How rarely the bytes of a run stand elsewhere.
double rarity_of(const Run& run, const Packets& packets) {
  std::size_t elsewhere = 0;
  std::size_t all = 0;
  const std::uint8_t begin = packets.packets.front()[run.begin];
  for (const Bytes& packet : packets.packets) {
    for (std::size_t at = 0; at < packet.size(); ++at) {
      const bool is_in_run = (at + packet.size() - run.begin) % packet.size() < run.size;
      elsewhere += !is_in_run && packet[at] == begin ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(std::min<std::size_t>(run.size, 4)) -
         20.0 * static_cast<double>(elsewhere) / static_cast<double>(all);
}

/// The same packets, cut where one of their marks begins.
void add_marked(std::span<const std::uint8_t> bytes, const Packets& packets, std::vector<Packets>& found) {
  std::vector<Run> runs = constant_runs(packets);
  const std::size_t begin_of_stream = (packets.size - packets.places.front() % packets.size) % packets.size;
  for (Run& run : runs) {
    const std::size_t inside = (begin_of_stream + packets.size - run.begin) % packets.size;
    run.rarity = rarity_of(run, packets);
    if (inside < run.size && packets.packets.front()[begin_of_stream] != 0) {  // it begins a packet
      run = {begin_of_stream, run.size - inside, run.rarity + 2.0};
    } else if ((run.begin + run.size) % packets.size == begin_of_stream) {
      run.rarity += 2.0;
      run.is_at_end = true;
    }
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.rarity > b.rarity; });
  for (std::size_t k = 0; k < std::min(runs.size(), kMostMarks); ++k) {
    const std::size_t begin = runs[k].is_at_end ? (runs[k].begin + runs[k].size) % packets.size : runs[k].begin;
    std::vector<std::size_t> places = packets.places;
    for (std::size_t& place : places) place += begin;
    const std::size_t before = packets.size - begin;
    if (packets.places.front() >= before) places.insert(places.begin(), packets.places.front() - before);
    Packets marked = cut(bytes, places, packets.size);
    (runs[k].is_at_end ? marked.end_mark_size : marked.mark_size) = std::min(runs[k].size, kLongestMark);
    const auto mark_of = [&](const Packets& of, std::size_t packet) {
      return std::span(of.packets[packet]).first(of.mark_size);
    };
    const bool is_other = marked.packets.size() > 2 && !std::ranges::equal(mark_of(marked, 0), mark_of(marked, 1));
    if (is_other) {  // a greeting, or the end of a packet
      marked.packets.erase(marked.packets.begin());
      marked.places.erase(marked.places.begin());
    }
    if (marked.packets.size() + 1 >= kFewest) found.push_back(std::move(marked));
  }
}

}  // namespace

bool is_constant(const Packets& packets, std::size_t at) {
  std::array<std::size_t, 256> counts{};
  for (const Bytes& packet : packets.packets) ++counts[packet[at]];
  return static_cast<double>(counts[packets.packets.front()[at]]) >=
         kSame * static_cast<double>(packets.packets.size());
}

std::vector<Packets> packets_in(std::span<const std::uint8_t> bytes, const std::vector<std::size_t>& sizes) {
  std::vector<Packets> found = escaped_packets_in(bytes);
  std::map<std::size_t, Packets> by_size;
  for (const Pair& pair : pairs_in(bytes)) {
    for (std::size_t parts = 1; parts <= kMostInTurn; ++parts) {
      const std::size_t size = pair.distance / parts;
      if (pair.distance % parts != 0 || size < kSmallest) continue;
      Packets packets = cut(bytes, places_of(bytes, pair, size), size);
      const bool are_enough =
          packets.packets.size() + 1 >= kFewest && packets.packets.size() * size >= bytes.size() / 2;
      if (are_enough && evenness_of(packets) > evenness_of(by_size[size])) by_size[size] = std::move(packets);
    }
  }
  for (const auto& [size, places] : single_marks_in(bytes)) {
    Packets packets = cut(bytes, places, size);
    if (evenness_of(packets) > evenness_of(by_size[size])) by_size[size] = std::move(packets);
  }
  std::vector<std::size_t> marked;
  for (const auto& [size, packets] : by_size) {
    const auto is_multiple = [&](std::size_t other) { return size % other == 0; };
    if (packets.packets.empty() || std::any_of(marked.begin(), marked.end(), is_multiple)) continue;
    const std::size_t before = found.size();
    add_marked(bytes, packets, found);
    if (found.size() > before) marked.push_back(size);
    if (marked.size() == kMostSizes) break;
  }
  for (const std::size_t size : sizes) {
    std::vector<std::size_t> places;
    for (std::size_t at = 0; at + size <= bytes.size() && places.size() < kMostPackets; at += size)
      places.push_back(at);
    if (places.size() >= kFewest) found.push_back(cut(bytes, places, size));
  }
  return found;
}

}  // namespace dermis::bytes::proposals
