// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/compensation/line_faults.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "compensation/lumped_circuit.hpp"

namespace dermis::compensation {
namespace {

// A false alarm in 1e5 frames of 1e3 lines and taxels would need odds of e^18; what the circuit's description leaves
// out is worth a margin.
constexpr double kEvidence = 30.0;
constexpr int kLineFrames = 3;
constexpr int kTaxelFrames = 12;
constexpr int kHealFrames = 10;

constexpr double kUnloadedShare = 0.3;  // of the unloaded conductance: temperature, memory and age leave at least this
constexpr float kMostMean = 8.0F;       // beyond, silence is told by less than half of this many deviations
constexpr float kMostFor = 8.0F;        // evidence of one taxel in one frame
constexpr float kMostAgainst = -20.0F;
constexpr float kMostForTaxel = static_cast<float>(kEvidence / kTaxelFrames);
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

constexpr std::size_t kBlockTaxels = 64;
constexpr double kSameCount = 1e-3;
constexpr double kLeastOthers = 4.0;  // interior readings that tell how often a reading repeats
constexpr int kStuckHealChanges = 5;

constexpr double kDriftSigmas = 5.0;       // when the current rises and when it falls
constexpr double kMostOutlier = 3.0;       // standard deviations
constexpr double kLeastDriftSag = 0.03;    // of the typical loaded line
constexpr double kLeastDriftShare = 0.25;  // of the driver's resistance
constexpr double kPressedShare = 3.0;      // of the unloaded conductance
constexpr std::size_t kContactReach = 3;   // taxels beside a pressed one that may be touched too
constexpr double kDriftPairs = 20.0;
constexpr std::size_t kDriftLinesPerFrame = 3;  // no divisor of usual numbers of lines: recurring loads meet all
constexpr double kDriftMemory = 0.998;          // per pair of frames
constexpr double kDoubtOfUnloaded = 0.1;        // relative, from one frame to the next: temperature, memory
constexpr double kDoubtOfEstimate = 0.5;        // relative, of a conductance between neighbours
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

/// Weighted least squares of one unknown, with forgetting.
struct DriftFit {
  double normal = 0.0;
  double moment = 0.0;
  double square = 0.0;
  double loads = 0.0;  // sum of the squared changes of the conductance of the line
  double pairs = 0.0;

