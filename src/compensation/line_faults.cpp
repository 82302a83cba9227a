// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/compensation/line_faults.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "compensation/lumped_circuit.hpp"

namespace dermis::compensation {
namespace {

// A false alarm in 1e5 frames of 1e3 lines and taxels would need odds of e^18; what the circuit's description leaves
// out is worth a margin.
constexpr double kEvidence = 30.0;
constexpr int kLineFrames = 3;
constexpr int kTaxelFrames = 12;
constexpr int kHealFrames = 10;

constexpr double kUnloadedShare = 0.5;  // of the unloaded conductance: temperature and age leave at least this
constexpr double kFloorMean = 0.4;      // mean of noise that the ADC cuts off at 0 [standard deviations]
constexpr double kMostMean = 8.0;       // beyond, silence is told by less than half of this many deviations
constexpr double kMostFor = 8.0;        // evidence of one taxel in one frame
constexpr double kMostAgainst = -20.0;
constexpr double kFoundWithinFrames = 10.0;

constexpr double kPressedSigmas = 20.0;  // readings worth comparing
constexpr double kEqualSigmas = 3.0;
constexpr double kDifferentSigmas = 5.0;
constexpr double kEqualShare = 0.01;  // drivers and ADC channels are alike to this
constexpr double kNewPress = 0.2;     // change that makes a press another one
constexpr int kEqualPresses = 10;
constexpr int kSupplyPresses = 6;
constexpr double kPinned = 0.97;  // of the supply
constexpr int kPinnedFramesAmplifier = 20;

constexpr double kSameCount = 1e-3;
constexpr double kLeastOthers = 4.0;  // interior readings that tell how often a reading repeats
constexpr int kStuckHealChanges = 5;

constexpr double kDriftMemory = 0.9998;  // per frame
constexpr double kDriftSigmas = 6.0;
constexpr double kLeastDriftSag = 0.03;    // of the typical loaded line
constexpr double kLeastDriftShare = 0.25;  // of the driver's resistance
constexpr double kPressedShare = 3.0;      // of the unloaded conductance
constexpr std::size_t kContactReach = 3;   // taxels beside a pressed one that may be touched too
constexpr int kDriftFrames = 30;
constexpr double kDoubtOfEstimate = 0.5;  // relative, of a conductance between neighbours
constexpr double kGroundEvidence = 10.0;
constexpr double kMostGround = 3.0;  // evidence of one taxel in one frame

// Why a taxel's reading is not its own.
constexpr std::uint8_t kRowCause = 1;
constexpr std::uint8_t kColumnCause = 2;
constexpr std::uint8_t kStuckCause = 4;
constexpr std::uint8_t kDeadCause = 8;
constexpr std::uint8_t kPairCause = 16;

/// Page's cumulative sum: evidence for a change, back to 0 whenever there is more against it.
struct PageTest {
  double evidence = 0.0;
  int frames = 0;
  std::size_t first_frame = 0;
  Nanos first_time{};

  void restart() { *this = PageTest(); }
  void add(double log_ratio, std::size_t frame, Nanos time) {
    evidence += log_ratio;
    if (evidence <= 0.0) return restart();
    if (frames++ > 0) return;
    first_frame = frame;
    first_time = time;
  }
  [[nodiscard]] bool decides(int least_frames) const { return frames >= least_frames && evidence >= kEvidence; }
};

/// Presses that speak for a short, since the last one that spoke against it.
struct PressCount {
  int presses = 0;
  int against = 0;  // frames in a row
  std::size_t first_frame = 0;
  Nanos first_time{};

  void add(int new_presses, std::size_t frame, Nanos time) {
    if (presses == 0 && new_presses > 0) {
      first_frame = frame;
      first_time = time;
    }
    presses += new_presses;
  }
};

/// Weighted least squares of one unknown with forgetting.
struct DriftFit {
  double normal = 0.0;
  double moment = 0.0;
  double loads = 0.0;  // sum of the squared conductances of the line
  int frames = 0;
  std::size_t first_frame = 0;
  Nanos first_time{};
};

}  // namespace

const char* to_string(LineFaultKind kind) noexcept {
  switch (kind) {
    case LineFaultKind::silent_row: return "silent_row";
    case LineFaultKind::silent_column: return "silent_column";
    case LineFaultKind::supplied_row: return "supplied_row";
    case LineFaultKind::supplied_column: return "supplied_column";
    case LineFaultKind::shorted_rows: return "shorted_rows";
    case LineFaultKind::shorted_columns: return "shorted_columns";
    case LineFaultKind::stuck_taxel: return "stuck_taxel";
    case LineFaultKind::dead_taxel: return "dead_taxel";
    case LineFaultKind::drifting_driver: break;
  }
  return "drifting_driver";
}

std::string place_name(const LineFault& fault, const ArrayDescription& array) {
  const std::string line = std::to_string(fault.place);
  const std::string next = std::to_string(fault.place + 1);
  switch (fault.kind) {
    case LineFaultKind::silent_row:
    case LineFaultKind::supplied_row: return "row " + line;
    case LineFaultKind::silent_column:
    case LineFaultKind::supplied_column: return "column " + line;
    case LineFaultKind::shorted_rows: return "rows " + line + " and " + next;
    case LineFaultKind::shorted_columns: return "columns " + line + " and " + next;
    case LineFaultKind::stuck_taxel:
    case LineFaultKind::dead_taxel: return "taxel " + array.taxel_name(fault.place);
    case LineFaultKind::drifting_driver: break;
  }
  return (array.readout.circuit == Circuit::flexitac ? "driver of column " : "driver of row ") + line;
}

class LineFaultMonitor::Implementation {
 public:
  Implementation(const ArrayDescription& array, std::span<const double> unloaded_siemens);
  bool observe(const ConditionedFrame& conditioned, const ConductanceFrame& conductance) noexcept;
  [[nodiscard]] std::span<const LineFault> faults() const noexcept { return faults_; }
  [[nodiscard]] bool sees(bool row, std::size_t line) const noexcept;

