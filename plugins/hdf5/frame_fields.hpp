// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>

/// The datasets of frames, as they are read and written.
namespace dermis::bytes::recordings {

inline constexpr const char* kCounts = "counts";
inline constexpr const char* kTimeS = "time_s";
inline constexpr const char* kSensors = "sensor_celsius";

/// Which optional members of a frame have a value, as in the dataset `known`.
inline constexpr unsigned kTemperature = 1;
inline constexpr unsigned kSupply = 2;
inline constexpr unsigned kSequence = 4;
inline constexpr unsigned kDeviceTime = 8;
inline constexpr const char* kKnownMeaning =
    "1: temperature_celsius, 2: supply_v, 4: sequence, 8: device_time_ns have a value";

/// The members of a frame besides its counts, and something of each of them.
template <template <typename> typename Of>
struct Fields {
  Of<std::int64_t> time_ns{};
  Of<double> temperature_celsius{};
  Of<double> supply_v{};
  Of<std::uint64_t> sequence{};
  Of<std::int64_t> device_time_ns{};
  Of<std::int64_t> arrival_steady_ns{};
  Of<std::int64_t> arrival_utc_ns{};
  Of<std::uint32_t> lost_before{};
  Of<std::uint32_t> held_taxels{};
  Of<std::uint8_t> known{};
};

/// Calls visit(a.field, b.field) for each field.
template <typename A, typename B, typename Visit>
void for_each_field(A& a, B& b, const Visit& visit) {
  visit(a.time_ns, b.time_ns);
  visit(a.temperature_celsius, b.temperature_celsius);
  visit(a.supply_v, b.supply_v);
  visit(a.sequence, b.sequence);
  visit(a.device_time_ns, b.device_time_ns);
  visit(a.arrival_steady_ns, b.arrival_steady_ns);
  visit(a.arrival_utc_ns, b.arrival_utc_ns);
  visit(a.lost_before, b.lost_before);
  visit(a.held_taxels, b.held_taxels);
  visit(a.known, b.known);
}

template <typename T>
using Value = T;

template <typename T>
struct Label {
  const char* name;
  const char* units;
};

inline constexpr Fields<Label> kLabels{
    {"time_ns", "ns"},        {"temperature_celsius", "degC"}, {"supply_v", "V"},        {"sequence", "1"},
    {"device_time_ns", "ns"}, {"arrival_steady_ns", "ns"},     {"arrival_utc_ns", "ns"}, {"lost_before", "1"},
    {"held_taxels", "1"},     {"known", kKnownMeaning}};

}  // namespace dermis::bytes::recordings