  void add(double slope, double value, double variance, double load) {
    normal = kDriftMemory * normal + slope * slope / variance;
    moment = kDriftMemory * moment + slope * value / variance;
    square = kDriftMemory * square + value * value / variance;
    loads = kDriftMemory * loads + slope * slope / variance * load * load;
    pairs = kDriftMemory * pairs + 1.0;
  }
  [[nodiscard]] double estimate() const { return moment / normal; }
  /// From the scatter of what was fitted, which memory of the material makes wider than noise alone.
  [[nodiscard]] double deviation() const {
    const double scatter = (square - moment * moment / normal) / pairs;
    return std::sqrt(std::max(scatter, 1.0) / normal);
  }
  [[nodiscard]] double typical_load() const { return std::sqrt(loads / normal); }
};

/// Evidence of a reading at the floor of the ADC.
struct FloorEvidence {
  float sigmas = 0.0F;     // readings below half a count are the floor
  float slope = 0.0F;      // log P(floor | silent) / P(floor | mean), to second order in the mean:
  float curvature = 0.0F;  // the least that it can be
};

/// Log-likelihood ratio of a silent taxel against one that reads `expected`, or more [standard deviations].
inline float silence_evidence(float reading, float expected, float floor_end, const FloorEvidence& floor, float most) {
  const float mean = expected < kMostMean ? expected : kMostMean;
  const float above = mean * (0.5F * mean - reading);
  const float at_floor = mean * (floor.slope + floor.curvature * mean);
  const float ratio = reading < floor_end ? at_floor : above;
  const float limited = ratio < most ? ratio : most;
  return limited > kMostAgainst ? limited : kMostAgainst;
}

/// Sum in four parts, which do not wait for each other.
double sum_of(std::span<const double> values) {
  double parts[4] = {};
  std::size_t k = 0;
  for (; k + 4 <= values.size(); k += 4) {
    for (std::size_t part = 0; part < 4; ++part) parts[part] += values[k + part];
  }
  for (; k < values.size(); ++k) parts[0] += values[k];
  return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

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

  /// How often a reading repeats by chance.
  struct Repetition {
    double interior = 0.0;
    double repeated = 0.0;
  };

  /// Single taxels are judged a block a frame, by turns.
  struct Block {
    std::size_t from;
    std::size_t to;
  };
  [[nodiscard]] std::size_t blocks() const { return (taxels() + kBlockTaxels - 1) / kBlockTaxels; }
  [[nodiscard]] Block block(const Inputs& in) const {
    const std::size_t from = in.frame % blocks() * kBlockTaxels;
    return {from, std::min(from + kBlockTaxels, taxels())};
  }

  struct CountScale {
    double zero;
    double per_ratio;
  };
  [[nodiscard]] CountScale count_scale(const Inputs& in) const;

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

  void sum_lines(const Inputs& in);
  void expect_unloaded(const Inputs& in);
  void expect_unloaded_beside_no_press(const Inputs& in);
  void weigh_silence(const Inputs& in);
  void sum_evidence();
  void judge_silent_lines(const Inputs& in, bool row);
  void judge_dead_taxels(const Inputs& in);
  void judge_dead_taxel(const Inputs& in, std::size_t taxel);
  void judge_stuck_taxels(const Inputs& in);
  struct Comparison {
    int equal = 0;
    int different = 0;
  };
  Comparison compare_with_next(const Inputs& in, bool row, std::size_t line);
  void judge_shorted_lines(const Inputs& in, bool row);
  void judge_shorted_pair(const Inputs& in, bool row, std::size_t line);
  void judge_supplied_columns(const Inputs& in);
  void judge_supplied_rows(const Inputs& in);
  void judge_supplied_row(const Inputs& in, std::size_t row, bool is_known);
  void judge_drivers(const Inputs& in);
  void compare_with_last(const Inputs& in, std::size_t line);
  void judge_driver(std::size_t line);
  void remember(const Inputs& in);
  [[nodiscard]] bool is_touched(const Inputs& in, std::size_t taxel) const;
  void find_touched(const Inputs& in, std::size_t line);
  void judge_ground(const Inputs& in, LineFault& fault);
  void find_untouched(const Inputs& in);
  [[nodiscard]] Untouched untouched_on(const Inputs& in, bool row, std::size_t line) const;

  ArrayDescription array_;
  std::vector<double> unloaded_siemens_;  // [taxels]
  std::vector<double> unloaded_ratio_;    // readings of the unloaded array [taxels]
  std::vector<float> expected_;           // least reading of an unloaded taxel among today's loads [sigma; taxels]
  std::vector<float> evidence_;           // that the taxel is silent: log-likelihood ratio of this frame [taxels]
  std::vector<float> line_evidence_[2];   // sums of it; [0] columns, [1] rows
  std::vector<double> line_siemens_;      // [driven lines]
  std::vector<double> ratio_sum_[2];      // [0] columns, [1] rows
  std::vector<double> left_;              // share of the supply that is left on a sensed line
  FloorEvidence floor_;
  double information_ = 0.0;  // mean evidence of a silent taxel over the squared expected reading
  std::vector<LineFault> faults_;
  bool changed_ = false;
  std::size_t frame_ = 0;
  double last_sigma_ = 0.0;

  std::vector<std::uint8_t> causes_;     // bits of kRowCause ... [taxels]
  std::vector<float> judges_[2];         // 1 where the taxel is evidence on its column, its row; else 0 [taxels]
  std::vector<std::uint8_t> untouched_;  // [taxels]
  double common_share_ = 0.0;

  std::vector<std::uint8_t> is_pressed_[2];  // lines; [0] columns, [1] rows
  std::vector<PageTest> silent_[2];          // [0] columns, [1] rows
  std::vector<PageTest> alive_[2];
  std::vector<float> dead_evidence_;      // of this frame [taxels]
  std::vector<float> dead_;               // Page's sum [taxels]
  std::vector<std::int32_t> dead_since_;  // frame before its evidence [taxels]
  std::vector<PageTest> undead_;
  std::vector<double> stuck_;         // Page's sum [taxels]
  std::vector<double> stuck_frames_;  // [taxels]
  std::vector<int> changes_;
  std::vector<double> last_counts_;
  double repeats_by_noise_ = 1.0;
  double chance_ = 0.0;  // minus logarithm of the probability that a reading repeats
  std::vector<PressCount> shorted_[2];
  std::vector<double> shorted_last_[2];
  std::size_t turn_[2] = {};
  std::vector<PageTest> pinned_;
  std::vector<PageTest> unpinned_;
  PressCount supplied_;
  std::size_t supplied_candidate_ = 0;
  std::vector<double> supplied_last_;
  std::vector<DriftFit> drift_[2];  // where the current of the line has [0] fallen, [1] risen
  std::vector<std::pair<std::size_t, Nanos>> drift_since_;
  std::vector<double> last_siemens_;       // [taxels]
  std::vector<std::uint8_t> touched_;      // [sensed lines]
  std::vector<double> last_line_siemens_;  // [driven lines]
  bool has_last_ = false;
};

LineFaultMonitor::Implementation::Implementation(const ArrayDescription& array,
                                                 std::span<const double> unloaded_siemens)
    : array_(array),
      unloaded_siemens_(unloaded_siemens.begin(), unloaded_siemens.end()),
      unloaded_ratio_(taxels()),
      expected_(taxels()),
      evidence_(taxels()),
      line_siemens_(array.driven_lines()),
      left_(array.sensed_lines()),
      causes_(taxels()),
      untouched_(taxels()),
      dead_evidence_(taxels()),
      dead_(taxels()),
      dead_since_(taxels()),
      undead_(taxels()),
      stuck_(taxels()),
      stuck_frames_(taxels()),
      changes_(taxels()),
      last_counts_(taxels(), -1.0),
      pinned_(array.cols),
      unpinned_(array.cols),
      supplied_last_(taxels()),
      drift_since_(array.driven_lines()),
      last_siemens_(taxels()),
      touched_(array.sensed_lines()),
      last_line_siemens_(array.driven_lines()) {
  assert(unloaded_siemens.size() == taxels());
  for (const bool row : {false, true}) {
    is_pressed_[row].resize(lines(row));
    ratio_sum_[row].resize(lines(row));
    line_evidence_[row].resize(lines(row));
    judges_[row].assign(taxels(), 1.0F);
    drift_[row].resize(array.driven_lines());
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
  const double before_rounding =
      std::sqrt(std::max(array.readout.adc_noise_counts * array.readout.adc_noise_counts - 1.0 / 12, 0.0));
  if (before_rounding > 0.0) repeats_by_noise_ = std::erf(0.5 / (before_rounding * std::numbers::sqrt2));
  const double floor = 0.5 / array.readout.adc_noise_counts;
  const double density = std::exp(-0.5 * floor * floor) / std::sqrt(2.0 * std::numbers::pi);
  const double below = 0.5 * std::erfc(-floor / std::numbers::sqrt2);
  const double slope = density / below;
  floor_ = {static_cast<float>(floor), static_cast<float>(slope), static_cast<float>(0.5 * slope * (slope + floor))};
  information_ = 0.5 * (density * (slope + floor) + 1.0 - below);
}

bool LineFaultMonitor::Implementation::observe(const ConditionedFrame& conditioned,
                                               const ConductanceFrame& conductance) noexcept {
  changed_ = false;
  const Inputs in{conditioned, conductance, frame_++, !has(conductance.status, FrameStatus::not_converged)};
  if (has(conditioned.status, FrameStatus::rejected)) return false;
  last_sigma_ = conditioned.sigma_ratio;
  sum_lines(in);
  expect_unloaded(in);
  weigh_silence(in);
  sum_evidence();
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
    per_frame += std::min(information_ * mean * mean, static_cast<double>(kMostFor));
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
  for (std::size_t taxel = 0; taxel < taxels(); ++taxel) {
    judges_[true][taxel] = (causes_[taxel] & ~(kRowCause | kDeadCause)) == 0 ? 1.0F : 0.0F;
    judges_[false][taxel] = (causes_[taxel] & ~(kColumnCause | kDeadCause)) == 0 ? 1.0F : 0.0F;
  }
}

void LineFaultMonitor::Implementation::mark_line(bool row, std::size_t line, std::uint8_t cause) {
  for (std::size_t k = 0; k < across(row); ++k) causes_[at(row, line, k)] |= cause;
}

void LineFaultMonitor::Implementation::sum_lines(const Inputs& in) {
  const std::size_t cols = array_.cols;
  std::vector<double>& columns = ratio_sum_[false];
  std::fill(columns.begin(), columns.end(), 0.0);
  const std::span<const double> ratio = in.conditioned.ratio;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const std::span<const double> readings = ratio.subspan(row * cols, cols);
    ratio_sum_[true][row] = sum_of(readings);
    for (std::size_t col = 0; col < cols; ++col) columns[col] += readings[col];
  }
  std::fill(line_siemens_.begin(), line_siemens_.end(), 0.0);
  if (!in.solved) return;
  const std::span<const double> siemens = in.conductance.siemens;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const std::span<const double> conductances = siemens.subspan(row * cols, cols);
    if (driven_is_row()) {
      line_siemens_[row] = sum_of(conductances);
    } else {
      for (std::size_t col = 0; col < cols; ++col) line_siemens_[col] += conductances[col];
    }
  }
}

/// What a taxel reads that nothing presses, while others are pressed: those on its sensed line take the share of the
/// supply that they read themselves, those on its driven line pull the line down.
void LineFaultMonitor::Implementation::expect_unloaded(const Inputs& in) {
  const Readout& readout = array_.readout;
  if (readout.circuit == Circuit::none) return expect_unloaded_beside_no_press(in);
  const bool by_row = driven_is_row();
  const bool shares = readout.circuit == Circuit::divider || readout.circuit == Circuit::flexitac;
  const std::vector<double>& taken = ratio_sum_[!by_row];
  for (std::size_t sensed = 0; sensed < array_.sensed_lines(); ++sensed) {
    left_[sensed] = shares ? std::clamp(1.0 - taken[sensed], 0.0, 1.0) : 1.0;
  }
  const double scale = kUnloadedShare / in.conditioned.sigma_ratio;
  const auto sag = [&](std::size_t driven) {
    return in.solved ? 1.0 / (1.0 + readout.drive_ohm[driven] * line_siemens_[driven]) : kUnloadedShare;
  };
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const double* const unloaded = &unloaded_ratio_[row * array_.cols];
    float* const expected = &expected_[row * array_.cols];
    if (by_row) {
      const double factor = scale * sag(row);
      for (std::size_t col = 0; col < array_.cols; ++col) {
        expected[col] = static_cast<float>(factor * unloaded[col] * left_[col]);
      }
    } else {
      const double factor = scale * left_[row];
      for (std::size_t col = 0; col < array_.cols; ++col) {
        expected[col] = static_cast<float>(factor * unloaded[col] * sag(col));
      }
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
    const double expected = beside ? 0.0 : kUnloadedShare * unloaded_ratio_[taxel];
    expected_[taxel] = static_cast<float>(expected / in.conditioned.sigma_ratio);
  }
}

/// Log-likelihood ratio of a silent taxel against one that reads as expected, or more: Gaussian noise, cut off at the
/// floor of the ADC. log P(floor | silent) / P(floor | mean) is not less than its second-order series.
void LineFaultMonitor::Implementation::weigh_silence(const Inputs& in) {
  const std::size_t taxels = evidence_.size();
  const double per_sigma = 1.0 / in.conditioned.sigma_ratio;
  const FloorEvidence floor = floor_;
  const double* const ratios = in.conditioned.ratio.data();
  const float* const expected = expected_.data();
  float* const evidence = evidence_.data();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto reading = static_cast<float>(ratios[taxel] * per_sigma);
    evidence[taxel] = silence_evidence(reading, expected[taxel], floor.sigmas, floor, kMostFor);
  }
}