 private:
  struct Inputs {
    const ConditionedFrame& conditioned;
    const ConductanceFrame& conductance;
    std::size_t frame;
    bool solved;
  };

  /// Untouched taxels of a line.
  struct Untouched {
    double siemens = 0.0;
    double expected = 0.0;
    double variance = 0.0;
  };

  [[nodiscard]] std::size_t taxels() const { return array_.taxel_count(); }
  [[nodiscard]] std::size_t lines(bool row) const { return row ? array_.rows : array_.cols; }
  [[nodiscard]] std::size_t across(bool row) const { return row ? array_.cols : array_.rows; }
  [[nodiscard]] std::size_t at(bool row, std::size_t line, std::size_t place) const {
    return row ? array_.index(line, place) : array_.index(place, line);
  }
  [[nodiscard]] bool driven_is_row() const { return array_.readout.circuit != Circuit::flexitac; }

  [[nodiscard]] bool is_found(LineFaultKind kind, std::size_t place) const;
  [[nodiscard]] bool has_kind(LineFaultKind kind) const;
  void found(LineFaultKind kind, std::size_t place, std::size_t frame, Nanos time, double drive_ohm = 0.0);
  void healed(LineFaultKind kind, std::size_t place);
  void mark_faulty_taxels();
  void mark_line(bool row, std::size_t line, std::uint8_t cause);

  void expect_unloaded(const Inputs& in);
  void expect_unloaded_beside_no_press(const Inputs& in);
  void judge_silent_lines(const Inputs& in, bool row);
  void judge_dead_taxels(const Inputs& in);
  void judge_stuck_taxels(const Inputs& in);
  struct Comparison {
    int equal = 0;
    int different = 0;
  };
  Comparison compare_with_next(const Inputs& in, bool row, std::size_t line);
  void judge_shorted_lines(const Inputs& in, bool row);
  void judge_supplied_columns(const Inputs& in);
  void judge_supplied_rows(const Inputs& in);
  void judge_supplied_row(const Inputs& in, std::size_t row, bool is_known, bool is_least);
  [[nodiscard]] bool reads_doubled(const Inputs& in, std::size_t row) const;
  void judge_drivers(const Inputs& in);
  void judge_driver(const Inputs& in, std::size_t line);
  void judge_ground(const Inputs& in, LineFault& fault);
  void find_untouched(const Inputs& in);
  [[nodiscard]] Untouched untouched_on(const Inputs& in, bool row, std::size_t line) const;
  [[nodiscard]] double silence_evidence(double reading, double expected, double sigma) const;
  [[nodiscard]] double counts(const Inputs& in, std::size_t taxel) const;

  ArrayDescription array_;
  std::vector<double> unloaded_siemens_;  // [taxels]
  std::vector<double> unloaded_ratio_;    // readings of the unloaded array [taxels]
  std::vector<double> expected_;          // least reading of an unloaded taxel among today's loads [taxels]
  std::vector<double> line_siemens_;      // [driven lines]
  std::vector<LineFault> faults_;
  bool changed_ = false;
  std::size_t frame_ = 0;
  double last_sigma_ = 0.0;

  std::vector<std::uint8_t> causes_;     // bits of kRowCause ... [taxels]
  std::vector<std::uint8_t> untouched_;  // [taxels]
  double common_share_ = 0.0;

