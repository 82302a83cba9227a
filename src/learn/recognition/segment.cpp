// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/segment.hpp"

#include "dermis/touch/frames/millimetres.hpp"
#include "learn/recognition/names.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr std::size_t kMostArrays = 64;
constexpr std::size_t kMostReadings = std::size_t{1} << 20U;
constexpr std::size_t kMostExtras = 1024;
constexpr double kLeastPitch = 1e-3;
constexpr double kMostPitch = 1e4;
constexpr double kLeastRate = 1e-3;
constexpr double kMostRate = 1e6;

Status check_array(const SensedArray& array, std::size_t readings) {
  const auto error = [&](const std::string& what) { return bad_input("array '" + array.name + "': " + what); };
  if (!is_plain_text(array.name)) return error("its name must be UTF-8 without control characters");
  const bool is_sized = array.rows >= 1 && array.rows <= kMostLines && array.cols >= 1 && array.cols <= kMostLines;
  if (!is_sized) return error("rows and cols must be 1 to 1024");
  if (array.first_column > readings || array.taxel_count() > readings - array.first_column) {
    return error("ends beyond the " + std::to_string(readings) + " readings of a frame");
  }
  for (const double pitch : {array.row_pitch_mm, array.col_pitch_mm}) {
    const bool is_known = pitch >= kLeastPitch && pitch <= kMostPitch;
    if (!is_known && pitch != 0.0) return error("its pitch must be 0.001 to 10000 mm, or 0 where it is not known");
  }
  if ((array.row_pitch_mm > 0.0) != (array.col_pitch_mm > 0.0))
    return error("give the pitch of rows and columns, or none");
  return Done{};
}

Status check_overlap(const std::vector<SensedArray>& arrays, std::size_t readings) {
  std::size_t taxels = 0;
  for (const SensedArray& array : arrays) taxels += array.taxel_count();
  if (taxels <= readings) return Done{};
  return bad_input("arrays: overlap, they have " + std::to_string(taxels) + " taxels and a frame " +
                   std::to_string(readings) + " readings; each reading belongs to one array");
}

}  // namespace

SensedArray sensed_array(const ArrayDescription& array, const std::string& name) {
  return {.name = name,
          .rows = array.rows,
          .cols = array.cols,
          .row_pitch_mm = kMillimetresPerMetre * array.row_pitch_m,
          .col_pitch_mm = kMillimetresPerMetre * array.col_pitch_m};
}

std::vector<std::string> names_of(const std::vector<SensedArray>& arrays) {
  std::vector<std::string> names;
  for (const SensedArray& array : arrays) names.push_back(array.name);
  return names;
}

bool is_rate(double rate_hz) noexcept {
  return rate_hz == 0.0 || (rate_hz >= kLeastRate && rate_hz <= kMostRate);
}

Status Layout::validate() const {
  if (arrays.empty() || arrays.size() > kMostArrays) return bad_input("arrays: must be 1 to 64");
  if (readings > kMostReadings) return bad_input("readings: must be at most 1048576");
  if (extras > kMostExtras) return bad_input("extras: must be at most 1024");
  if (!is_rate(rate_hz)) return bad_input("rate_hz: must be 0.001 to 1e6, or 0 where it is not known");
  for (const SensedArray& array : arrays) {
    if (Status checked = check_array(array, readings); !checked) return checked;
  }
  return check_overlap(arrays, readings);
}

}  // namespace dermis::learn::recognition
