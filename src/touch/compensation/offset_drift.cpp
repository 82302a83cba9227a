// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/offset_drift.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "dermis/touch/frames/neighbours.hpp"
#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kBlockS = 1.0;
constexpr double kLongestGapS = 60.0;               // Frames further apart, or back in time, begin anew.
constexpr double kFollowS = 30.0;                   // Time constant of following,
constexpr double kPriorBlocks = 10.0;               // and how many blocks the offset that it begins with is worth.
constexpr float kSettlingBlocks = 30.0F;            // From the beginning; after that no faster than
constexpr double kUnloadedPerSecond = 0.01 / 60.0;  // 1 % of the unloaded conductance a minute
constexpr double kSigmasPerSecond = 1.0 / 600.0;    // and a sigma in ten.
constexpr float kCreepBackS = 10.0F;
constexpr double kBandOfUnloaded = 0.1;
constexpr double kBandSigmas = 5.0;
constexpr double kRangeSigmas = 3.0;
constexpr double kMostAveraged = 25.0;  // Not all noise is white.
constexpr std::size_t kLeastTareFrames = 10;
constexpr double kLongestTareS = 10.0;
constexpr FrameStatus kTellsNoOffset = FrameStatus::not_converged | FrameStatus::supply_implausible;

double seconds(Nanos span) {
  return 1e-9 * static_cast<double>(span.count());
}

}  // namespace

class OffsetDrift::Implementation {
 public:
  Implementation(const FrameShape& shape, UnloadedConductance unloaded, const OffsetDriftOptions& options);

  [[nodiscard]] bool observe(const ConductanceFrame& frame) noexcept;
  void correct(ConductanceFrame& frame) const noexcept;
  void tare() noexcept;
  void undo_tare() noexcept;
  void use_offsets(std::span<const double> offsets) noexcept;
  void reset() noexcept;
  void set_options(const OffsetDriftOptions& options) noexcept;

  [[nodiscard]] bool taring() const noexcept { return taring_; }
  [[nodiscard]] const OffsetDriftOptions& options() const noexcept { return options_; }
  [[nodiscard]] std::span<const double> offsets() const noexcept { return zero_.offset; }
  [[nodiscard]] const TareStep& tare_step() const noexcept { return step_; }

 private:
  /// Frames that are averaged.
  struct Block {
    explicit Block(std::size_t taxels) : sum(taxels), sigma(taxels), trouble(taxels) {}

    Nanos begin{};
    Nanos last_time{};
    std::size_t frames = 0;
    double temperature_sum = 0.0;
    std::vector<double> sum;            // Sum of the frames; then their mean beside the calibration [S].
    std::vector<double> sigma;          // Standard deviation of one reading, in the last frame [S].
    std::vector<std::uint8_t> trouble;  // Not 0: some frame had a status other than ok.
  };

  /// Beside the calibration [taxels] [S].
  struct Zero {
    explicit Zero(std::size_t taxels) : offset(taxels), tared(taxels) {}

    std::vector<double> offset;  // what is subtracted
    std::vector<double> tared;   // the same after the last tare, from which following may only go so far
  };

  [[nodiscard]] bool fits(const ConductanceFrame& frame) const noexcept;
  void begin_block(Nanos time) noexcept;
  void forget_history() noexcept;
  void accumulate(const ConductanceFrame& frame) noexcept;
  void level_gradient(const ConductanceFrame& frame) noexcept;
  [[nodiscard]] bool block_is_complete(double block_s) const noexcept;
  void finish_block(double block_s) noexcept;
  void average_block() noexcept;
  void take_block_as_zero() noexcept;
  void begin_at_zero() noexcept;
  void measure_step(std::size_t taxel, double step) noexcept;
  void find_pressed() noexcept;
  void hold_pressed(double block_s) noexcept;
  [[nodiscard]] bool pressed_nearby(std::size_t taxel) const noexcept;
  void follow_idle(double block_s) noexcept;
  void follow(std::size_t taxel, double block_s) noexcept;
  [[nodiscard]] double unloaded_siemens(std::size_t taxel) const noexcept;
  [[nodiscard]] double band(std::size_t taxel) const noexcept;
  [[nodiscard]] double noise_of_mean(std::size_t taxel) const noexcept;
  [[nodiscard]] bool is_below_any_load(std::size_t taxel) const noexcept;
  [[nodiscard]] bool is_idle(std::size_t taxel) const noexcept;

  FrameShape shape_;
  UnloadedConductance unloaded_;
  OffsetDriftOptions options_;
  bool taring_ = false;
  bool corrects_ = false;  // An offset may be other than 0.