  std::vector<std::uint8_t> is_pressed_[2];  // lines; [0] columns, [1] rows
  std::vector<PageTest> silent_[2];          // [0] columns, [1] rows
  std::vector<PageTest> alive_[2];
  std::vector<PageTest> dead_;
  std::vector<PageTest> undead_;
  std::vector<PageTest> stuck_;
  std::vector<int> changes_;
  std::vector<double> last_counts_;
  std::vector<PressCount> shorted_[2];
  std::vector<double> shorted_last_[2];
  std::vector<PageTest> pinned_;
  std::vector<PageTest> unpinned_;
  std::vector<PressCount> supplied_;
  std::vector<PageTest> doubled_;
  std::vector<double> supplied_last_;
  std::vector<DriftFit> drift_;
};

LineFaultMonitor::Implementation::Implementation(const ArrayDescription& array,
                                                 std::span<const double> unloaded_siemens)
    : array_(array),
      unloaded_siemens_(unloaded_siemens.begin(), unloaded_siemens.end()),
      unloaded_ratio_(taxels()),
      expected_(taxels()),
      line_siemens_(array.driven_lines()),
      causes_(taxels()),
      untouched_(taxels()),
      dead_(taxels()),
      undead_(taxels()),
      stuck_(taxels()),
      changes_(taxels()),
      last_counts_(taxels(), -1.0),
      pinned_(array.cols),
      unpinned_(array.cols),
      supplied_(array.rows),
      doubled_(array.rows),
      supplied_last_(taxels()),
      drift_(array.driven_lines()) {
  assert(unloaded_siemens.size() == taxels());
  for (const bool row : {false, true}) {
    is_pressed_[row].resize(lines(row));
    silent_[row].resize(lines(row));
    alive_[row].resize(lines(row));
    shorted_[row].resize(lines(row));
    shorted_last_[row].resize(taxels());
  }
  faults_.reserve(3 * (array.rows + array.cols) + 2 * taxels());
  for (double& siemens : unloaded_siemens_) siemens = std::max(siemens, 0.0);
  if (array.readout.circuit == Circuit::none) {
    unloaded_ratio_ = unloaded_siemens_;
  } else {
    LumpedCircuit(array).solve(unloaded_siemens_, unloaded_ratio_);
  }
}

bool LineFaultMonitor::Implementation::observe(const ConditionedFrame& conditioned,
                                               const ConductanceFrame& conductance) noexcept {
  changed_ = false;
  const Inputs in{conditioned, conductance, frame_++, !has(conductance.status, FrameStatus::not_converged)};
  if (has(conditioned.status, FrameStatus::rejected)) return false;
  last_sigma_ = conditioned.sigma_ratio;
  expect_unloaded(in);
  judge_silent_lines(in, true);
  judge_silent_lines(in, false);
  judge_supplied_columns(in);
  judge_stuck_taxels(in);
  judge_dead_taxels(in);
  judge_shorted_lines(in, true);
  judge_shorted_lines(in, false);
  judge_supplied_rows(in);
  judge_drivers(in);
  return changed_;
}

bool LineFaultMonitor::Implementation::sees(bool row, std::size_t line) const noexcept {
  double per_frame = 0.0;
  for (std::size_t k = 0; k < across(row); ++k) {
    const double mean = kUnloadedShare * unloaded_ratio_[at(row, line, k)] / last_sigma_;
    per_frame += std::clamp(std::min(mean, kMostMean) * (0.5 * std::min(mean, kMostMean) - kFloorMean), 0.0, kMostFor);
  }
  return last_sigma_ > 0.0 && per_frame >= kEvidence / kFoundWithinFrames;
}

bool LineFaultMonitor::Implementation::is_found(LineFaultKind kind, std::size_t place) const {
  return std::any_of(faults_.begin(), faults_.end(),
                     [&](const LineFault& fault) { return fault.kind == kind && fault.place == place; });
}

bool LineFaultMonitor::Implementation::has_kind(LineFaultKind kind) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const LineFault& fault) { return fault.kind == kind; });
}

void LineFaultMonitor::Implementation::found(LineFaultKind kind, std::size_t place, std::size_t frame, Nanos time,
                                             double drive_ohm) {
  if (faults_.size() == faults_.capacity()) return;
  faults_.push_back({kind, place, frame, time, drive_ohm, 0.0, false});
  mark_faulty_taxels();
  changed_ = true;
}

void LineFaultMonitor::Implementation::healed(LineFaultKind kind, std::size_t place) {
  std::erase_if(faults_, [&](const LineFault& fault) { return fault.kind == kind && fault.place == place; });
  mark_faulty_taxels();
  changed_ = true;
}

void LineFaultMonitor::Implementation::mark_faulty_taxels() {
  std::fill(causes_.begin(), causes_.end(), std::uint8_t{0});
  for (const LineFault& fault : faults_) {
    switch (fault.kind) {
      case LineFaultKind::silent_row:
      case LineFaultKind::supplied_row: mark_line(true, fault.place, kRowCause); break;
      case LineFaultKind::silent_column:
      case LineFaultKind::supplied_column: mark_line(false, fault.place, kColumnCause); break;
      case LineFaultKind::shorted_rows:
        mark_line(true, fault.place, kPairCause);
        mark_line(true, fault.place + 1, kPairCause);
        break;
      case LineFaultKind::shorted_columns:
        mark_line(false, fault.place, kPairCause);
        mark_line(false, fault.place + 1, kPairCause);
        break;
      case LineFaultKind::stuck_taxel: causes_[fault.place] |= kStuckCause; break;
      case LineFaultKind::dead_taxel: causes_[fault.place] |= kDeadCause; break;
      case LineFaultKind::drifting_driver: break;
    }
  }
}

void LineFaultMonitor::Implementation::mark_line(bool row, std::size_t line, std::uint8_t cause) {
  for (std::size_t k = 0; k < across(row); ++k) causes_[at(row, line, k)] |= cause;
}

