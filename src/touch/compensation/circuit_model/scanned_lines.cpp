// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/scanned_lines.hpp"

#include <algorithm>
#include <cassert>

#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {

ScannedLines::ScannedLines(const ArrayDescription& array)
    : array_(array),
      film_(array.rows, array.cols),
      columns_are_driven_(array.readout.circuit == Circuit::flexitac),
      driven_are_tied_(columns_are_driven_ || array.readout.idle_rows == IdleRows::grounded),
      sensed_are_tied_(!columns_are_driven_ && array.readout.idle_columns == IdleColumns::loaded),
      driven_(array.driven_lines()),
      series_ohm_(has_supply_in_series(array) ? array.readout.supply_ohm.value_or(0.0) : 0.0),
      supply_ohm_(array.readout.supply_ohm.value_or(0.0) - series_ohm_),
      rho_(array.driven_lines() + array.sensed_lines()),
      sensed_head_(array.sensed_lines()) {
  read_resistors();
  if (has_film()) film_.set(*array.readout.film, std::vector<double>(array.taxel_count()));
}

void ScannedLines::set_resistors(std::span<const double> drive_ohm, std::span<const double> load_ohm) {
  Readout& readout = array_.readout;
  assert(drive_ohm.size() == readout.drive_ohm.size() && load_ohm.size() == readout.load_ohm.size());
  readout.drive_ohm.assign(drive_ohm.begin(), drive_ohm.end());
  readout.load_ohm.assign(load_ohm.begin(), load_ohm.end());
  read_resistors();
}

void ScannedLines::read_resistors() {
  for (std::size_t d = 0; d < driven_; ++d) rho_[d] = array_.readout.drive_ohm[d] + series_ohm_;
  for (std::size_t s = 0; s < sensed(); ++s) {
    sensed_head_[s] = sensed_line(array_.readout, s);
    rho_[driven_ + s] = sensed_head_[s].rho;
  }
}

std::vector<bool> ScannedLines::held() const {
  std::vector<bool> held(count());
  for (std::size_t line = 0; line < count(); ++line) held[line] = is_held(line);
  return held;
}

double ScannedLines::segment_ohm(std::size_t line) const noexcept {
  const std::vector<double>& ohms = is_row(line) ? array_.readout.row_segment_ohm : array_.readout.column_segment_ohm;
  return ohms.empty() ? 0.0 : ohms[number(line)];
}

}  // namespace dermis::touch::compensation