void LineFaultMonitor::Implementation::sum_evidence() {
  const std::size_t cols = array_.cols;
  float* const columns = line_evidence_[false].data();
  std::fill_n(columns, cols, 0.0F);
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const float* const evidence = &evidence_[row * cols];
    const float* const judges_column = &judges_[false][row * cols];
    const float* const judges_row = &judges_[true][row * cols];
    for (std::size_t col = 0; col < cols; ++col) columns[col] += judges_column[col] * evidence[col];
    float parts[4] = {};
    for (std::size_t col = 0; col < cols; ++col) parts[col % 4] += judges_row[col] * evidence[col];
    line_evidence_[true][row] = (parts[0] + parts[1]) + (parts[2] + parts[3]);
  }
}

void LineFaultMonitor::Implementation::judge_silent_lines(const Inputs& in, bool row) {
  const LineFaultKind kind = row ? LineFaultKind::silent_row : LineFaultKind::silent_column;
  for (std::size_t line = 0; line < lines(row); ++line) {
    const LineFaultKind at_supply = row ? LineFaultKind::supplied_row : LineFaultKind::supplied_column;
    if (is_found(at_supply, line)) continue;
    const float evidence = line_evidence_[row][line];
    const Nanos time = in.conditioned.time;
    if (!is_found(kind, line)) {
      PageTest& test = silent_[row][line];
      test.add(static_cast<double>(evidence), in.frame, time);
      if (!test.decides(kLineFrames)) continue;
      found(kind, line, test.first_frame, test.first_time);
      alive_[row][line].restart();
    } else {
      PageTest& test = alive_[row][line];
      test.add(static_cast<double>(-evidence), in.frame, time);
      if (!test.decides(kHealFrames)) continue;
      healed(kind, line);
      silent_[row][line].restart();
    }
  }
}