/// What a taxel reads that nothing presses, while others are pressed: those on its sensed line take the share of the
/// supply that they read themselves, those on its driven line pull the line down.
void LineFaultMonitor::Implementation::expect_unloaded(const Inputs& in) {
  const bool by_row = driven_is_row();
  const Readout& readout = array_.readout;
  if (readout.circuit == Circuit::none) return expect_unloaded_beside_no_press(in);
  std::fill(line_siemens_.begin(), line_siemens_.end(), 0.0);
  for (std::size_t taxel = 0; taxel < taxels() && in.solved; ++taxel) {
    line_siemens_[by_row ? taxel / array_.cols : taxel % array_.cols] += in.conductance.siemens[taxel];
  }
  const bool shares = readout.circuit == Circuit::divider || readout.circuit == Circuit::flexitac;
  for (std::size_t sensed = 0; sensed < array_.sensed_lines(); ++sensed) {
    double taken = 0.0;
    for (std::size_t driven = 0; driven < array_.driven_lines() && shares; ++driven) {
      taken += in.conditioned.ratio[at(by_row, driven, sensed)];
    }
    const double left = std::clamp(1.0 - taken, 0.0, 1.0);
    for (std::size_t driven = 0; driven < array_.driven_lines(); ++driven) {
      const double sag = in.solved ? 1.0 / (1.0 + readout.drive_ohm[driven] * line_siemens_[driven]) : kUnloadedShare;
      const std::size_t taxel = at(by_row, driven, sensed);
      expected_[taxel] = kUnloadedShare * unloaded_ratio_[taxel] * left * sag;
    }
  }
}

/// In an unknown circuit nobody knows what a press takes from the taxels of its lines.
void LineFaultMonitor::Implementation::expect_unloaded_beside_no_press(const Inputs& in) {
  for (const bool row : {false, true}) std::fill(is_pressed_[row].begin(), is_pressed_[row].end(), std::uint8_t{0});
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    const double most = kPressedShare * unloaded_ratio_[taxel] + kDifferentSigmas * in.conditioned.sigma_ratio;
    if (in.conditioned.ratio[taxel] <= most) continue;
    is_pressed_[true][taxel / array_.cols] = 1;
    is_pressed_[false][taxel % array_.cols] = 1;
  }
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    const bool beside = is_pressed_[true][taxel / array_.cols] != 0 || is_pressed_[false][taxel % array_.cols] != 0;
    expected_[taxel] = beside ? 0.0 : kUnloadedShare * unloaded_ratio_[taxel];
  }
}

/// Log-likelihood ratio of a silent taxel against one that reads `expected`, or more: Gaussian noise of `sigma`.
double LineFaultMonitor::Implementation::silence_evidence(double reading, double expected, double sigma) const {
  const double mean = std::min(expected / sigma, kMostMean);
  return std::clamp(mean * (0.5 * mean - reading / sigma), kMostAgainst, kMostFor);
}

void LineFaultMonitor::Implementation::judge_silent_lines(const Inputs& in, bool row) {
  const LineFaultKind kind = row ? LineFaultKind::silent_row : LineFaultKind::silent_column;
  const std::uint8_t own_cause = row ? kRowCause : kColumnCause;
  for (std::size_t line = 0; line < lines(row); ++line) {
    const LineFaultKind at_supply = row ? LineFaultKind::supplied_row : LineFaultKind::supplied_column;
    if (is_found(at_supply, line)) continue;
    double evidence = 0.0;
    for (std::size_t k = 0; k < across(row); ++k) {
      const std::size_t taxel = at(row, line, k);
      if ((causes_[taxel] & ~own_cause & ~kDeadCause) != 0) continue;
      evidence += silence_evidence(in.conditioned.ratio[taxel], expected_[taxel], in.conditioned.sigma_ratio);
    }
    const Nanos time = in.conditioned.time;
    if (!is_found(kind, line)) {
      PageTest& test = silent_[row][line];
      test.add(evidence, in.frame, time);
      if (!test.decides(kLineFrames)) continue;
      found(kind, line, test.first_frame, test.first_time);
      alive_[row][line].restart();
    } else {
      PageTest& test = alive_[row][line];
      test.add(-evidence, in.frame, time);
      if (!test.decides(kHealFrames)) continue;
      healed(kind, line);
      silent_[row][line].restart();
    }
  }
}

void LineFaultMonitor::Implementation::judge_dead_taxels(const Inputs& in) {
  if (!in.solved) return;
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    if ((causes_[taxel] & ~kDeadCause) != 0) {
      dead_[taxel].restart();
      continue;
    }
    const double expected = expected_[taxel] > 0.0 ? kUnloadedShare * unloaded_siemens_[taxel] : 0.0;
    const double siemens = in.conductance.siemens[taxel];
    const double evidence = silence_evidence(siemens, expected, in.conductance.sigma_siemens[taxel]);
    const bool is_known = (causes_[taxel] & kDeadCause) != 0;
    PageTest& test = is_known ? undead_[taxel] : dead_[taxel];
    test.add(is_known ? -evidence : evidence, in.frame, in.conditioned.time);
    if (!is_known && test.decides(kTaxelFrames)) {
      found(LineFaultKind::dead_taxel, taxel, test.first_frame, test.first_time);
      undead_[taxel].restart();
    } else if (is_known && test.decides(kHealFrames)) {
      healed(LineFaultKind::dead_taxel, taxel);
      dead_[taxel].restart();
    }
  }
}

/// The count that the ADC gave.
double LineFaultMonitor::Implementation::counts(const Inputs& in, std::size_t taxel) const {
  const Readout& readout = array_.readout;
  const double rising = in.conditioned.ratio[taxel] / in.conditioned.sigma_ratio * readout.adc_noise_counts;
  const double supply = readout.adc_noise_counts / in.conditioned.sigma_ratio;
  return readout.pressure_raises_reading ? rising : supply - rising;
}

