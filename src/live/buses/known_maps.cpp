// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <array>

#include "dermis/live/buses/register_map.hpp"

namespace dermis::live::buses {
namespace {

struct KnownMap {
  std::string_view name;
  std::string_view toml;
};

/// Inspire RH56DFTP user manual PRJ-02-TS-U-010 V1.0.0, 2.6.20. Addresses count bytes.
constexpr std::string_view kInspireRh56 = R"([registers]
table = "holding"
address_step = 2
port = 6000
unit = 1
array = [
  {name = "little_tip", address = 3000, rows = 3, cols = 3},
  {name = "little_top", address = 3018, rows = 12, cols = 8},
  {name = "little_palm", address = 3210, rows = 10, cols = 8},
  {name = "ring_tip", address = 3370, rows = 3, cols = 3},
  {name = "ring_top", address = 3388, rows = 12, cols = 8},
  {name = "ring_palm", address = 3580, rows = 10, cols = 8},
  {name = "middle_tip", address = 3740, rows = 3, cols = 3},
  {name = "middle_top", address = 3758, rows = 12, cols = 8},
  {name = "middle_palm", address = 3950, rows = 10, cols = 8},
  {name = "index_tip", address = 4110, rows = 3, cols = 3},
  {name = "index_top", address = 4128, rows = 12, cols = 8},
  {name = "index_palm", address = 4320, rows = 10, cols = 8},
  {name = "thumb_tip", address = 4480, rows = 3, cols = 3},
  {name = "thumb_top", address = 4498, rows = 12, cols = 8},
  {name = "thumb_middle", address = 4690, rows = 3, cols = 3},
  {name = "thumb_palm", address = 4708, rows = 12, cols = 8},
  {name = "palm", address = 4900, rows = 14, cols = 8},
]
)";

/// DFRobot_TactileSensor: SEN0704 has 6x6 taxels, SEN0705 4x8. The last row comes first.
constexpr std::string_view kDfrobotSen0704 = R"([registers]
table = "input"
unit = 1
array = [{name = "array", address = 7, rows = 6, cols = 6, last_row_first = true}]
)";
constexpr std::string_view kDfrobotSen0705 = R"([registers]
table = "input"
unit = 1
array = [{name = "array", address = 7, rows = 4, cols = 8, last_row_first = true}]
)";

constexpr std::array kMaps = {KnownMap{"dfrobot-sen0704", kDfrobotSen0704},
                              KnownMap{"dfrobot-sen0705", kDfrobotSen0705}, KnownMap{"inspire-rh56", kInspireRh56}};

}  // namespace

std::vector<std::string> known_register_maps() {
  std::vector<std::string> names;
  for (const KnownMap& map : kMaps) names.emplace_back(map.name);
  return names;
}

std::string_view known_register_map(std::string_view name) {
  for (const KnownMap& map : kMaps) {
    if (map.name == name) return map.toml;
  }
  return {};
}

}  // namespace dermis::live::buses