/// As weigh_silence(), of conductances: what crosses over from pressed taxels is solved there.
void LineFaultMonitor::Implementation::judge_dead_taxels(const Inputs& in) {
  if (!in.solved) return;
  const auto [from, to] = block(in);
  const FloorEvidence floor = floor_;
  const double* const siemens = in.conductance.siemens.data();
  const double* const sigma = in.conductance.sigma_siemens.data();
  const double* const unloaded = unloaded_siemens_.data();
  const float* const expected = expected_.data();
  float* const evidence = dead_evidence_.data();
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    const auto per_sigma = 1.0F / static_cast<float>(sigma[taxel]);
    const float conductance = static_cast<float>(siemens[taxel]) * per_sigma;
    const float least = static_cast<float>(kUnloadedShare * unloaded[taxel]) * per_sigma;
    const float mean = expected[taxel] > 0.0F ? least : 0.0F;
    evidence[taxel] = silence_evidence(conductance, mean, std::numeric_limits<float>::min(), floor, kMostForTaxel);
  }
  const auto frame = static_cast<std::int32_t>(in.frame);
  float* const dead = dead_.data();
  std::int32_t* const since = dead_since_.data();
  float most = 0.0F;
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    const float sum = dead[taxel] + evidence[taxel];
    const std::int32_t began = since[taxel];
    since[taxel] = sum > 0.0F ? began : frame + 1;
    dead[taxel] = sum > 0.0F ? sum : 0.0F;
  }
  for (std::size_t taxel = from; taxel < to; ++taxel) most = dead[taxel] > most ? dead[taxel] : most;
  if (most < static_cast<float>(kEvidence) && !has_kind(LineFaultKind::dead_taxel)) return;
  for (std::size_t taxel = from; taxel < to; ++taxel) judge_dead_taxel(in, taxel);
}