/// Noise moves a reading to another count with a probability that is known, and that the other taxels show: a reading
/// that repeats while it should not is as unlikely as the repetitions multiplied.
void LineFaultMonitor::Implementation::judge_stuck_taxels(const Inputs& in) {
  const Readout& readout = array_.readout;
  const double before_rounding =
      std::sqrt(std::max(readout.adc_noise_counts * readout.adc_noise_counts - 1.0 / 12, 0.0));
  const double repeats_by_noise = before_rounding > 0.0 ? std::erf(0.5 / (before_rounding * std::sqrt(2.0))) : 1.0;
  double interior = 0.0;
  double repeated = 0.0;
  const auto is_interior = [&](double count) { return count > 0.5 && count < readout.full_scale_counts() - 0.5; };
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    const double count = counts(in, taxel);
    if (!is_interior(count)) continue;
    interior += 1.0;
    if (std::abs(count - last_counts_[taxel]) < kSameCount) repeated += 1.0;
  }
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    const double count = counts(in, taxel);
    const bool repeats = std::abs(count - last_counts_[taxel]) < kSameCount;
    last_counts_[taxel] = count;
    const bool is_known = (causes_[taxel] & kStuckCause) != 0;
    if (is_known) {
      if (!repeats && ++changes_[taxel] >= kStuckHealChanges) {
        healed(LineFaultKind::stuck_taxel, taxel);
        stuck_[taxel].restart();
      }
      continue;
    }
    if (!repeats || !is_interior(count)) {
      stuck_[taxel].restart();
      continue;
    }
    if (interior < kLeastOthers + 1.0) continue;
    const double others_repeat = (repeated - 1.0) / (interior - 1.0);
    const double probability = std::max(repeats_by_noise, others_repeat);
    if (probability >= 1.0) continue;
    stuck_[taxel].add(-std::log(probability), in.frame, in.conditioned.time);
    if (!stuck_[taxel].decides(kTaxelFrames)) continue;
    found(LineFaultKind::stuck_taxel, taxel, stuck_[taxel].first_frame, stuck_[taxel].first_time);
    changes_[taxel] = 0;
  }
}

/// Presses on a line and the next one: new ones in which both read the same and the lines beside them do not, and those
/// in which they differ.
LineFaultMonitor::Implementation::Comparison LineFaultMonitor::Implementation::compare_with_next(const Inputs& in,
                                                                                                 bool row,
                                                                                                 std::size_t line) {
  const std::span<const double> ratio = in.conditioned.ratio;
  const double sigma = in.conditioned.sigma_ratio;
  const double pair = ratio_of_shorted_lines(array_, row, line);
  const int spoilt = (row ? kRowCause : kColumnCause) | kStuckCause | kDeadCause;
  Comparison found;
  for (std::size_t k = 0; k < across(row); ++k) {
    const std::size_t first = at(row, line, k);
    const std::size_t second = at(row, line + 1, k);
    if (((causes_[first] | causes_[second]) & spoilt) != 0) continue;
    if (in.conditioned.taxels[first] != TaxelStatus::ok || in.conditioned.taxels[second] != TaxelStatus::ok) continue;
    const double largest = std::max(ratio[first], ratio[second]);
    if (largest < kPressedSigmas * sigma) continue;
    const double deviation = std::hypot(sigma, pair * sigma, kEqualShare * largest);
    const double difference = std::abs(ratio[first] - pair * ratio[second]);
    if (difference > kDifferentSigmas * deviation) ++found.different;
    if (difference > kEqualSigmas * deviation) continue;
    const auto reads_alike = [&](std::size_t other) {
      return std::abs(ratio[other] - ratio[first]) <= kDifferentSigmas * deviation;
    };
    if (line > 0 && reads_alike(at(row, line - 1, k))) continue;
    if (line + 2 < lines(row) && reads_alike(at(row, line + 2, k))) continue;
    double& last = shorted_last_[row][first];
    if (std::abs(ratio[first] - last) < kNewPress * largest) continue;
    last = ratio[first];
    ++found.equal;
  }
  return found;
}

void LineFaultMonitor::Implementation::judge_shorted_lines(const Inputs& in, bool row) {
  // A line at the supply makes the readings of others alike.
  if (has_kind(LineFaultKind::supplied_row) || has_kind(LineFaultKind::supplied_column)) return;
  const LineFaultKind kind = row ? LineFaultKind::shorted_rows : LineFaultKind::shorted_columns;
  for (std::size_t line = 0; line + 1 < lines(row); ++line) {
    const Comparison seen = compare_with_next(in, row, line);
    PressCount& count = shorted_[row][line];
    if (seen.different > 0) {
      ++count.against;
    } else if (seen.equal > 0) {
      count.against = 0;
    }
    const bool is_known = is_found(kind, line);
    if (seen.different > 0 && (!is_known || count.against >= kLineFrames)) {
      if (is_known) healed(kind, line);
      count.presses = 0;
    } else if (!is_known) {
      count.add(seen.equal, in.frame, in.conditioned.time);
      if (count.presses < kEqualPresses) continue;
      found(kind, line, count.first_frame, count.first_time);
      count.against = 0;
    }
  }
}

