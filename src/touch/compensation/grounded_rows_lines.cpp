// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Lines that are broken or joined, in GroundedRows.
#include <algorithm>
#include <utility>

#include "touch/compensation/grounded_rows.hpp"
#include "touch/compensation/shorted_crossings.hpp"

namespace dermis::touch::compensation {

bool GroundedRows::set_shorted(std::span<const std::size_t> taxels) noexcept {
  if (is_broken_) return taxels.empty();
  state_.shorted.clear();
  joined_.rows.clear();
  state_.drive_ohm = joined_.drive_ohm;
  const bool can =
      sources_.ratio.empty() && !state_.film && std::all_of(taxels.begin(), taxels.end(), [&](std::size_t taxel) {
        return add_shorted(taxel / state_.cols, taxel % state_.cols);
      });
  if (can) return true;
  state_.shorted.clear();
  joined_.rows.clear();
  state_.drive_ohm = joined_.drive_ohm;
  return taxels.empty();
}

/// false: it closes a chain of lines, or the driver holds the column at its voltage.
bool GroundedRows::add_shorted(std::size_t row, std::size_t col) noexcept {
  if (joined_.drive_ohm[row] == 0.0) return false;
  const auto in_row = [&](const auto& crossing) { return crossing.row == row; };
  const auto in_col = [&](const auto& crossing) { return crossing.col == col; };
  const auto is_joined = [&](const JoinedLines::Pair& pair) { return pair.other == row; };
  const bool row_is_shorted = std::any_of(state_.shorted.begin(), state_.shorted.end(), in_row);
  const auto column = std::find_if(state_.shorted.begin(), state_.shorted.end(), in_col);
  if (std::any_of(joined_.rows.begin(), joined_.rows.end(), is_joined)) return false;
  if (column == state_.shorted.end()) {
    state_.shorted.push_back({row, col, row_is_shorted});
    return true;
  }
  double& first_ohm = state_.drive_ohm[column->row];
  if (row_is_shorted) return false;
  joined_.rows.push_back({column->row, row});
  first_ohm = 1.0 / (1.0 / first_ohm + 1.0 / joined_.drive_ohm[row]);
  return true;
}

bool GroundedRows::set_broken(std::span<const LineFault> faults) noexcept {
  if (faults.empty() && !is_broken_) return true;
  start_anew();
  mend_lines();
  const auto breaks = [&](const LineFault& fault) { return break_line(fault); };
  const auto joins = [&](const LineFault& fault) { return join_lines(fault); };
  is_broken_ = can_break_ && !faults.empty() && std::all_of(faults.begin(), faults.end(), breaks) &&
               std::all_of(faults.begin(), faults.end(), joins);
  if (!is_broken_) mend_lines();
  return is_broken_ || faults.empty();
}

void GroundedRows::mend_lines() noexcept {
  state_.drive_ohm = joined_.drive_ohm;
  state_.column_ohm = joined_.column_ohm;
  joined_.rows.clear();
  joined_.cols.clear();
  if (can_break_) sources_.ratio.clear();
}

/// A silent line that is open takes no current from its end, one at 0 V or at the supply any. false: where one column
/// at a time is loaded, the others have no end.
bool GroundedRows::break_line(const LineFault& fault) noexcept {
  const LineFaultTraits& traits = traits_of(fault.kind);
  const bool is_supplied = traits.effect == LineFaultEffect::supplied;
  if (!is_supplied && traits.effect != LineFaultEffect::silent) return true;
  const double ohm = is_supplied || fault.grounded ? 0.0 : kOpenOhm;
  if (traits.axis == Axis::row) {
    state_.drive_ohm[fault.place] = ohm;
    return true;
  }
  if (state_.idle_columns == IdleColumns::floating) return ohm > 0.0;
  state_.column_ohm[fault.place] = ohm;
  if (!is_supplied) return true;
  sources_.ratio.resize(state_.stride);
  sources_.ratio[fault.place] = 1.0;
  return true;
}

/// false: one of them is broken otherwise, too.
bool GroundedRows::join_lines(const LineFault& fault) noexcept {
  const LineFaultTraits& traits = traits_of(fault.kind);
  if (traits.effect != LineFaultEffect::shorted) return true;
  const bool are_rows = traits.axis == Axis::row;
  std::vector<JoinedLines::Pair>& pairs = are_rows ? joined_.rows : joined_.cols;
  std::vector<double>& ohms = are_rows ? state_.drive_ohm : state_.column_ohm;
  const std::vector<double>& apart = are_rows ? joined_.drive_ohm : joined_.column_ohm;
  const std::size_t other = fault.place + 1;
  if (ohms[fault.place] != apart[fault.place] || ohms[other] != apart[other] || ohms[other] == 0.0) return false;
  if (are_rows || state_.idle_columns == IdleColumns::loaded) {
    ohms[fault.place] = 1.0 / (1.0 / ohms[fault.place] + 1.0 / ohms[other]);
  }
  pairs.push_back({fault.place, other});
  return true;
}

/// Their taxels go on from the currents of the last frame.
void GroundedRows::keep_open_rows() noexcept {
  for (const auto& [row, col, siemens] : state_.kept) {
    const std::size_t k = row * state_.stride + col;
    if (state_.drive_ohm[row] == kOpenOhm) state_.measured[k] = state_.explained[k];
  }
}

/// Nothing tells the taxels of two joined lines apart.
void GroundedRows::split_joined(std::span<double> siemens) const noexcept {
  for (const auto& [first, other] : joined_.rows) {
    for (std::size_t col = 0; col < state_.cols; ++col) {
      double& whole = siemens[first * state_.cols + col];
      siemens[other * state_.cols + col] = whole *= 0.5;
    }
  }
  for (const auto& [first, other] : joined_.cols) {
    for (std::size_t row = 0; row < state_.rows; ++row) {
      double& whole = siemens[row * state_.cols + first];
      siemens[row * state_.cols + other] = whole *= 0.5;
    }
  }
}

/// Taxels of broken lines have the noise that a reading of a healthy one would give.
void GroundedRows::spread_to_kept(double sigma_ratio, std::span<double> sigma_siemens) const noexcept {
  for (const auto& [row, col, siemens] : state_.kept) {
    const double share = 1.0 + joined_.column_ohm[col] * siemens;
    sigma_siemens[row * state_.cols + col] = sigma_ratio * reading_siemens_[col] * share * share;
  }
}

/// Joined rows are driven together, and joined columns sensed so; of the second of them nothing is left.
void GroundedRows::load_joined() noexcept {
  for (const JoinedLines::Pair& pair : joined_.rows) {
    move_kept([](auto& taxel) -> std::size_t& { return taxel.row; }, pair);
    for (std::size_t col = 0; col < state_.cols; ++col) {
      double& reading = state_.measured[pair.other * state_.stride + col];
      state_.measured[pair.first * state_.stride + col] += std::exchange(reading, 0.0);
    }
  }
  const bool are_loaded = state_.idle_columns == IdleColumns::loaded;
  for (const JoinedLines::Pair& pair : joined_.cols) {
    move_kept([](auto& taxel) -> std::size_t& { return taxel.col; }, pair);
    for (std::size_t k = 0; k < state_.measured.size(); k += state_.stride) {
      const double reading = std::exchange(state_.measured[k + pair.other], 0.0);
      state_.measured[k + pair.first] += are_loaded ? reading : 0.0;
    }
  }
}

/// Where one of two joined taxels has no reading, both are kept; where neither has, the first is kept at both together.
template <typename Line>
void GroundedRows::move_kept(Line line, const JoinedLines::Pair& pair) noexcept {
  for (auto& taxel : state_.kept) {
    if (line(taxel) != pair.other) continue;
    GroundedRowsState::KeptTaxel moved = taxel;
    line(moved) = pair.first;
    const auto is_first = [&](const auto& kept) { return kept.row == moved.row && kept.col == moved.col; };
    const auto first = std::find_if(state_.kept.begin(), state_.kept.end(), is_first);
    if (first == state_.kept.end()) {
      taxel = moved;
    } else {
      first->siemens += taxel.siemens;
    }
  }
  std::erase_if(state_.kept, [&](auto& taxel) { return line(taxel) == pair.other; });
}

}  // namespace dermis::touch::compensation