void LineFaultMonitor::Implementation::judge_dead_taxel(const Inputs& in, std::size_t taxel) {
  if ((causes_[taxel] & ~kDeadCause) != 0) {
    dead_[taxel] = 0.0F;
    dead_since_[taxel] = static_cast<std::int32_t>(in.frame) + 1;
  } else if ((causes_[taxel] & kDeadCause) != 0) {
    undead_[taxel].add(static_cast<double>(-dead_evidence_[taxel]), in.frame, in.conditioned.time);
    if (!undead_[taxel].decides(kHealFrames)) return;
    healed(LineFaultKind::dead_taxel, taxel);
    dead_[taxel] = 0.0F;
  } else if (dead_[taxel] >= static_cast<float>(kEvidence)) {
    found(LineFaultKind::dead_taxel, taxel, static_cast<std::size_t>(dead_since_[taxel]), in.conditioned.time);
    undead_[taxel].restart();
  }
}

/// Noise moves a reading to another count with a probability that is known, and that taxels which nothing presses show:
/// a reading that repeats while it should not is as unlikely as the repetitions multiplied. Readings like those of
/// unloaded taxels are not judged: they are weak, and may be quiet.
void LineFaultMonitor::Implementation::judge_stuck_taxels(const Inputs& in) {
  const Readout& readout = array_.readout;
  const auto [from, to] = block(in);
  const CountScale scale = count_scale(in);
  for (std::size_t k = faults_.size(); k-- > 0;) {  // healed() removes the fault
    const LineFault& fault = faults_[k];
    if (fault.kind != LineFaultKind::stuck_taxel) continue;
    const std::size_t taxel = fault.place;
    if (taxel < from || taxel >= to) continue;
    const double last = last_counts_[taxel];
    const double change = scale.zero + scale.per_ratio * in.conditioned.ratio[taxel] - last;
    if (std::abs(change) < kSameCount || ++changes_[taxel] < kStuckHealChanges) continue;
    healed(LineFaultKind::stuck_taxel, taxel);
    stuck_[taxel] = 0.0;
  }
  const double most = readout.full_scale_counts() - 0.5;
  const double least_pressed = kPressedSigmas * in.conditioned.sigma_ratio;
  Repetition idle;
  double most_evidence = 0.0;
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    const double ratio = in.conditioned.ratio[taxel];
    const double count = scale.zero + scale.per_ratio * ratio;
    const double interior = (count > 0.5 ? 1.0 : 0.0) * (count < most ? 1.0 : 0.0);
    const double repeated = std::abs(count - last_counts_[taxel]) < kSameCount ? interior : 0.0;
    const double pressed = ratio > kPressedShare * unloaded_ratio_[taxel] + least_pressed ? 1.0 : 0.0;
    last_counts_[taxel] = count;
    idle.interior += interior * (1.0 - pressed);
    idle.repeated += repeated * (1.0 - pressed);
    stuck_[taxel] = repeated * pressed * (stuck_[taxel] + chance_);
    stuck_frames_[taxel] = repeated * pressed * (stuck_frames_[taxel] + 1.0);
    most_evidence = stuck_[taxel] > most_evidence ? stuck_[taxel] : most_evidence;
  }
  chance_ = idle.interior < kLeastOthers ? 0.0 : -std::log(std::max(repeats_by_noise_, idle.repeated / idle.interior));
  chance_ = std::min(chance_, static_cast<double>(kMostForTaxel));
  if (most_evidence < kEvidence) return;
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    if (stuck_[taxel] < kEvidence || (causes_[taxel] & kStuckCause) != 0) continue;
    const auto frames = static_cast<std::size_t>(stuck_frames_[taxel]) * blocks();
    found(LineFaultKind::stuck_taxel, taxel, in.frame - std::min(in.frame, frames), in.conditioned.time);
    changes_[taxel] = 0;
  }
}