void LineFaultMonitor::Implementation::judge_supplied_columns(const Inputs& in) {
  std::size_t all_pinned = 0;
  const auto is_pinned = [&](std::size_t col) {
    for (std::size_t row = 0; row < array_.rows; ++row) {
      const std::size_t taxel = array_.index(row, col);
      if ((causes_[taxel] & (kRowCause | kStuckCause)) != 0) continue;
      if (in.conditioned.taxels[taxel] != TaxelStatus::saturated && in.conditioned.ratio[taxel] < kPinned) return false;
    }
    return true;
  };
  for (std::size_t col = 0; col < array_.cols; ++col) all_pinned += is_pinned(col) ? 1 : 0;
  const bool possible = array_.readout.circuit == Circuit::divider && array_.readout.idle_rows == IdleRows::grounded;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    const bool pinned = is_pinned(col);
    const LineFaultKind kind = LineFaultKind::supplied_column;
    const Nanos time = in.conditioned.time;
    if (!is_found(kind, col)) {
      const bool special = pinned && 4 * all_pinned <= array_.cols;
      pinned_[col].add(special ? kEvidence : -kEvidence * 1e3, in.frame, time);
      if (!pinned_[col].decides(possible ? kLineFrames : kPinnedFramesAmplifier)) continue;
      found(kind, col, pinned_[col].first_frame, pinned_[col].first_time);
      unpinned_[col].restart();
    } else {
      unpinned_[col].add(pinned ? -kEvidence * 1e3 : kEvidence, in.frame, time);
      if (!unpinned_[col].decides(kHealFrames)) continue;
      healed(kind, col);
      pinned_[col].restart();
    }
  }
}

/// A row at the supply reads the least in every column, as the others hold its reading too. What speaks for it is a
/// press on it that shows alike in most other rows; or an unloaded array that reads twice what it should, but for this
/// row.
void LineFaultMonitor::Implementation::judge_supplied_rows(const Inputs& in) {
  if (array_.readout.circuit == Circuit::flexitac || array_.rows < 3 || has_kind(LineFaultKind::supplied_column))
    return;
  std::size_t least_row = 0;
  double least_sum = std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < array_.rows; ++row) {
    if (is_found(LineFaultKind::silent_row, row)) continue;
    double sum = 0.0;
    for (std::size_t col = 0; col < array_.cols; ++col) sum += in.conditioned.ratio[array_.index(row, col)];
    if (sum >= least_sum) continue;
    least_row = row;
    least_sum = sum;
  }
  const bool any_known = has_kind(LineFaultKind::supplied_row);
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const bool is_known = is_found(LineFaultKind::supplied_row, row);
    if (is_known || !any_known) judge_supplied_row(in, row, is_known, row == least_row);
  }
}

void LineFaultMonitor::Implementation::judge_supplied_row(const Inputs& in, std::size_t row, bool is_known,
                                                          bool is_least) {
  const std::span<const double> ratio = in.conditioned.ratio;
  const double sigma = in.conditioned.sigma_ratio;
  int shows = 0;
  int fails = 0;
  bool any = false;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    const std::size_t own = array_.index(row, col);
    if ((causes_[own] & ~kRowCause) != 0 || in.conditioned.taxels[own] != TaxelStatus::ok) continue;
    if (ratio[own] < kPressedSigmas * sigma + kPressedShare * unloaded_ratio_[own]) continue;
    const double deviation = std::hypot(sigma, sigma, kEqualShare * ratio[own]);
    std::size_t others = 0;
    std::size_t alike = 0;
    bool least = true;
    for (std::size_t other = 0; other < array_.rows; ++other) {
      const std::size_t taxel = array_.index(other, col);
      if (other == row || (causes_[taxel] & (kRowCause | kStuckCause)) != 0) continue;
      const double more = ratio[taxel] - ratio[own];
      ++others;
      if (more < kPressedShare * unloaded_ratio_[taxel] + kEqualSigmas * deviation) ++alike;
      if (more < -kEqualSigmas * deviation) least = false;
      if (more < -kDifferentSigmas * deviation) ++fails;
    }
    if (!least || 2 * alike < others || others < 2) continue;
    any = true;
    if (std::abs(ratio[own] - supplied_last_[own]) < kNewPress * ratio[own]) continue;
    supplied_last_[own] = ratio[own];
    ++shows;
  }
  PressCount& count = supplied_[row];
  const Nanos time = in.conditioned.time;
  count.against = fails > 0 ? count.against + 1 : (any ? 0 : count.against);
  if (is_known) {
    if (count.against < kLineFrames) return;
    healed(LineFaultKind::supplied_row, row);
    count = PressCount();
    return;
  }
  if (fails > 0) count.presses = 0;
  if (is_least) count.add(shows, in.frame, time);
  doubled_[row].add(is_least && fails == 0 && reads_doubled(in, row) ? kEvidence : kMostAgainst * kEvidence, in.frame,
                    time);
  if (count.presses >= kSupplyPresses) {
    found(LineFaultKind::supplied_row, row, count.first_frame, count.first_time);
  } else if (doubled_[row].decides(kHealFrames)) {
    found(LineFaultKind::supplied_row, row, doubled_[row].first_frame, doubled_[row].first_time);
  } else {
    return;
  }
  count.against = 0;
  doubled_[row].restart();
}