  Zero zero_;
  Zero former_;  // before the last tare
  TareStep step_;

  Block block_;
  std::vector<std::uint8_t> pressed_;  // In this block.
  std::vector<float> hold_s_;          // Not followed for so long.
  std::vector<double> candidate_;      // Mean of the block before, to be followed if this one is idle, too.
  std::vector<std::uint8_t> has_candidate_;
  std::vector<float> followed_blocks_;
};

OffsetDrift::Implementation::Implementation(const FrameShape& shape, UnloadedConductance unloaded,
                                            const OffsetDriftOptions& options)
    : shape_(shape),
      unloaded_(std::move(unloaded)),
      options_(options),
      zero_(shape.taxel_count()),
      former_(shape.taxel_count()),
      step_{std::vector<double>(shape.taxel_count()), std::vector<std::uint8_t>(shape.taxel_count())},
      block_(shape.taxel_count()),
      pressed_(shape.taxel_count()),
      hold_s_(shape.taxel_count()),
      candidate_(shape.taxel_count()),
      has_candidate_(shape.taxel_count()),
      followed_blocks_(shape.taxel_count()) {
  assert(unloaded_.law.offset_siemens.size() == shape.taxel_count());
  assert(unloaded_.law.per_celsius.size() == shape.taxel_count());
  assert(unloaded_.sigma_siemens.size() == shape.taxel_count());
}

bool OffsetDrift::Implementation::fits(const ConductanceFrame& frame) const noexcept {
  const std::size_t taxels = zero_.offset.size();
  return frame.siemens.size() == taxels && frame.sigma_siemens.size() == taxels && frame.taxels.size() == taxels &&
         !has(frame.status, FrameStatus::rejected);
}

bool OffsetDrift::Implementation::observe(const ConductanceFrame& frame) noexcept {
  const bool was_taring = taring_;
  if (!(options_.track || taring_) || !fits(frame) || has(frame.status, kTellsNoOffset)) return false;
  const double since_last_s = seconds(frame.time - block_.last_time);
  const double block_s = seconds(frame.time - block_.begin);
  if (block_.frames > 0 && (since_last_s < 0.0 || since_last_s > kLongestGapS)) {
    forget_history();
  } else if (block_.frames > 0 && block_is_complete(block_s)) {
    finish_block(block_s);
  }
  if (block_.frames == 0) begin_block(frame.time);
  accumulate(frame);
  return was_taring && !taring_;
}

DERMIS_PROCESSOR_CLONES void OffsetDrift::Implementation::correct(ConductanceFrame& frame) const noexcept {
  if (!corrects_ || !fits(frame)) return;
  double* const siemens = frame.siemens.data();
  const double* const offset = zero_.offset.data();
  for (std::size_t k = 0; k < zero_.offset.size(); ++k) {
    const double corrected = siemens[k] - offset[k];
    siemens[k] = corrected < 0.0 ? 0.0 : corrected;  // NaN stays
  }
}

void OffsetDrift::Implementation::tare() noexcept {
  taring_ = true;
  forget_history();
}

void OffsetDrift::Implementation::undo_tare() noexcept {
  taring_ = false;
  zero_ = former_;
  begin_at_zero();
  forget_history();
}

void OffsetDrift::Implementation::use_offsets(std::span<const double> offsets) noexcept {
  assert(offsets.size() == zero_.offset.size());
  taring_ = false;
  corrects_ = true;
  std::copy(offsets.begin(), offsets.end(), zero_.offset.begin());
  zero_.tared = zero_.offset;
  begin_at_zero();
  forget_history();
}

void OffsetDrift::Implementation::reset() noexcept {
  taring_ = false;
  corrects_ = false;
  std::fill(zero_.offset.begin(), zero_.offset.end(), 0.0);
  std::fill(zero_.tared.begin(), zero_.tared.end(), 0.0);
  begin_at_zero();
  forget_history();
}

/// All that is known of the zero is its offsets.
void OffsetDrift::Implementation::begin_at_zero() noexcept {
  std::fill(hold_s_.begin(), hold_s_.end(), 0.0F);
  std::fill(followed_blocks_.begin(), followed_blocks_.end(), 0.0F);
}

void OffsetDrift::Implementation::set_options(const OffsetDriftOptions& options) noexcept {
  if (options.track && !options_.track) forget_history();
  options_ = options;
}

void OffsetDrift::Implementation::begin_block(Nanos time) noexcept {
  block_.begin = time;
  block_.temperature_sum = 0.0;
  std::fill(block_.sum.begin(), block_.sum.end(), 0.0);
  std::fill(block_.trouble.begin(), block_.trouble.end(), std::uint8_t{0});
}

