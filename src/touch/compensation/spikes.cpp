// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/spikes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/readout_parts.hpp"
#include "touch/compensation/sensed_line.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr Nanos kLongestGap = std::chrono::milliseconds(50);
constexpr double kLeastRise = 1.02;   // of the others, by all jumps of a line: below, nothing is seen of it
constexpr double kLeastLeft = 0.01;   // of the supply
constexpr double kMoves = 0.06;       // of a load that moves, from frame to frame
constexpr double kMovesMost = 25.0;   // times the square of that; else it is another load
constexpr double kCircuit = 0.2;      // of the crosstalk's change: the circuit is not known better
constexpr double kRisenSigmas = 3.0;  // of a reading that does not stay
constexpr double kRisenShare = 0.1;   // and of the rise that a spike seems to be
constexpr double kOther = 0.05;       // density of what else may happen to a load, over that of a sigma
constexpr double kLoadedSigmas = 20.0;
constexpr double kMostChange = 0.3;        // of a load that moves
constexpr double kMostChanged = 0.2;       // of the loads: beyond, one that stays tells nothing
constexpr double kOtherTouch = 2.0 / 3.0;  // of the loads: beyond, the last frame tells nothing of this one
constexpr double kLoadsBefore = 1.0;       // that tell how many change, before any is seen
constexpr double kChangedBefore = 0.1;
constexpr double kPrior = 0.002;          // of a spike, to a press
constexpr double kPriorOfTouched = 3e-6;  // beside another
constexpr double kHopeless = 1e-12;       // odds that no further witness turns
constexpr double kCertain = 1e100;
constexpr double kNever = 80.0;  // squares of a standard deviation
constexpr double kSure = 0.95;
constexpr double kDoubtful = 0.5;
constexpr double kSeenSigmas = 6.0;
constexpr double kNewShare = 0.125;  // of a frame in the mean
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint8_t kMostFrames = 3;

}  // namespace

Spikes::Spikes(const ArrayDescription& array)
    : rows_(array.rows),
      cols_(array.cols),
      axis_(sharing_axis(array).value_or(Axis::column)),
      lines_(line_count(array, axis_)),
      places_(line_length(array, axis_)),
      last_(array.taxel_count(), kUnknown),
      last_siemens_(array.taxel_count(), kUnknown),
      frames_(array.taxel_count()) {
  if (!sharing_axis(array)) return;
  const Readout& readout = array.readout;
  std::vector<double> sensed_ohm;
  for (std::size_t line = 0; line < array.sensed_lines(); ++line) {
    sensed_ohm.push_back(sensed_line(readout, line).rho);
  }
  const bool is_driven = axis_ == driven_axis(array);
  const std::vector<double>& line_ohm = is_driven ? readout.drive_ohm : sensed_ohm;
  const std::vector<double>& crossing_ohm = is_driven ? sensed_ohm : readout.drive_ohm;
  for (const double ohm : line_ohm) load_siemens_.push_back(ohm > 0.0 ? 1.0 / ohm : 0.0);
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    const SensedLine sensed = sensed_line(readout, line_of(array, crossing(driven_axis(array)), taxel));
    share_.push_back(line_ohm[line_of(array, axis_, taxel)] / sensed.gain);
    crossing_ohm_.push_back(crossing_ohm[line_of(array, crossing(axis_), taxel)]);
  }
  behind_.now.resize(array.taxel_count());
  behind_.before.resize(array.taxel_count());
  loads_.now.resize(lines_);
  loads_.before.resize(lines_);
  jumps_.reserve(places_);
  doubts_.reserve(array.taxel_count());
}

bool Spikes::take(const ConditionedFrame& frame, bool is_solved, ConductanceFrame& conductance) noexcept {
  if (load_siemens_.empty()) return false;
  const Nanos since_last = frame.time - last_time_;
  is_next_ = has_last_ && since_last <= kLongestGap && since_last >= Nanos{0};
  if (!is_next_ || !any_jump(frame.ratio)) return false;
  changed_ = changed_share(frame.ratio, frame.sigma_ratio);
  if (changed_ > kOtherTouch) return false;
  find_behind(conductance);
  find_loads(frame, conductance.taxels, is_solved);
  bool any = false;
  for (std::size_t line = 0; line < lines_; ++line) any = take_line(line, frame, is_solved, conductance) || any;
  any_taken_ = any_taken_ || any;
  return any;
}