/// The others read their unloaded value and this row's on top; temperature alone cannot do that.
bool LineFaultMonitor::Implementation::reads_doubled(const Inputs& in, std::size_t row) const {
  constexpr double kLeastOthersShare = 1.5;
  constexpr double kMostOthersShare = 2.8;
  double own = 0.0;
  double own_unloaded = 0.0;
  double least_share = kMostOthersShare;
  double most_share = 0.0;
  for (std::size_t other = 0; other < array_.rows; ++other) {
    double sum = 0.0;
    double unloaded = 0.0;
    for (std::size_t col = 0; col < array_.cols; ++col) {
      const std::size_t taxel = array_.index(other, col);
      if (causes_[taxel] != 0) continue;
      sum += in.conditioned.ratio[taxel];
      unloaded += unloaded_ratio_[taxel];
    }
    if (!(unloaded > kPressedSigmas * in.conditioned.sigma_ratio)) continue;
    if (other == row) {
      own = sum;
      own_unloaded = unloaded;
      continue;
    }
    least_share = std::min(least_share, sum / unloaded);
    most_share = std::max(most_share, sum / unloaded);
  }
  const double own_share = own_unloaded > 0.0 ? own / own_unloaded : 0.0;
  return own_share > kUnloadedShare && most_share < kMostOthersShare && least_share > kLeastOthersShare &&
         least_share > kLeastOthersShare * own_share;
}

/// Taxels that nothing touches, for comparison: none nearby reads more than an unloaded one. Their conductance over the
/// unloaded one is common to the array (temperature).
void LineFaultMonitor::Implementation::find_untouched(const Inputs& in) {
  const bool by_row = driven_is_row();
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    untouched_[taxel] = causes_[taxel] == 0 && unloaded_siemens_[taxel] > 0.0 ? 1 : 0;
  }
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    const double most =
        kPressedShare * unloaded_siemens_[taxel] + kDifferentSigmas * in.conductance.sigma_siemens[taxel];
    if (in.conductance.siemens[taxel] <= most) continue;
    const std::size_t line = by_row ? taxel / array_.cols : taxel % array_.cols;
    const std::size_t place = by_row ? taxel % array_.cols : taxel / array_.cols;
    const std::size_t from = place - std::min(place, kContactReach);
    const std::size_t to = std::min(place + kContactReach, array_.sensed_lines() - 1);
    for (std::size_t near = from; near <= to; ++near) {
      untouched_[at(by_row, line, near)] = 0;
      if (line > 0) untouched_[at(by_row, line - 1, near)] = 0;
      if (line + 1 < array_.driven_lines()) untouched_[at(by_row, line + 1, near)] = 0;
    }
  }
  double siemens = 0.0;
  double unloaded = 0.0;
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    if (untouched_[taxel] == 0) continue;
    siemens += in.conductance.siemens[taxel];
    unloaded += unloaded_siemens_[taxel];
  }
  common_share_ = unloaded > 0.0 ? siemens / unloaded : 0.0;
}

LineFaultMonitor::Implementation::Untouched LineFaultMonitor::Implementation::untouched_on(const Inputs& in, bool row,
                                                                                           std::size_t line) const {
  Untouched sums;
  for (std::size_t k = 0; k < across(row); ++k) {
    const std::size_t taxel = at(row, line, k);
    if (untouched_[taxel] == 0) continue;
    sums.siemens += in.conductance.siemens[taxel];
    sums.expected += common_share_ * unloaded_siemens_[taxel];
    sums.variance += in.conductance.sigma_siemens[taxel] * in.conductance.sigma_siemens[taxel];
  }
  return sums;
}

/// Whether a silent line is open or shorted to 0 V: shorted, it takes current from the lines that cross it where it is
/// pressed (as its neighbours are), and untouched taxels on those read less, by the share `taken`.
void LineFaultMonitor::Implementation::judge_ground(const Inputs& in, LineFault& fault) {
  const bool row = fault.kind == LineFaultKind::silent_row;
  const bool is_driven = row == driven_is_row();
  const bool was_grounded = fault.grounded;
  for (std::size_t k = 0; k < across(row); ++k) {
    const std::size_t taxel = at(row, fault.place, k);
    const double pressed = in.conductance.siemens[taxel] - common_share_ * unloaded_siemens_[taxel];
    if (pressed < kPressedShare * unloaded_siemens_[taxel]) continue;
    double taken = 0.0;
    if (!is_driven) {
      const double drive_ohm = array_.readout.drive_ohm[k];
      taken = drive_ohm * pressed / (1.0 + drive_ohm * line_siemens_[k]);
    } else if (array_.readout.circuit != Circuit::transimpedance) {
      double crossing_siemens = 1.0 / array_.readout.load_ohm[k] + pressed;
      for (std::size_t other = 0; other < lines(row); ++other)
        crossing_siemens += in.conductance.siemens[at(row, other, k)];
      taken = pressed / crossing_siemens;
    }
    const Untouched seen = untouched_on(in, !row, k);
    const double difference = taken * seen.expected;
    const double doubt = kDoubtOfEstimate * difference;
    const double variance = seen.variance + doubt * doubt;
    if (!(variance > 0.0)) continue;
    const double missing = seen.expected - seen.siemens + (was_grounded ? difference : 0.0);
    fault.ground_evidence +=
        std::clamp(difference * (missing - 0.5 * difference) / variance, -kMostGround, kMostGround);
  }
  fault.ground_evidence = std::clamp(fault.ground_evidence, -kEvidence, kEvidence);
  fault.grounded = fault.ground_evidence > (was_grounded ? -kGroundEvidence : kGroundEvidence);
  if (fault.grounded != was_grounded) changed_ = true;
}

