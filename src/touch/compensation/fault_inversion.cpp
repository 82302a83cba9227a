// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/fault_inversion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "touch/compensation/faults/masked_taxels.hpp"
#include "touch/compensation/readout_parts.hpp"
#include "touch/compensation/sensed_line.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kMostRounds = 12.0;     // of a frame,
constexpr double kRounds = 3.0;          // and of each on average
constexpr std::size_t kMixingDepth = 8;  // likewise
constexpr double kLeastChange = 2e-5;    // by an estimate, of the voltages of others
constexpr int kEstimateRounds = 3;       // the estimate from a taxel's neighbours hardly depends on it
constexpr double kEstimateWork = 6.0;    // to estimate a line of taxels, in rounds of a correction
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();  // a reading that is not used
constexpr double kShortSiemens = 20.0;                                 // of a shorted crossing that is kept
constexpr double kOpenSiemens = 1e-9;                                  // of a taxel that is counted elsewhere
constexpr std::size_t kMostLines = 256;  // rows and columns together: beyond, the dense equations are too slow

bool is_modelled(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  return array.rows + array.cols <= kMostLines && readout.circuit != Circuit::none && !has_resistive_lines(readout) &&
         has_ideal_amplifiers(readout);
}

}  // namespace

FaultInversion::Correction::Correction(std::size_t taxels)
    : shift(taxels),
      difference(taxels),
      last_difference(taxels),
      last_corrected(taxels),
      healthy_ratio(taxels),
      faulty_ratio(taxels) {}

FaultInversion::Masks::Masks(const ArrayDescription& array)
    : masked(array.taxel_count()), hidden(array.taxel_count()) {}

FaultInversion::FaultInversion(const ArrayDescription& array, double tolerance_ratio,
                               const ReferenceConductances& references)
    : array_(array),
      tolerance_(tolerance_ratio),
      film_(array, references),
      is_(array),
      missing_(array_, references),
      measured_(array.taxel_count()),
      equivalent_(array.taxel_count()),
      lines_(array.rows, array.cols),
      budget_(kMostRounds, kRounds),
      correction_(array.taxel_count()) {
  if (film_.any()) mixing_.emplace(array.taxel_count(), kMixingDepth);
  if (is_modelled(array)) circuits_ = Circuits{LumpedCircuit(array), LumpedCircuit(array)};
  supplied_rows_.reserve(array.rows);
  crossings_.taxels.reserve(array.taxel_count());
  crossings_.in_first.reserve(array.taxel_count());
  crossings_.spanning.reserve(array.taxel_count());
  for (const Axis axis : kAxes) is_shorted_to_next_[axis].resize(line_count(array, axis));
}

void FaultInversion::set_faults(std::span<const LineFault> faults, CrosstalkInversion& healthy) {
  any_ = std::any_of(faults.begin(), faults.end(),
                     [](const LineFault& fault) { return fault.kind != LineFaultKind::drifting_driver; });
  keeps_bounds_ = true;
  has_crossings_ = false;
  lines_are_faulty_ = false;
  std::fill(is_.masked.begin(), is_.masked.end(), std::uint8_t{0});
  std::fill(is_.hidden.begin(), is_.hidden.end(), std::uint8_t{0});
  supplied_rows_.clear();
  for (const Axis axis : kAxes) {
    std::fill(is_shorted_to_next_[axis].begin(), is_shorted_to_next_[axis].end(), std::uint8_t{0});
  }
  lines_.separate();
  crossings_.taxels.clear();
  crossings_.spanning.clear();
  crossings_.in_first.clear();
  if (circuits_) {
    circuits_->healthy.restore();
    circuits_->faulty.restore();
  }
  for (const LineFault& fault : faults) add(fault);
  const bool are_broken = lines_are_faulty_ && !has_crossings_;
  lines_are_solved_ = healthy.set_broken(are_broken ? faults : std::span<const LineFault>()) && are_broken;
  correction_.has_shift = false;
  add_crossings(healthy);
}