bool Spikes::take_line(std::size_t line, const ConditionedFrame& frame, bool is_solved,
                       ConductanceFrame& conductance) noexcept {
  if (load_siemens_[line] == 0.0 || !find_jumps(line, frame, conductance.taxels)) return false;
  const double probable = probability(line, frame, conductance.taxels, is_solved);
  for (const std::size_t taxel : jumps_) {
    if (probable > kSure) {
      conductance.taxels[taxel] = TaxelStatus::invalid;
      ++frames_[taxel];
    } else if (probable > kDoubtful && is_solved) {
      const double jump = conductance.siemens[taxel] - last_siemens_[taxel];
      doubts_.push_back({taxel, std::sqrt(probable) * std::abs(jump)});
    }
  }
  return probable > kSure;
}

/// Whether there are some, and none that has long not been believed.
bool Spikes::find_jumps(std::size_t line, const ConditionedFrame& frame, std::span<const TaxelStatus> taxels) noexcept {
  jumps_.clear();
  for (std::size_t place = 0; place < places_; ++place) {
    const std::size_t taxel = taxel_of(line, place);
    if (!is_jump(taxel, frame.ratio) || taxels[taxel] == TaxelStatus::invalid) continue;
    if (frames_[taxel] == kMostFrames) return false;
    jumps_.push_back(taxel);
  }
  return !jumps_.empty();
}

DERMIS_PROCESSOR_CLONES void Spikes::find_behind(const ConductanceFrame& conductance) noexcept {
  const double* const siemens = conductance.siemens.data();
  const double* const last = last_siemens_.data();
  const double* const ohm = crossing_ohm_.data();
  double* const now = behind_.now.data();
  double* const before = behind_.before.data();
#pragma omp simd
  for (std::size_t taxel = 0; taxel < behind_.now.size(); ++taxel) {
    const bool is_known = last[taxel] == last[taxel];
    now[taxel] = is_known ? siemens[taxel] / (1.0 + ohm[taxel] * siemens[taxel]) : 0.0;
    before[taxel] = is_known ? last[taxel] / (1.0 + ohm[taxel] * last[taxel]) : 0.0;
  }
  for (std::size_t taxel = 0; taxel < behind_.now.size(); ++taxel) {
    if (conductance.taxels[taxel] == TaxelStatus::invalid) now[taxel] = before[taxel] = 0.0;
  }
}

/// Where there is no solution, the conductances are those of a circuit that has no other crosstalk.
void Spikes::find_loads(const ConditionedFrame& frame, std::span<const TaxelStatus> taxels, bool is_solved) noexcept {
  loads_.now = load_siemens_;
  loads_.before = load_siemens_;
  if (!is_solved) return find_loads_by_readings(frame, taxels);
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t line = axis_ == Axis::row ? row : col;
      loads_.now[line] += behind_.now[row * cols_ + col];
      loads_.before[line] += behind_.before[row * cols_ + col];
    }
  }
}

void Spikes::find_loads_by_readings(const ConditionedFrame& frame, std::span<const TaxelStatus> taxels) noexcept {
  for (std::size_t line = 0; line < lines_; ++line) {
    double left = 1.0;
    double last_left = 1.0;
    for (std::size_t place = 0; place < places_; ++place) {
      const std::size_t taxel = taxel_of(line, place);
      if (!is_known(taxel, taxels)) continue;
      left -= share_[taxel] * frame.ratio[taxel];
      last_left -= share_[taxel] * last_[taxel];
    }
    loads_.now[line] /= std::max(left, kLeastLeft);
    loads_.before[line] /= std::max(last_left, kLeastLeft);
  }
}

