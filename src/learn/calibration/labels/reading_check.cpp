// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/reading_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>

#include "dermis/touch/preprocessing/supply_bounds.hpp"
#include "dermis/touch/preprocessing/temperature_unit.hpp"

namespace dermis::learn::calibration {
namespace {

/// Frames that something presses.
std::set<std::size_t> loaded_frames(std::span<const Load> loads) {
  std::set<std::size_t> loaded;
  for (const Load& load : loads) {
    if (load.value > 0.0) loaded.insert(load.frame);
  }
  return loaded;
}

/// A way in which frames cannot be.
class Trouble {
 public:
  void add(std::size_t frame, const std::string& what) {
    if (frames_++ == 0) first_ = fmt::format("the first is frame {}: {}", frame, what);
  }
  [[nodiscard]] Status verdict(std::size_t all) const {
    if (2 * frames_ <= all) return Done{};
    return bad_input(fmt::format("{} of {} loaded frames cannot be: {}", frames_, all, first_));
  }

 private:
  std::size_t frames_ = 0;
  std::string first_;
};

}  // namespace

Status check_readings(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads) {
  const touch::preprocessing::SupplyBounds supplies(array.readout);
  const std::set<std::size_t> loaded = loaded_frames(loads);
  Trouble supply;
  Trouble temperature;
  Trouble sensor_count;
  Trouble readings;
  for (const std::size_t frame : loaded) {
    const RawFrame& raw = frames[frame];
    if (raw.supply_v && supplies.is_in_millivolts(*raw.supply_v)) {
      supply.add(frame, supplies.describe_impossible(*raw.supply_v));
    }
    if (const std::optional<double> kelvin = touch::preprocessing::kelvin_in(raw)) {
      temperature.add(frame,
                      fmt::format("a temperature of {:.1f} C: it looks like kelvin, give degrees Celsius", *kelvin));
    }
    const std::size_t sensors = array.temperature_sensors.size();
    if (sensors > 0 && raw.sensor_celsius.size() != sensors) {
      sensor_count.add(frame, fmt::format("temperatures of {} sensors, where array.temperature_sensors has {} places",
                                          raw.sensor_celsius.size(), sensors));
    }
    if (std::ranges::all_of(raw.counts, [](float count) { return count == 0.0F; })) {
      readings.add(frame, "all readings 0: is the array connected and powered?");
    }
  }
  for (const Trouble* trouble : {&supply, &temperature, &sensor_count, &readings}) {
    if (Status verdict = trouble->verdict(loaded.size()); !verdict) return verdict;
  }
  return Done{};
}

}  // namespace dermis::learn::calibration