void FaultInversion::add(const LineFault& fault) {
  const LineFaultTraits& traits = traits_of(fault.kind);
  for_each_masked_taxel(fault, array_, [&](std::size_t taxel) {
    is_.masked[taxel] = 1;
    if (!traits.hides_conductance) return;
    is_.hidden[taxel] = 1;
    missing_.forget(taxel);  // what it was came of the fault, too
  });
  if (array_.readout.circuit == Circuit::none) return;  // nothing to subtract or to solve
  if (fault.kind == LineFaultKind::supplied_row) supplied_rows_.push_back(fault.place);
  has_crossings_ = has_crossings_ || fault.kind == LineFaultKind::shorted_crossing;
  if (traits.effect == LineFaultEffect::shorted) is_shorted_to_next_[*traits.axis][fault.place] = 1;
  lines_.join(fault, array_);
  keeps_bounds_ =
      keeps_bounds_ && traits.effect != LineFaultEffect::shorted && traits.effect != LineFaultEffect::supplied;
  lines_are_faulty_ =
      lines_are_faulty_ || traits.scope == LineFaultScope::line || traits.scope == LineFaultScope::line_pair;
  if (!circuits_) return;
  add_to_circuit(fault, circuits_->faulty);
}

/// Lines that touch are one line, with all that either touches.
void FaultInversion::add_crossings(CrosstalkInversion& healthy) {
  if (has_crossings_) find_crossings();
  const bool are_solved = healthy.set_shorted(crossings_.spanning);
  crossings_.are_corrected = !are_solved && circuits_ && has_grounded_idle_lines(array_.readout);
  crossings_.are_kept = !are_solved && !crossings_.are_corrected;
  lines_are_faulty_ = lines_are_faulty_ || crossings_.are_corrected;
  if (has_crossings_) mask_joined(are_solved);
  if (array_.readout.idle_rows == IdleRows::floating && circuits_) put_in_first_rows();
  for (const std::size_t taxel : crossings_.spanning) {
    if (crossings_.are_corrected) hide_sensed_line(taxel);
    if (!circuits_) continue;
    circuits_->faulty.join_crossing(taxel);
    if (!crossings_.are_corrected) circuits_->healthy.join_crossing(taxel);
  }
}

/// All crossings of lines that are one, and those of the first row and the first column, which join them all. At
/// virtual ground the rows read nothing, and join none.
void FaultInversion::find_crossings() noexcept {
  for (std::size_t row = 0; row < array_.rows; ++row) {
    for (std::size_t col = 0; col < array_.cols; ++col) {
      const std::size_t first = lines_.first_of(row);
      if (lines_.first_of(array_.rows + col) != first) continue;
      const std::size_t taxel = array_.index(row, col);
      const bool is_in_first = row == first || lines_.is_first_column(col);
      crossings_.taxels.push_back(taxel);
      if (is_in_first && array_.readout.circuit != Circuit::transimpedance) crossings_.spanning.push_back(taxel);
    }
  }
}

/// No reading tells of the taxels of lines that are one, nor of the two between two nodes.
void FaultInversion::mask_joined(bool are_solved) noexcept {
  for (std::size_t taxel = 0; taxel < is_.masked.size(); ++taxel) {
    const std::size_t row = taxel / array_.cols;
    const std::size_t col = taxel % array_.cols;
    const bool is_crossing = lines_.first_of(row) == lines_.first_of(array_.rows + col);
    const bool is_between = lines_.crosses(row) && lines_.crosses(array_.rows + col);
    const bool is_joined = lines_.has_other_row(row) || lines_.has_other_column(col);
    if (is_between || is_joined) is_.masked[taxel] = 1;
    const bool is_second = (lines_.crosses(row) && lines_.first_of(row) != row) ||
                           (lines_.crosses(array_.rows + col) && !lines_.is_first_column(col));
    if (!are_solved && is_second && !is_crossing) crossings_.in_first.push_back(taxel);
  }
}

/// Where idle rows float, rows that are one are the first of them, and the others nothing.
void FaultInversion::put_in_first_rows() noexcept {
  for (std::size_t taxel = 0; taxel < is_.masked.size(); ++taxel) {
    const std::size_t row = taxel / array_.cols;
    if (!lines_.crosses(row) && lines_.first_of(row) != row) crossings_.in_first.push_back(taxel);
  }
}

/// Beside a driver next to nothing is read of the others of the line.
void FaultInversion::hide_sensed_line(std::size_t taxel) noexcept {
  const Axis sensed = crossing(driven_axis(array_));
  const std::size_t line = line_of(array_, sensed, taxel);
  for (std::size_t k = 0; k < line_length(array_, sensed); ++k) {
    is_.masked[taxel_on_line(array_, sensed, line, k)] = is_.hidden[taxel_on_line(array_, sensed, line, k)] = 1;
  }
}

