// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/threats/threat_limits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dermis/bytes/files/config_table.hpp"

namespace dermis::live::threats {
namespace {

constexpr std::size_t kMostLimits = 1000;
constexpr double kMostSeconds = 1e6;
constexpr double kPascalsPerKilopascal = 1000.0;

/// The key of a limit, whose name has its unit.
struct LimitKey {
  std::string_view name;
  double si;  // its size in SI units
};

constexpr LimitKey kNewtons{"limit_n", 1.0};
constexpr LimitKey kNewtonsPerSecond{"limit_n_per_s", 1.0};
constexpr LimitKey kKilopascals{"limit_kpa", kPascalsPerKilopascal};
constexpr std::array kLimitKeys{kNewtons, kNewtonsPerSecond, kKilopascals};

const LimitKey& limit_key(ThreatQuantity quantity) {
  switch (quantity) {
    case ThreatQuantity::total_force:
    case ThreatQuantity::contact_force:
    case ThreatQuantity::taxel_force: break;
    case ThreatQuantity::force_rate: return kNewtonsPerSecond;
    case ThreatQuantity::contact_pressure:
    case ThreatQuantity::taxel_pressure:
    case ThreatQuantity::sharp_pressure: return kKilopascals;
  }
  return kNewtons;
}

/// First and last of a range of lines.
void read_lines(bytes::files::ConfigFile& file, const std::string& key, std::size_t& first, std::size_t& last) {
  file.require(key);
  std::vector<std::size_t> lines;
  file.counts(key, lines);
  if (file.contains(key) && lines.size() != 2) return file.fail(key, "must be the first and the last, as [0, 5]");
  if (lines.size() != 2) return;
  first = lines[0];
  last = lines[1];
  if (last < first) file.fail(key, "must be the first and the last, as [0, 5]");
}

void read_zone(bytes::files::ConfigFile& file, const std::string& key, Zone& zone) {
  file.require(key + ".name");
  file.require(key + ".array");
  file.text(key + ".name", zone.name);
  file.text(key + ".array", zone.array);
  read_lines(file, key + ".rows", zone.first_row, zone.last_row);
  read_lines(file, key + ".cols", zone.first_col, zone.last_col);
}

void read_limit(bytes::files::ConfigFile& file, const std::string& key, ThreatLimit& limit) {
  file.require(key + ".name");
  file.require(key + ".quantity");
  file.text(key + ".name", limit.name);
  auto quantity = static_cast<std::size_t>(limit.quantity);
  file.choice(key + ".quantity", threat_quantity_names(), quantity);
  limit.quantity = static_cast<ThreatQuantity>(quantity);
  const LimitKey& own = limit_key(limit.quantity);
  for (const LimitKey& other : kLimitKeys) {
    const std::string other_key = fmt::format("{}.{}", key, other.name);
    if (other.name != own.name && file.contains(other_key)) {
      file.fail(other_key, fmt::format("is not the unit of {}; use {}", threat_quantity_names()[quantity], own.name));
    }
  }
  const std::string own_key = fmt::format("{}.{}", key, own.name);
  file.require(own_key);
  file.number(own_key, limit.limit);
  limit.limit *= own.si;
  file.number(key + ".lasts_s", limit.lasts_s);
  file.number(key + ".release_share", limit.release_share);
  if (limit.quantity == ThreatQuantity::sharp_pressure) file.number(key + ".least_force_n", limit.least_force_n);
  file.boolean(key + ".latched", limit.latched);
  file.text(key + ".zone", limit.zone);
}

Result<ThreatLimits> read_limits(bytes::files::ConfigFile& file, const std::string& name) {
  ThreatLimits limits;
  limits.zones.resize(file.table_count("zone"));
  limits.limits.resize(file.table_count("threat"));
  for (std::size_t k = 0; k < limits.zones.size(); ++k) read_zone(file, fmt::format("zone[{}]", k), limits.zones[k]);
  for (std::size_t k = 0; k < limits.limits.size(); ++k) {
    read_limit(file, fmt::format("threat[{}]", k), limits.limits[k]);
  }
  if (const Status read = file.finish(); !read) return read.error();
  if (const Status valid = limits.validate(); !valid) return bad_input(name + ": " + valid.error().message);
  return limits;
}

template <typename Named>
bool has_twin(const std::vector<Named>& all, const Named& one) {
  return std::count_if(all.begin(), all.end(), [&](const Named& other) { return other.name == one.name; }) > 1;
}

/// Names stand in lines of text.
bool is_printable(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
}

/// The first error; empty where there is none.
std::string fault_of(const Zone& zone, const ThreatLimits& all) {
  if (has_twin(all.zones, zone)) return "stands twice; name one of them otherwise";
  if (zone.last_row < zone.first_row || zone.last_col < zone.first_col) return "ends before it begins";
  return {};
}

std::string fault_of(const ThreatLimit& limit, const ThreatLimits& all) {
  if (has_twin(all.limits, limit)) return "stands twice; name one of them otherwise";
  if (!(limit.limit > 0.0) || !std::isfinite(limit.limit)) return "the limit must be more than 0";
  if (!(limit.lasts_s >= 0.0 && limit.lasts_s <= kMostSeconds)) return "lasts_s must be 0 to 1e6";
  if (!(limit.release_share >= 0.1 && limit.release_share <= 1.0)) return "release_share must be 0.1 to 1";
  if (!(limit.least_force_n > 0.0) || !std::isfinite(limit.least_force_n)) return "least_force_n must be more than 0";
  if (!limit.zone.empty() && all.zone(limit.zone) == nullptr) return "there is no zone '" + limit.zone + "'";
  return {};
}

}  // namespace

const std::vector<std::string>& threat_quantity_names() {
  static const std::vector<std::string> kNames{"total_force",    "contact_force", "taxel_force",   "contact_pressure",
                                               "taxel_pressure", "force_rate",    "sharp_pressure"};
  return kNames;
}

const char* unit_of(ThreatQuantity quantity) noexcept {
  switch (quantity) {
    case ThreatQuantity::total_force:
    case ThreatQuantity::contact_force:
    case ThreatQuantity::taxel_force: break;
    case ThreatQuantity::force_rate: return "N/s";
    case ThreatQuantity::contact_pressure:
    case ThreatQuantity::taxel_pressure:
    case ThreatQuantity::sharp_pressure: return "Pa";
  }
  return "N";
}

const Zone* ThreatLimits::zone(std::string_view name) const noexcept {
  const auto found = std::find_if(zones.begin(), zones.end(), [&](const Zone& zone) { return zone.name == name; });
  return found == zones.end() ? nullptr : &*found;
}

Status ThreatLimits::validate() const {
  if (limits.empty()) return bad_input("no [[threat]]: name at least one limit");
  if (limits.size() > kMostLimits || zones.size() > kMostLimits) {
    return bad_input(fmt::format("at most {} limits and as many zones", kMostLimits));
  }
  for (const Zone& zone : zones) {
    if (!is_printable(zone.name)) return bad_input("zone: needs a name of one line");
    const std::string fault = fault_of(zone, *this);
    if (!fault.empty()) return bad_input("zone '" + zone.name + "': " + fault);
  }
  for (const ThreatLimit& limit : limits) {
    if (!is_printable(limit.name)) return bad_input("threat: needs a name of one line");
    const std::string fault = fault_of(limit, *this);
    if (!fault.empty()) return bad_input("threat '" + limit.name + "': " + fault);
  }
  return Done{};
}

Result<ThreatLimits> threat_limits_from_toml(std::string_view text, const std::string& name) {
  Result<bytes::files::ConfigFile> file = bytes::files::ConfigFile::parse(text, name);
  if (!file) return file.error();
  return read_limits(*file, name);
}

Result<ThreatLimits> read_threat_limits(const std::string& path) {
  Result<bytes::files::ConfigFile> file = bytes::files::ConfigFile::read(path);
  if (!file) return file.error();
  return read_limits(*file, path);
}

}  // namespace dermis::live::threats
