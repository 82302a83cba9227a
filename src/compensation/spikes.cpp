// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/spikes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/readout_parts.hpp"
#include "compensation/sensed_line.hpp"
#include "dermis/core/processor_clones.hpp"

namespace dermis::compensation {
namespace {

constexpr Nanos kLongestGap = std::chrono::milliseconds(50);
constexpr double kLeastJump = 0.05;  // of the supply
constexpr double kLeastRise = 1.02;  // of the others, by all jumps of a line: below, nothing is seen of it
constexpr double kLeastLeft = 0.01;  // of the supply
constexpr double kMoves = 0.03;      // from frame to frame, of a load that stays
constexpr double kMoving = 0.2;      // how often a load moves
constexpr double kMovesMore = 2.0;   // times that
constexpr double kCircuit = 0.2;     // of the crosstalk's change: the circuit is not known better
constexpr double kOther = 0.01;      // density that a witness changed on its own, and happens to be there
constexpr double kPrior = 0.01;      // of a spike, to a press
constexpr double kSure = 0.99;
constexpr double kDoubtful = 0.5;
constexpr std::size_t kPress = 2;  // jumps beside a jump
constexpr double kSeenSigmas = 6.0;
constexpr double kNewShare = 0.125;  // of a frame in the mean
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint8_t kMostFrames = 3;

/// Of a witness that is what it was, up to its sigma; that moved; to which something else happened.
double log_density(double difference, double sigma, double least_sigma) {
  const double square = difference * difference / (sigma * sigma);
  const double moved = kMoving / (1.0 + square / (kMovesMore * kMovesMore));
  return std::log((std::exp(-0.5 * square) + moved) * least_sigma / sigma + kOther);
}

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
  std::vector<double> sensed_ohm;
  for (std::size_t line = 0; line < array.sensed_lines(); ++line) {
    sensed_ohm.push_back(sensed_line(array.readout, line).rho);
  }
  const bool is_driven = axis_ == driven_axis(array);
  const std::vector<double>& drive_ohm = array.readout.drive_ohm;
  crossing_ohm_ = is_driven ? sensed_ohm : drive_ohm;
  for (const double ohm : is_driven ? drive_ohm : sensed_ohm) load_siemens_.push_back(ohm > 0.0 ? 1.0 / ohm : 0.0);
  share_.resize(array.taxel_count(), 1.0);
  for (std::size_t taxel = 0; taxel < share_.size() && is_driven; ++taxel) {
    share_[taxel] = drive_ohm[taxel / cols_] / array.readout.load_ohm[taxel % cols_];
  }
  witnesses_.resize(places_);
  doubts_.reserve(lines_ * kMostJumps);
}

bool Spikes::take(const ConditionedFrame& frame, bool is_solved, ConductanceFrame& conductance) noexcept {
  doubts_.clear();
  if (load_siemens_.empty()) return false;
  const Nanos since_last = frame.time - last_time_;
  is_next_ = has_last_ && since_last <= kLongestGap && since_last >= Nanos{0};
  if (!is_next_ || !any_jump(frame.ratio)) return false;
  bool any = false;
  for (std::size_t line = 0; line < lines_; ++line) any = take_line(line, frame, is_solved, conductance) || any;
  any_taken_ = any_taken_ || any;
  return any;
}

bool Spikes::take_line(std::size_t line, const ConditionedFrame& frame, bool is_solved,
                       ConductanceFrame& conductance) noexcept {
  const std::optional<Jumps> jumps = jumps_of(line, frame, conductance.taxels);
  if (!jumps) return false;
  find_line(line, frame, conductance, is_solved);
  const std::array<double, kMostJumps> probable = probabilities(line, *jumps);
  bool any = false;
  for (std::size_t k = 0; k < jumps->count; ++k) {
    const std::size_t taxel = taxel_of(line, jumps->places[k]);
    if (probable[k] > kSure && !is_among_jumps(taxel, frame.ratio)) {
      conductance.taxels[taxel] = TaxelStatus::invalid;
      ++frames_[taxel];
      any = true;
    } else if (probable[k] > kDoubtful && is_solved) {
      const double jump = conductance.siemens[taxel] - last_siemens_[taxel];
      doubts_.push_back({taxel, std::sqrt(probable[k]) * std::abs(jump)});
    }
  }
  return any;
}

/// Those that may be spikes. None: nothing jumps, many do, or one that has long not been believed.
std::optional<Spikes::Jumps> Spikes::jumps_of(std::size_t line, const ConditionedFrame& frame,
                                              std::span<const TaxelStatus> taxels) const noexcept {
  if (load_siemens_[line] == 0.0) return std::nullopt;
  Jumps jumps;
  for (std::size_t place = 0; place < places_; ++place) {
    const std::size_t taxel = taxel_of(line, place);
    if (taxels[taxel] == TaxelStatus::invalid || !is_jump(taxel, frame.ratio)) continue;
    if (jumps.count == kMostJumps) return std::nullopt;
    if (frames_[taxel] < kMostFrames) jumps.places[jumps.count++] = place;
  }
  return jumps.count > 0 ? std::optional(jumps) : std::nullopt;
}

/// Where there is no solution, the conductances are those of a circuit that has no other crosstalk.
void Spikes::find_line(std::size_t line, const ConditionedFrame& frame, const ConductanceFrame& conductance,
                       bool is_solved) noexcept {
  const double load = load_siemens_[line];
  double now = load;
  double before = load;
  double share = 0.0;
  double last_share = 0.0;
  for (std::size_t place = 0; place < places_; ++place) {
    const std::size_t taxel = taxel_of(line, place);
    if (conductance.taxels[taxel] == TaxelStatus::invalid || std::isnan(last_[taxel])) continue;
    now += behind(taxel, conductance.siemens[taxel]);
    before += behind(taxel, last_siemens_[taxel]);
    share += share_[taxel] * frame.ratio[taxel];
    last_share += share_[taxel] * last_[taxel];
  }
  if (!is_solved) {
    now = load / std::max(1.0 - share, kLeastLeft);
    before = load / std::max(1.0 - last_share, kLeastLeft);
  }
  for (std::size_t place = 0; place < places_; ++place) {
    const std::size_t taxel = taxel_of(line, place);
    Witness& witness = witnesses_[place];
    witness.is_known = conductance.taxels[taxel] != TaxelStatus::invalid && !std::isnan(last_[taxel]);
    witness.tells = witness.is_known && !is_jump(taxel, frame.ratio);
    const double with_crosstalk = share_[taxel] * frame.ratio[taxel] * now;
    const double last_with_crosstalk = share_[taxel] * last_[taxel] * before;
    witness.now = is_solved ? behind(taxel, conductance.siemens[taxel]) : with_crosstalk;
    witness.before = is_solved ? behind(taxel, last_siemens_[taxel]) : last_with_crosstalk;
    witness.reads = with_crosstalk;
    witness.has_read = share_[taxel] * last_[taxel] * now;
    const double crosstalk = (with_crosstalk - witness.now) - (last_with_crosstalk - witness.before);
    const double noise = share_[taxel] * frame.sigma_ratio * now;
    witness.sigma_of_press = std::hypot(noise, kMoves * witness.before, kCircuit * crosstalk);
    witness.sigma_of_spike = std::hypot(noise, kMoves * witness.has_read);
  }
}

/// That each of the jumps is a spike.
std::array<double, Spikes::kMostJumps> Spikes::probabilities(std::size_t line, const Jumps& jumps) const noexcept {
  const std::size_t sets = std::size_t{1} << jumps.count;
  const auto rise = [&](std::size_t set) {
    double now = load_siemens_[line];
    double before = now;
    for (std::size_t k = 0; k < jumps.count; ++k) {
      now += (set >> k & 1U) != 0 ? witnesses_[jumps.places[k]].now : 0.0;
      before += (set >> k & 1U) != 0 ? witnesses_[jumps.places[k]].before : 0.0;
    }
    return now / before;
  };
  std::array<double, kMostJumps> probable{};
  const double of_all = rise(sets - 1);
  const double if_none = log_likelihood_of_presses();
  double sum = 1.0;
  for (std::size_t set = 1; set < sets; ++set) {
    const double of_set = rise(set);
    if (of_set < kLeastRise) continue;
    double weight = std::exp(log_likelihood_of_spikes(of_set / of_all) - if_none);
    for (std::size_t k = 0; k < jumps.count; ++k) weight *= (set >> k & 1U) != 0 ? kPrior : 1.0;
    sum += weight;
    for (std::size_t k = 0; k < jumps.count; ++k) probable[k] += (set >> k & 1U) != 0 ? weight : 0.0;
  }
  for (double& share : probable) share /= sum;
  return probable;
}

double Spikes::log_likelihood_of_presses() const noexcept {
  double sum = 0.0;
  for (const Witness& witness : witnesses_) {
    if (witness.tells) sum += log_density(witness.now - witness.before, witness.sigma_of_press, witness.sigma_of_spike);
  }
  return sum;
}

double Spikes::log_likelihood_of_spikes(double left) const noexcept {
  double sum = 0.0;
  for (const Witness& witness : witnesses_) {
    if (!witness.tells) continue;
    sum += log_density(witness.reads - left * witness.has_read, witness.sigma_of_spike, witness.sigma_of_spike);
  }
  return sum;
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

bool Spikes::is_jump(std::size_t taxel, std::span<const double> ratio) const noexcept {
  return ratio[taxel] - last_[taxel] > kLeastJump;
}

/// Neighbours that jump together are a press.
bool Spikes::is_among_jumps(std::size_t taxel, std::span<const double> ratio) const noexcept {
  const std::size_t row = taxel / cols_;
  const std::size_t col = taxel % cols_;
  std::size_t jumps = 0;
  for (std::size_t i = row - std::min<std::size_t>(row, 1); i < std::min(row + 2, rows_); ++i) {
    for (std::size_t j = col - std::min<std::size_t>(col, 1); j < std::min(col + 2, cols_); ++j) {
      jumps += is_jump(i * cols_ + j, ratio) ? 1 : 0;
    }
  }
  return jumps > kPress;
}

void Spikes::add_doubt(std::span<float> doubt_siemens) const noexcept {
  for (const Doubt& doubt : doubts_) doubt_siemens[doubt.taxel] = static_cast<float>(doubt.siemens);
}

void Spikes::remember(const ConditionedFrame& frame, const ConductanceFrame& conductance) noexcept {
  if (load_siemens_.empty()) return;
  if (!is_next_) forget();
  has_last_ = true;
  last_time_ = frame.time;
  const double noise = kSeenSigmas * frame.sigma_ratio;
  const auto has_reading = [](TaxelStatus taxel) {
    return taxel != TaxelStatus::invalid && taxel != TaxelStatus::line_fault;
  };
  if (!any_taken_ && std::all_of(conductance.taxels.begin(), conductance.taxels.end(), has_reading)) {
    follow_all(frame.ratio, conductance.siemens, noise);
    return;
  }
  any_taken_ = false;
  for (std::size_t taxel = 0; taxel < last_.size(); ++taxel) {
    if (has_reading(conductance.taxels[taxel])) {
      follow(taxel, frame.ratio[taxel], conductance.siemens[taxel], noise);
      frames_[taxel] = 0;
    } else if (conductance.taxels[taxel] == TaxelStatus::invalid && frames_[taxel] > 0) {
      any_taken_ = true;
    } else {
      last_[taxel] = last_siemens_[taxel] = kUnknown;  // others will have changed since
    }
  }
}

/// The mean as long as a reading changes by no more than noise.
inline void Spikes::follow(std::size_t taxel, double ratio, double siemens, double noise) noexcept {
  const bool stays = std::abs(ratio - last_[taxel]) <= noise;
  last_[taxel] = stays ? last_[taxel] + kNewShare * (ratio - last_[taxel]) : ratio;
  last_siemens_[taxel] = stays ? last_siemens_[taxel] + kNewShare * (siemens - last_siemens_[taxel]) : siemens;
}

DERMIS_PROCESSOR_CLONES void Spikes::follow_all(std::span<const double> ratio, std::span<const double> siemens,
                                                double noise) noexcept {
  const double* const readings = ratio.data();
  const double* const solved = siemens.data();
  double* const last = last_.data();
  double* const last_siemens = last_siemens_.data();
#pragma omp simd
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const double change = readings[taxel] - last[taxel];
    const bool stays = std::abs(change) <= noise;
    const double rise = solved[taxel] - last_siemens[taxel];
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

}  // namespace dermis::compensation