/// The counts that the ADC gave, as a line over the readings.
LineFaultMonitor::Implementation::CountScale LineFaultMonitor::Implementation::count_scale(const Inputs& in) const {
  const Readout& readout = array_.readout;
  const double supply = readout.adc_noise_counts / in.conditioned.sigma_ratio;
  return readout.pressure_raises_reading ? CountScale{0.0, supply} : CountScale{supply, -supply};
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
  const bool any_known = has_kind(kind);
  const std::size_t pairs = lines(row) - 1;
  if (pairs == 0) return;
  turn_[row] = (turn_[row] + 1) % pairs;
  for (std::size_t line = 0; line < pairs; ++line) {
    const bool is_suspect = shorted_[row][line].presses > 0 || (any_known && is_found(kind, line));
    if (is_suspect || line == turn_[row]) judge_shorted_pair(in, row, line);
  }
}

void LineFaultMonitor::Implementation::judge_shorted_pair(const Inputs& in, bool row, std::size_t line) {
  const LineFaultKind kind = row ? LineFaultKind::shorted_rows : LineFaultKind::shorted_columns;
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
    if (count.presses < kEqualPresses) return;
    found(kind, line, count.first_frame, count.first_time);
    count.against = 0;
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
/// press on it that shows alike in most other rows.
void LineFaultMonitor::Implementation::judge_supplied_rows(const Inputs& in) {
  if (array_.readout.circuit == Circuit::flexitac || array_.rows < 3 || has_kind(LineFaultKind::supplied_column))
    return;
  const std::vector<double>& sum = ratio_sum_[true];
  std::size_t least = 0;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    if (is_found(LineFaultKind::supplied_row, row)) return judge_supplied_row(in, row, true);
    if (!is_found(LineFaultKind::silent_row, row) && sum[row] < sum[least]) least = row;
  }
  const double noise = in.conditioned.sigma_ratio * std::sqrt(static_cast<double>(array_.cols));
  if (sum[supplied_candidate_] > sum[least] + kDifferentSigmas * noise) {
    supplied_candidate_ = least;
    supplied_ = PressCount();
  }
  judge_supplied_row(in, supplied_candidate_, false);
}