Spikes::Witness Spikes::witness(std::size_t taxel, const ConditionedFrame& frame, bool is_solved) const noexcept {
  const double load = loads_.now[line_at(taxel)];
  const double reads = share_[taxel] * frame.ratio[taxel] * load;
  const double has_read = share_[taxel] * last_[taxel] * load;
  const double read_before = share_[taxel] * last_[taxel] * loads_.before[line_at(taxel)];
  const double now = is_solved ? behind_.now[taxel] : reads;
  const double before = is_solved ? behind_.before[taxel] : read_before;
  return {.now = now,
          .before = before,
          .reads = reads,
          .has_read = has_read,
          .noise = share_[taxel] * frame.sigma_ratio * load,
          .crosstalk = kCircuit * ((reads - now) - (read_before - before))};
}

/// That the jumps are spikes: by Bayes' theorem, from what the witnesses tell.
double Spikes::probability(std::size_t line, const ConditionedFrame& frame, std::span<const TaxelStatus> taxels,
                           bool is_solved) const noexcept {
  double now = load_siemens_[line];
  double before = now;
  double odds = 1.0;
  for (const std::size_t taxel : jumps_) {
    const Witness jump = witness(taxel, frame, is_solved);
    now += jump.now;
    before += jump.before;
    odds *= is_touched(taxel, frame.ratio, frame.sigma_ratio) ? kPriorOfTouched : kPrior;
  }
  const double rise = now / before;
  if (rise < kLeastRise) return 0.0;
  for (std::size_t place = 0; place < places_ && odds > kHopeless; ++place) {
    const std::size_t taxel = taxel_of(line, place);
    if (!is_known(taxel, taxels) || is_jump(taxel, frame.ratio)) continue;
    odds = std::min(odds * evidence(witness(taxel, frame, is_solved), rise), kCertain);
  }
  return odds / (1.0 + odds);
}

/// How much likelier the witness is after spikes by which it seems to rise so. A reading that rises does not stay.
double Spikes::evidence(const Witness& witness, double rise) const noexcept {
  const double change = witness.reads - witness.has_read;
  const double noise_of_press = std::sqrt(witness.noise * witness.noise + witness.crosstalk * witness.crosstalk);
  const double of_press = density(witness, witness.now - witness.before, noise_of_press, kMoves * witness.before);
  const double of_spike = density(witness, change, witness.noise, kMoves * witness.has_read);
  const bool rises = change > kRisenSigmas * witness.noise + kRisenShare * (rise - 1.0) * witness.has_read;
  const bool is_load = witness.has_read > kLoadedSigmas * witness.noise;
  const bool may_stay = !rises && (!is_load || changed_ < kMostChanged);
  return may_stay ? of_spike / of_press : std::min(of_spike / of_press, 1.0);
}

/// The witness is what it was, up to its noise, or it moved; or something else happened to it.
double Spikes::density(const Witness& witness, double difference, double noise, double moves) const noexcept {
  const double square = difference * difference;
  const double squares_of_noise = square / (noise * noise);
  const double still = squares_of_noise < kNever ? std::exp(-0.5 * squares_of_noise) / noise : 0.0;
  const double wide = noise * noise + moves * moves;
  const double moved = square < kMovesMost * wide ? moves / (wide + square) : 0.0;
  const double move = kMoves * witness.has_read;
  const double scale = std::sqrt(witness.noise * witness.noise + move * move);
  return (1.0 - changed_) * (still + moved) * scale + changed_ * kOther;
}

/// How often a load is another one than in the last frame.
DERMIS_PROCESSOR_CLONES double Spikes::changed_share(std::span<const double> ratio, double sigma_ratio) const noexcept {
  const double* const readings = ratio.data();
  const double* const last = last_.data();
  const double least = kLoadedSigmas * sigma_ratio;
  double loads = kLoadsBefore;
  double changed = kChangedBefore;
#pragma omp simd reduction(+ : loads, changed)
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const double change = readings[taxel] - last[taxel];
    const double load = last[taxel] > least && change <= kLeastJump ? 1.0 : 0.0;
    loads += load;
    changed += std::abs(change) > kMostChange * last[taxel] ? load : 0.0;
  }
  return changed / loads;
}