/// A driver whose resistance is higher by d than the inversion takes it to be makes all conductances of its line come
/// out too small by the factor 1 - d Y, Y the sum of the line as it comes out. Seen on untouched taxels against those
/// of the other lines, while there is no other fault.
void LineFaultMonitor::Implementation::judge_drivers(const Inputs& in) {
  const Readout& readout = array_.readout;
  const bool is_modelled = readout.circuit == Circuit::transimpedance || readout.circuit == Circuit::flexitac ||
                           (readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::grounded);
  if (!in.solved || !is_modelled) return;
  const bool is_faulty = std::any_of(causes_.begin(), causes_.end(), [](std::uint8_t cause) { return cause != 0; });
  find_untouched(in);
  for (LineFault& fault : faults_) {
    if (fault.kind == LineFaultKind::silent_row || fault.kind == LineFaultKind::silent_column) judge_ground(in, fault);
  }
  for (std::size_t line = 0; line < array_.driven_lines() && !is_faulty; ++line) judge_driver(in, line);
}

void LineFaultMonitor::Implementation::judge_driver(const Inputs& in, std::size_t line) {
  const bool by_row = driven_is_row();
  double unloaded = 0.0;
  for (std::size_t k = 0; k < array_.sensed_lines(); ++k) unloaded += unloaded_siemens_[at(by_row, line, k)];
  if (line_siemens_[line] < kPressedShare * unloaded) return;
  const Untouched seen = untouched_on(in, by_row, line);
  if (!(seen.variance > 0.0)) return;
  DriftFit& fit = drift_[line];
  const double slope = seen.expected * line_siemens_[line];
  if (fit.frames == 0) {
    fit.first_frame = in.frame;
    fit.first_time = in.conditioned.time;
  }
  ++fit.frames;
  fit.normal = kDriftMemory * fit.normal + slope * slope / seen.variance;
  fit.moment = kDriftMemory * fit.moment + slope * (seen.expected - seen.siemens) / seen.variance;
  fit.loads = kDriftMemory * fit.loads + slope * slope / seen.variance * line_siemens_[line] * line_siemens_[line];
  if (fit.frames < kDriftFrames || !(fit.normal > 0.0)) return;

  const double rise_ohm = fit.moment / fit.normal;
  const double deviation_ohm = 1.0 / std::sqrt(fit.normal);
  const double typical_siemens = std::sqrt(fit.loads / fit.normal);
  const auto known = std::find_if(faults_.begin(), faults_.end(), [line](const LineFault& fault) {
    return fault.kind == LineFaultKind::drifting_driver && fault.place == line;
  });
  const double nominal_ohm = array_.readout.drive_ohm[line];
  const double now_ohm = known == faults_.end() ? nominal_ohm : known->drive_ohm;
  const double least_ohm = std::max(kLeastDriftShare * now_ohm, kLeastDriftSag / typical_siemens);
  if (std::abs(rise_ohm) < std::max(kDriftSigmas * deviation_ohm, least_ohm)) return;
  const double ohm = now_ohm + rise_ohm;
  if (known == faults_.end()) {
    if (rise_ohm > 0.0) found(LineFaultKind::drifting_driver, line, fit.first_frame, fit.first_time, ohm);
  } else if (ohm < nominal_ohm + std::max(kLeastDriftShare * nominal_ohm, kLeastDriftSag / typical_siemens)) {
    healed(LineFaultKind::drifting_driver, line);
  } else {
    known->drive_ohm = ohm;
    changed_ = true;
  }
  fit = DriftFit();
}

LineFaultMonitor::LineFaultMonitor(const ArrayDescription& array, std::span<const double> unloaded_siemens)
    : implementation_(std::make_unique<Implementation>(array, unloaded_siemens)) {}
LineFaultMonitor::LineFaultMonitor(LineFaultMonitor&&) noexcept = default;
LineFaultMonitor& LineFaultMonitor::operator=(LineFaultMonitor&&) noexcept = default;
LineFaultMonitor::~LineFaultMonitor() = default;

bool LineFaultMonitor::observe(const ConditionedFrame& conditioned, const ConductanceFrame& conductance) noexcept {
  return implementation_->observe(conditioned, conductance);
}

std::span<const LineFault> LineFaultMonitor::faults() const noexcept {
  return implementation_->faults();
}

bool LineFaultMonitor::sees_silent_row(std::size_t row) const noexcept {
  return implementation_->sees(true, row);
}

bool LineFaultMonitor::sees_silent_column(std::size_t col) const noexcept {
  return implementation_->sees(false, col);
}

}  // namespace dermis::compensation