void FaultInversion::add_to_circuit(const LineFault& fault, LumpedCircuit& circuit) const {
  const LineFaultTraits& traits = traits_of(fault.kind);
  switch (traits.effect) {
    case LineFaultEffect::silent:
      fault.grounded ? circuit.ground_line(*traits.axis, fault.place) : circuit.open_line(*traits.axis, fault.place);
      break;
    case LineFaultEffect::supplied:
      if (traits.axis == Axis::column) {
        circuit.tie_column_to_supply(fault.place);
      } else if (driven_axis(array_) == Axis::row) {  // its readings subtracted, it is a row with an ideal driver
        circuit.set_drive_ohm(fault.place, 0.0);
      }
      break;
    case LineFaultEffect::shorted: circuit.join_lines(*traits.axis, fault.place); break;
    case LineFaultEffect::crossed:
    case LineFaultEffect::stuck:
    case LineFaultEffect::impossible:
    case LineFaultEffect::dead:
    case LineFaultEffect::drifting: break;  // of the reading, of the taxel's conductance, reported alone
  }
}

/// A conductance of a driven line k and a sensed line j that is wrong by d changes the others to first order. Their
/// share is Rd_k d, or RL_j d.
void FaultInversion::add_doubt(std::span<const float> doubt_siemens, std::span<const double> siemens,
                               std::span<double> sigma_siemens) const noexcept {
  if (array_.readout.circuit == Circuit::none) return;
  const Axis driven = driven_axis(array_);
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    const auto error = static_cast<double>(doubt_siemens[taxel]);
    if (error != 0.0) sigma_siemens[taxel] = std::hypot(sigma_siemens[taxel], error);
  }
  for (const Axis axis : kAxes) {
    for (std::size_t line = 0; line < line_count(array_, axis); ++line) {
      double squares = 0.0;
      for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
        const auto error = static_cast<double>(doubt_siemens[taxel_on_line(array_, axis, line, k)]);
        squares += error * error;
      }
      if (squares == 0.0) continue;
      const double ohm = axis == driven ? array_.readout.drive_ohm[line] : sensed_line(array_.readout, line).rho;
      for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
        const std::size_t other = taxel_on_line(array_, axis, line, k);
        const double share = ohm * siemens[other];
        sigma_siemens[other] = std::sqrt(sigma_siemens[other] * sigma_siemens[other] + squares * share * share);
      }
    }
  }
}

void FaultInversion::find_doubt(std::span<const double> siemens, std::span<float> doubt_siemens) const noexcept {
  std::fill(doubt_siemens.begin(), doubt_siemens.end(), 0.0F);
  if (array_.readout.circuit == Circuit::none || lines_are_faulty_ || !missing_.any()) return;
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    if (is_doubtful(taxel)) doubt_siemens[taxel] = static_cast<float>(missing_.doubt(taxel) * siemens[taxel]);
  }
}

/// Only its estimate is known; a short is what it is.
bool FaultInversion::is_doubtful(std::size_t taxel) const noexcept {
  return missing_.is_missing(taxel) && !std::binary_search(crossings_.taxels.begin(), crossings_.taxels.end(), taxel);
}

bool FaultInversion::concerns(std::span<const TaxelStatus> taxels) noexcept {
  const bool any_unread = missing_.mark(taxels, is_.hidden);
  return any_ || any_unread;
}

InversionResult FaultInversion::invert(CrosstalkInversion& healthy, std::span<const double> ratio,
                                       std::span<double> siemens) noexcept {
  subtract_supplied_rows(ratio);
  average_shorted_lines();
  std::copy(measured_.begin(), measured_.end(), equivalent_.begin());
  if (!lines_are_faulty_ || lines_are_solved_) return keep_estimates(healthy, siemens);
  start_circuits();
  keep_crossings(siemens);
  InversionResult result = healthy.invert(equivalent_, siemens);
  if (!circuits_) return result;
  result.residual_ratio = std::numeric_limits<double>::infinity();  // of the circuit with faults
  for (bool is_first = true; budget_.take(1.0); is_first = false) {
    missing_.estimate(siemens);
    for (const std::size_t taxel : crossings_.in_first) siemens[taxel] = kOpenSiemens;
    solve_circuits(siemens);
    result.residual_ratio = misfit(siemens);
    if (correct(is_first) <= tolerance_) {
      keep_shift();
      return result;
    }
    keep_crossings(siemens);
    const InversionResult inverted = healthy.invert(equivalent_, siemens);
    result.solved = inverted.solved;
    if (!inverted.cut_short) continue;
    result.residual_ratio += inverted.residual_ratio;
    break;
  }
  correction_.has_shift = false;
  if (result.residual_ratio <= kMostLeft) keep_shift();
  return {false, result.residual_ratio, true};
}

