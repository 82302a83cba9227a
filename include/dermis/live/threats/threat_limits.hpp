// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

/// Limits on forces between a robot and those it touches, in both directions, in the user's own figures. No limits come
/// with dermis: the standards and the risk assessment of the machine decide which hold. Not a safety function.
namespace dermis::live::threats {

/// The quantity that is compared with a limit.
enum class ThreatQuantity : std::uint8_t {
  total_force,       ///< Sum over the taxels that something presses [N].
  contact_force,     ///< Of one contact [N].
  taxel_force,       ///< On one taxel [N].
  contact_pressure,  ///< Mean over the taxels of one contact [Pa].
  taxel_pressure,    ///< On one taxel [Pa].
  force_rate,        ///< Rise of total_force over kRateWindow [N/s].
  sharp_pressure,    ///< On the hardest taxel of a contact that two taxels carry [Pa].
};

/// The names of threats.toml, in the order of the enumeration.
[[nodiscard]] const std::vector<std::string>& threat_quantity_names();
[[nodiscard]] const char* unit_of(ThreatQuantity quantity) noexcept;  ///< "N", "Pa" or "N/s".

/// A rectangle of taxels of one array.
struct Zone {
  std::string name;
  std::string array;  ///< Name of the array.
  std::size_t first_row = 0;
  std::size_t last_row = 0;  ///< >= first_row.
  std::size_t first_col = 0;
  std::size_t last_col = 0;  ///< >= first_col.

  bool operator==(const Zone&) const = default;
};

/// One limit.
struct ThreatLimit {
  std::string name;
  ThreatQuantity quantity = ThreatQuantity::contact_force;
  double limit = 0.0;          ///< In the unit of the quantity, > 0.
  double lasts_s = 0.0;        ///< It is a threat when it has lasted so long [s], 0 ... 1e6; 0: at once.
  double release_share = 0.8;  ///< It ends below this share of the limit, 0.1 ... 1 (hysteresis).
  double least_force_n = 3.0;  ///< sharp_pressure: contacts of less force are none [N], > 0.
  bool latched = false;        ///< It stands until ThreatMonitor::reset().
  std::string zone{};          ///< Name of the zone it is for; empty: every array, everywhere.

  bool operator==(const ThreatLimit&) const = default;
};

struct ThreatLimits {
  std::vector<Zone> zones;
  std::vector<ThreatLimit> limits;  ///< At least one.

  /// Names the first field that is wrong, as "threat 'clamped': ...".
  [[nodiscard]] Status validate() const;
  /// nullptr where there is none of that name.
  [[nodiscard]] const Zone* zone(std::string_view name) const noexcept;

  bool operator==(const ThreatLimits&) const = default;
};

/// Reads threats.toml (docs/threats.md). Unknown keys are errors with the nearest known name; every error names the
/// file and the line where there is one. The limits that it returns have passed ThreatLimits::validate().
[[nodiscard]] Result<ThreatLimits> read_threat_limits(const std::string& path);
/// The same from memory; `name` stands for the path.
[[nodiscard]] Result<ThreatLimits> threat_limits_from_toml(std::string_view text, const std::string& name);

}  // namespace dermis::live::threats
