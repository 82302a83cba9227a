// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/core/array_description.hpp"

#include <cmath>

namespace dermis {
namespace {

constexpr int kMaxAdcBits = 24;  // Counts are kept in float, which holds 24 bits exactly.

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

Status validate_resistors(const char* field, const std::vector<double>& ohms, std::size_t lines, bool zero_allowed) {
  const std::string name = std::string("readout.") + field;
  if (ohms.size() != lines) {
    return bad_input(name + ": has " + std::to_string(ohms.size()) + " values, the array needs " +
                     std::to_string(lines));
  }
  for (const double ohm : ohms) {
    if (!is_positive(ohm) && !(zero_allowed && ohm == 0.0)) {
      return bad_input(name + ": must be " + (zero_allowed ? "0 or more" : "more than 0") + " ohm");
    }
  }
  return Done{};
}

Status validate_readout(const Readout& readout, std::size_t rows, std::size_t cols) {
  if (readout.adc_bits < 1 || readout.adc_bits > kMaxAdcBits) {
    return bad_input("readout.adc_bits: must be 1 to " + std::to_string(kMaxAdcBits));
  }
  if (readout.adc_reference_v && !is_positive(*readout.adc_reference_v)) {
    return bad_input("readout.adc_reference_v: must be more than 0 V");
  }
  if (readout.supply_v && !is_positive(*readout.supply_v)) {
    return bad_input("readout.supply_v: must be more than 0 V");
  }
  if (readout.circuit == Circuit::none) return Done{};
  if (Status drive = validate_resistors("drive_ohm", readout.drive_ohm, rows, true); !drive) return drive;
  return validate_resistors("load_ohm", readout.load_ohm, cols, false);
}

}  // namespace

double Readout::full_scale_counts() const noexcept {
  return std::ldexp(1.0, adc_bits) - 1.0;
}

std::string ArrayDescription::taxel_name(std::size_t taxel) const {
  return dermis::taxel_name(taxel / cols, taxel % cols);
}

Status ArrayDescription::validate() const {
  if (rows < 1 || rows > kMaxLines) return bad_input("array.rows: must be 1 to " + std::to_string(kMaxLines));
  if (cols < 1 || cols > kMaxLines) return bad_input("array.cols: must be 1 to " + std::to_string(kMaxLines));
  if (!is_positive(row_pitch_m) || !is_positive(col_pitch_m))
    return bad_input("array.pitch_mm: must be more than 0 mm");
  if (taxel_area_m2 && !is_positive(*taxel_area_m2)) return bad_input("array.taxel_area_mm2: must be more than 0 mm2");
  return validate_readout(readout, rows, cols);
}

const char* to_string(Circuit circuit) noexcept {
  switch (circuit) {
    case Circuit::divider: return "divider";
    case Circuit::transimpedance: return "transimpedance";
    case Circuit::none: return "none";
  }
  return "none";
}

const char* to_string(IdleRows idle_rows) noexcept {
  return idle_rows == IdleRows::grounded ? "grounded" : "floating";
}

std::string taxel_name(std::size_t row, std::size_t col) {
  return "r" + std::to_string(row) + "c" + std::to_string(col);
}

}  // namespace dermis