void LineFaultMonitor::Implementation::judge_supplied_row(const Inputs& in, std::size_t row, bool is_known) {
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
  supplied_.against = fails > 0 ? supplied_.against + 1 : (any ? 0 : supplied_.against);
  if (is_known) {
    if (supplied_.against < kLineFrames) return;
    healed(LineFaultKind::supplied_row, row);
    supplied_ = PressCount();
    return;
  }
  if (fails > 0) supplied_.presses = 0;
  supplied_.add(shows, in.frame, in.conditioned.time);
  if (supplied_.presses < kSupplyPresses) return;
  found(LineFaultKind::supplied_row, row, supplied_.first_frame, supplied_.first_time);
  supplied_.against = 0;
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
/// out too small by the factor 1 - d Y, Y the sum of the line as it comes out: untouched taxels fall at once when Y
/// rises, and rise when it falls. Memory of the material does not: what a press leaves behind only fades. Two frames
/// of one line at a time, while there is no other fault.
void LineFaultMonitor::Implementation::judge_drivers(const Inputs& in) {
  const Readout& readout = array_.readout;
  const bool is_modelled = readout.circuit == Circuit::transimpedance || readout.circuit == Circuit::flexitac ||
                           (readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::grounded);
  const bool is_faulty = std::any_of(faults_.begin(), faults_.end(), [](const LineFault& fault) {
    return fault.kind != LineFaultKind::drifting_driver;
  });
  const bool has_last = std::exchange(has_last_, in.solved && is_modelled && !is_faulty);
  if (!in.solved || !is_modelled) return;
  if (is_faulty) {
    find_untouched(in);
    for (LineFault& fault : faults_) {
      if (fault.kind == LineFaultKind::silent_row || fault.kind == LineFaultKind::silent_column)
        judge_ground(in, fault);
    }
    return;
  }
  const std::size_t driven = array_.driven_lines();
  for (std::size_t turn = 0; turn < kDriftLinesPerFrame && has_last; ++turn) {
    compare_with_last(in, (kDriftLinesPerFrame * in.frame + turn) % driven);
  }
  std::copy(in.conductance.siemens.begin(), in.conductance.siemens.end(), last_siemens_.begin());
  std::copy(line_siemens_.begin(), line_siemens_.end(), last_line_siemens_.begin());
}

/// Reads more than an unloaded taxel, in this frame or in the last one.
bool LineFaultMonitor::Implementation::is_touched(const Inputs& in, std::size_t taxel) const {
  const double most = kPressedShare * unloaded_siemens_[taxel] + kDifferentSigmas * in.conductance.sigma_siemens[taxel];
  return in.conductance.siemens[taxel] > most || last_siemens_[taxel] > most;
}

/// Places of a line where the line or one beside it is touched.
void LineFaultMonitor::Implementation::find_touched(const Inputs& in, std::size_t line) {
  const bool by_row = driven_is_row();
  const std::size_t from = line - std::min<std::size_t>(line, 1);
  const std::size_t to = std::min(line + 1, array_.driven_lines() - 1);
  for (std::size_t place = 0; place < touched_.size(); ++place) {
    bool touched = false;
    for (std::size_t near = from; near <= to; ++near) touched = touched || is_touched(in, at(by_row, near, place));
    touched_[place] = touched ? 1 : 0;
  }
}

void LineFaultMonitor::Implementation::compare_with_last(const Inputs& in, std::size_t line) {
  const bool by_row = driven_is_row();
  const double rise = line_siemens_[line] - last_line_siemens_[line];
  find_touched(in, line);
  double now = 0.0;
  double last = 0.0;
  double variance = 0.0;
  double unloaded = 0.0;
  for (std::size_t place = 0; place < touched_.size(); ++place) {
    const std::size_t taxel = at(by_row, line, place);
    unloaded += unloaded_siemens_[taxel];
    const auto from = touched_.begin() + static_cast<std::ptrdiff_t>(place - std::min(place, kContactReach));
    const auto to =
        touched_.begin() + static_cast<std::ptrdiff_t>(std::min(place + kContactReach + 1, touched_.size()));
    if (!(unloaded_siemens_[taxel] > 0.0) || std::find(from, to, 1) != to) continue;
    now += in.conductance.siemens[taxel];
    last += last_siemens_[taxel];
    variance += 2.0 * in.conductance.sigma_siemens[taxel] * in.conductance.sigma_siemens[taxel];
  }
  if (std::abs(rise) < kPressedShare * unloaded || !(variance > 0.0)) return;
  if (drift_[0][line].pairs + drift_[1][line].pairs == 0.0) drift_since_[line] = {in.frame, in.conditioned.time};
  const double mean = 0.5 * (now + last);
  variance += std::pow(kDoubtOfUnloaded * mean, 2);
  const double most = kMostOutlier * std::sqrt(variance);
  drift_[rise > 0.0 ? 1 : 0][line].add(mean * rise, std::clamp(last - now, -most, most), variance, rise);
  judge_driver(line);
}

void LineFaultMonitor::Implementation::judge_driver(std::size_t line) {
  const DriftFit& fallen = drift_[0][line];
  const DriftFit& risen = drift_[1][line];
  if (std::min(fallen.pairs, risen.pairs) < kDriftPairs) return;
  const double nominal_ohm = array_.readout.drive_ohm[line];
  const double least_sag_ohm = kLeastDriftSag / std::max(fallen.typical_load(), risen.typical_load());
  const double least_ohm = std::max(kLeastDriftShare * nominal_ohm, least_sag_ohm);
  const auto has_risen = [&](const DriftFit& fit) {
    return fit.estimate() > std::max(kDriftSigmas * fit.deviation(), least_ohm);
  };
  const auto is_nominal = [&](const DriftFit& fit) { return fit.estimate() + fit.deviation() < least_ohm; };
  const auto known = std::find_if(faults_.begin(), faults_.end(), [line](const LineFault& fault) {
    return fault.kind == LineFaultKind::drifting_driver && fault.place == line;
  });
  const double ohm = nominal_ohm + (fallen.moment + risen.moment) / (fallen.normal + risen.normal);
  if (known != faults_.end()) {
    known->drive_ohm = ohm;
    if (is_nominal(fallen) && is_nominal(risen)) healed(LineFaultKind::drifting_driver, line);
  } else if (has_risen(fallen) && has_risen(risen)) {
    const auto [first_frame, first_time] = drift_since_[line];
    found(LineFaultKind::drifting_driver, line, first_frame, first_time, ohm);
  }
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