void OffsetDrift::Implementation::forget_history() noexcept {
  block_.frames = 0;
  std::fill(has_candidate_.begin(), has_candidate_.end(), std::uint8_t{0});
}

DERMIS_PROCESSOR_CLONES void OffsetDrift::Implementation::accumulate(const ConductanceFrame& frame) noexcept {
  const TemperatureSpan& calibrated = unloaded_.law.temperature;
  block_.temperature_sum += calibrated.offset(frame.temperature_celsius);
  if (!frame.taxel_celsius.empty()) level_gradient(frame);
  const double* const siemens = frame.siemens.data();
  double* const sum = block_.sum.data();
  for (std::size_t k = 0; k < block_.sum.size(); ++k) sum[k] += siemens[k];
  const TaxelStatus* const status = frame.taxels.data();
  std::uint8_t* const trouble = block_.trouble.data();
  for (std::size_t k = 0; k < block_.trouble.size(); ++k) trouble[k] |= static_cast<std::uint8_t>(status[k]);
  std::copy(frame.sigma_siemens.begin(), frame.sigma_siemens.end(), block_.sigma.begin());
  block_.last_time = frame.time;
  ++block_.frames;
}

/// As if all taxels had the mean temperature.
void OffsetDrift::Implementation::level_gradient(const ConductanceFrame& frame) noexcept {
  const TemperatureSpan& calibrated = unloaded_.law.temperature;
  const double mean = calibrated.offset(frame.temperature_celsius);
  for (std::size_t k = 0; k < block_.sum.size(); ++k) {
    block_.sum[k] -= unloaded_.law.per_celsius[k] * (calibrated.offset(frame.celsius(k)) - mean);
  }
}

bool OffsetDrift::Implementation::block_is_complete(double block_s) const noexcept {
  if (!taring_) return block_s >= kBlockS;
  return block_s >= kBlockS && (block_.frames >= kLeastTareFrames || block_s >= kLongestTareS);
}

void OffsetDrift::Implementation::finish_block(double block_s) noexcept {
  average_block();
  if (taring_) {
    take_block_as_zero();
  } else {
    find_pressed();
    hold_pressed(block_s);
    follow_idle(block_s);
  }
  block_.frames = 0;
}

void OffsetDrift::Implementation::average_block() noexcept {
  const double per_frame = 1.0 / static_cast<double>(block_.frames);
  const double temperature_offset = block_.temperature_sum * per_frame;
  for (std::size_t k = 0; k < block_.sum.size(); ++k) {
    block_.sum[k] = unloaded_.law.excess(k, block_.sum[k] * per_frame, temperature_offset);
  }
}

/// Shrinks the step by the share of its square that the noise of the mean may be (James and Stein 1961).
void OffsetDrift::Implementation::take_block_as_zero() noexcept {
  former_ = zero_;
  for (std::size_t k = 0; k < zero_.offset.size(); ++k) {
    const double step = block_.sum[k] - zero_.offset[k];
    const double variance = block_.sigma[k] * block_.sigma[k] / static_cast<double>(block_.frames);
    const double shrunk = step * std::max(0.0, 1.0 - variance / (step * step));
    measure_step(k, step);
    if (std::isfinite(shrunk)) zero_.offset[k] += shrunk;
  }
  zero_.tared = zero_.offset;
  begin_at_zero();
  taring_ = false;
  corrects_ = true;
}

void OffsetDrift::Implementation::measure_step(std::size_t taxel, double step) noexcept {
  const double noise = noise_of_mean(taxel);
  step_.siemens[taxel] = step > noise ? step : 0.0;
  step_.is_beyond_drift[taxel] = step > kMostDriftOfUnloaded * unloaded_siemens(taxel) + noise ? 1 : 0;
}

double OffsetDrift::Implementation::unloaded_siemens(std::size_t taxel) const noexcept {
  return std::max(0.0, unloaded_.law.offset_siemens[taxel] + zero_.tared[taxel]);
}

/// And of the calibrated offset: no mean of an unloaded taxel differs by more.
double OffsetDrift::Implementation::noise_of_mean(std::size_t taxel) const noexcept {
  const double averaged = std::min(static_cast<double>(block_.frames), kMostAveraged);
  return kRangeSigmas * unloaded_.sigma_siemens[taxel] + kBandSigmas * block_.sigma[taxel] / std::sqrt(averaged);
}

double OffsetDrift::Implementation::band(std::size_t taxel) const noexcept {
  return kBandOfUnloaded * unloaded_siemens(taxel) + noise_of_mean(taxel);
}