DERMIS_PROCESSOR_CLONES bool Spikes::any_jump(std::span<const double> ratio) const noexcept {
  const double* const readings = ratio.data();
  const double* const last = last_.data();
  double most = 0.0;
#pragma omp simd reduction(max : most)
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const double change = readings[taxel] - last[taxel];
    most = change > most ? change : most;
  }
  return most > kLeastJump;
}

/// A neighbour becomes another load in the same frame, as by a press.
bool Spikes::is_touched(std::size_t taxel, std::span<const double> ratio, double sigma_ratio) const noexcept {
  const std::size_t row = taxel / cols_;
  const std::size_t col = taxel % cols_;
  for (std::size_t i = row - std::min<std::size_t>(row, 1); i < std::min(row + 2, rows_); ++i) {
    for (std::size_t j = col - std::min<std::size_t>(col, 1); j < std::min(col + 2, cols_); ++j) {
      const std::size_t near = i * cols_ + j;
      const double rise = ratio[near] - last_[near];
      if (near != taxel && rise > std::max(kSeenSigmas * sigma_ratio, kMostChange * last_[near])) return true;
    }
  }
  return false;
}

void Spikes::add_doubt(std::span<float> doubt_siemens) const noexcept {
  for (const Doubt& doubt : doubts_) doubt_siemens[doubt.taxel] = static_cast<float>(doubt.siemens);
}

void Spikes::remember(const ConditionedFrame& frame, const ConductanceFrame& conductance) noexcept {
  if (load_siemens_.empty()) return;
  doubts_.clear();
  if (!is_next_) forget();
  has_last_ = true;
  last_time_ = frame.time;
  const double noise = kSeenSigmas * frame.sigma_ratio;
  const auto has_reading = [](TaxelStatus taxel) {
    return taxel != TaxelStatus::invalid && taxel != TaxelStatus::line_fault;
  };
  if (!any_taken_ && std::all_of(conductance.taxels.begin(), conductance.taxels.end(), has_reading)) {
    follow(0, last_.size(), frame.ratio, conductance.siemens, noise);
    return;
  }
  any_taken_ = false;
  std::size_t first = 0;  // of those with a reading
  for (std::size_t taxel = 0; taxel <= last_.size(); ++taxel) {
    if (taxel < last_.size() && has_reading(conductance.taxels[taxel])) continue;
    if (taxel > first) follow(first, taxel, frame.ratio, conductance.siemens, noise);
    std::fill(&frames_[0] + first, &frames_[0] + taxel, std::uint8_t{0});
    first = taxel + 1;
    if (taxel == last_.size()) break;
    if (conductance.taxels[taxel] == TaxelStatus::invalid && frames_[taxel] > 0) {
      any_taken_ = true;
    } else {
      last_[taxel] = last_siemens_[taxel] = kUnknown;  // others will have changed since
    }
  }
}

DERMIS_PROCESSOR_CLONES void Spikes::follow(std::size_t first, std::size_t end, std::span<const double> ratio,
                                            std::span<const double> siemens, double noise) noexcept {
  const double* const readings = ratio.data();
  const double* const solved = siemens.data();
  double* const last = last_.data();
  double* const last_siemens = last_siemens_.data();
#pragma omp simd
  for (std::size_t taxel = first; taxel < end; ++taxel) {
    const double change = readings[taxel] - last[taxel];
    const double rise = solved[taxel] - last_siemens[taxel];
    const bool stays = std::abs(change) <= noise;
    last[taxel] = stays ? last[taxel] + kNewShare * change : readings[taxel];
    last_siemens[taxel] = stays ? last_siemens[taxel] + kNewShare * rise : solved[taxel];
  }
}

void Spikes::forget() noexcept {
  if (has_last_ || any_taken_) {
    std::fill(last_.begin(), last_.end(), kUnknown);
    std::fill(last_siemens_.begin(), last_siemens_.end(), kUnknown);
    std::fill(frames_.begin(), frames_.end(), std::uint8_t{0});
  }
  has_last_ = false;
  any_taken_ = false;
  doubts_.clear();
}

}  // namespace dermis::touch::compensation