/// The inversion knows of the broken lines. Taxels without a reading are estimated, and the others solved with them.
InversionResult FaultInversion::keep_estimates(CrosstalkInversion& healthy, std::span<double> siemens) noexcept {
  const bool has_start = start_missing(healthy, siemens);
  keep_crossings(siemens);
  InversionResult result = healthy.invert(equivalent_, siemens);
  double missing_lines = 0.0;
  for (std::size_t taxel = 0; taxel < equivalent_.size(); ++taxel) {
    if (!missing_.is_missing(taxel)) continue;
    equivalent_[taxel] = kNothing;
    missing_lines += 1.0 / static_cast<double>(array_.cols);
  }
  const double work = kEstimateWork * std::min(missing_lines, 1.0);
  bool are_judged = has_start && missing_.are_fresh(measured_);
  for (int round = are_judged ? kEstimateRounds : 1; round < kEstimateRounds && !result.cut_short; ++round) {
    if (!budget_.take(work)) break;
    if (round == 1) missing_.note_readings(measured_);
    are_judged = true;
    if (missing_.improve(siemens, !lines_are_solved_) <= kLeastChange && has_start) break;
    keep_crossings(siemens);
    result = healthy.invert(equivalent_, siemens);
  }
  if (!are_judged) missing_.doubt_estimates();
  missing_.keep_estimates(siemens, result.solved || (result.cut_short && result.residual_ratio <= kMostLeft));
  return result;
}

/// From the last frame; at first the readings of the neighbours tell of taxels. Whether all were known.
bool FaultInversion::start_missing(const CrosstalkInversion& healthy, std::span<double> siemens) noexcept {
  bool are_known = true;
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    are_known = are_known && (!missing_.is_missing(taxel) || missing_.start(taxel));
  }
  if (!are_known) missing_.estimate(equivalent_);
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    if (!missing_.is_missing(taxel)) continue;
    const std::optional<double> start = missing_.start(taxel);
    if (!start && !lines_are_solved_) continue;
    siemens[taxel] = start.value_or(healthy.siemens_per_ratio() * std::max(equivalent_[taxel], 0.0));
    equivalent_[taxel] = kNothing;
  }
  return are_known;
}

/// Their readings count where the inversion solves them; else they are what they are.
void FaultInversion::keep_crossings(std::span<double> siemens) noexcept {
  for (const std::size_t taxel : crossings_.in_first) siemens[taxel] = kOpenSiemens;
  if (crossings_.are_corrected || crossings_.spanning.empty()) return;
  for (const std::size_t taxel : crossings_.in_first) equivalent_[taxel] = kNothing;
  for (const std::size_t taxel : crossings_.taxels) {
    equivalent_[taxel] = crossings_.are_kept ? kNothing : measured_[taxel];
    if (crossings_.are_kept) siemens[taxel] = kShortSiemens;
  }
}

/// Lines that are one node give the same reading several times, in known ratios; what differs is noise.
void FaultInversion::average_shorted_lines() noexcept {
  for (const Axis axis : kAxes) {
    for (std::size_t first = 0; first < line_count(array_, axis); ++first) {
      const std::size_t start = first;
      while (is_shorted_to_next_[axis][first] != 0) ++first;
      if (first > start) average(axis, start, first);
    }
  }
}

void FaultInversion::average(Axis axis, std::size_t first, std::size_t last) noexcept {
  for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
    double share = 1.0;
    double sum = 0.0;
    double squares = 0.0;
    const auto for_each = [&](const auto& visit) {
      share = 1.0;
      for (std::size_t line = first; line <= last; ++line) {
        visit(measured_[taxel_on_line(array_, axis, line, k)]);
        if (line < last) share /= ratio_of_shorted_lines(array_, axis, line);
      }
    };
    for_each([&](double reading) {
      sum += share * reading;
      squares += share * share;
    });
    for_each([&](double& reading) { reading = share * sum / squares; });
  }
}

/// A row at the supply adds to every scan what its own scan reads (superposition).
void FaultInversion::subtract_supplied_rows(std::span<const double> ratio) noexcept {
  std::copy(ratio.begin(), ratio.end(), measured_.begin());
  for (const std::size_t supplied : supplied_rows_) {
    for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
      if (taxel / array_.cols != supplied) measured_[taxel] -= ratio[array_.index(supplied, taxel % array_.cols)];
    }
  }
}

}  // namespace dermis::touch::compensation