void OffsetDrift::Implementation::find_pressed() noexcept {
  for (std::size_t k = 0; k < pressed_.size(); ++k) pressed_[k] = block_.sum[k] - zero_.offset[k] > band(k) ? 1 : 0;
}

void OffsetDrift::Implementation::hold_pressed(double block_s) noexcept {
  for (std::size_t k = 0; k < hold_s_.size(); ++k) {
    hold_s_[k] = pressed_nearby(k) ? kCreepBackS : std::max(0.0F, hold_s_[k] - static_cast<float>(block_s));
  }
}

bool OffsetDrift::Implementation::pressed_nearby(std::size_t taxel) const noexcept {
  for (const std::size_t near : Neighbours(shape_.rows, shape_.cols, taxel)) {
    if (pressed_[near] != 0) return true;
  }
  return false;
}

/// False for NaN, as is_idle().
bool OffsetDrift::Implementation::is_below_any_load(std::size_t taxel) const noexcept {
  return block_.sum[taxel] < zero_.offset[taxel] && block_.sum[taxel] < -band(taxel);
}

bool OffsetDrift::Implementation::is_idle(std::size_t taxel) const noexcept {
  if (block_.trouble[taxel] != 0 || hold_s_[taxel] > 0.0F) return false;
  return std::abs(block_.sum[taxel] - zero_.offset[taxel]) <= band(taxel) || is_below_any_load(taxel);
}

void OffsetDrift::Implementation::follow_idle(double block_s) noexcept {
  for (std::size_t k = 0; k < zero_.offset.size(); ++k) {
    const bool idle = is_idle(k);
    if (idle && has_candidate_[k] != 0) follow(k, block_s);
    has_candidate_[k] = idle ? 1 : 0;
    if (idle) candidate_[k] = block_.sum[k];
  }
  corrects_ = true;
}

void OffsetDrift::Implementation::follow(std::size_t taxel, double block_s) noexcept {
  const double unloaded = unloaded_siemens(taxel);
  float& blocks = followed_blocks_[taxel];
  const double gain = std::max(std::min(1.0, block_s / kFollowS), 1.0 / (kPriorBlocks + static_cast<double>(blocks)));
  double step = gain * (candidate_[taxel] - zero_.offset[taxel]);
  if (blocks >= kSettlingBlocks && !is_below_any_load(taxel)) {
    const double largest = block_s * (kUnloadedPerSecond * unloaded + kSigmasPerSecond * block_.sigma[taxel]);
    step = std::clamp(step, -largest, largest);
  }
  const double most = zero_.tared[taxel] + kMostDriftOfUnloaded * unloaded +
                      kRangeSigmas * (block_.sigma[taxel] + unloaded_.sigma_siemens[taxel]);
  zero_.offset[taxel] = std::min(zero_.offset[taxel] + step, most);
  blocks = std::min(blocks + 1.0F, kSettlingBlocks);
}

OffsetDrift::OffsetDrift(const FrameShape& shape, UnloadedConductance unloaded, const OffsetDriftOptions& options)
    : implementation_(std::make_unique<Implementation>(shape, std::move(unloaded), options)) {}
OffsetDrift::OffsetDrift(OffsetDrift&&) noexcept = default;
OffsetDrift& OffsetDrift::operator=(OffsetDrift&&) noexcept = default;
OffsetDrift::~OffsetDrift() = default;

void OffsetDrift::process(ConductanceFrame& frame) noexcept {
  static_cast<void>(observe(frame));
  correct(frame);
}

bool OffsetDrift::observe(const ConductanceFrame& frame) noexcept {
  return implementation_->observe(frame);
}

void OffsetDrift::correct(ConductanceFrame& frame) const noexcept {
  implementation_->correct(frame);
}

void OffsetDrift::tare() noexcept {
  implementation_->tare();
}

void OffsetDrift::undo_tare() noexcept {
  implementation_->undo_tare();
}

const TareStep& OffsetDrift::tare_step() const noexcept {
  return implementation_->tare_step();
}

bool OffsetDrift::taring() const noexcept {
  return implementation_->taring();
}

void OffsetDrift::use_offsets(std::span<const double> offsets) noexcept {
  implementation_->use_offsets(offsets);
}

void OffsetDrift::reset() noexcept {
  implementation_->reset();
}

void OffsetDrift::set_options(const OffsetDriftOptions& options) noexcept {
  implementation_->set_options(options);
}

const OffsetDriftOptions& OffsetDrift::options() const noexcept {
  return implementation_->options();
}

std::span<const double> OffsetDrift::offsets() const noexcept {
  return implementation_->offsets();
}

}  // namespace dermis::touch::compensation
