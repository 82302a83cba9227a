// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/guided_calibration.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "calibration/guide_fitter.hpp"
#include "calibration/guide_messages.hpp"
#include "calibration/press_hold.hpp"
#include "calibration/touch_sense.hpp"
#include "dermis/preprocessing/conditioner.hpp"

namespace dermis::calibration {
namespace {

constexpr std::array kDefaultWeightsN = {1.0, 2.0, 5.0, 10.0, 20.0};
constexpr double kDefaultTaxels = 16.0;
constexpr std::size_t kMostWeights = 16;
constexpr double kLeastWeightN = 0.01;
constexpr double kMostWeightN = 1000.0;
constexpr double kMostFrameValues = 24e6;  // kept frames x taxels: 96 MB

constexpr std::size_t kSamplesForOwnNetwork = 8;  // of a taxel
constexpr double kReleasedShare = 0.15;           // of the excess of the press
constexpr double kLostShare = 0.5;
constexpr double kOtherTaxelSeconds = 0.15;  // while a weight is put on
constexpr std::size_t kPressesForFirstFit = 8;
constexpr std::size_t kFitsPerDoubling = 6;

/// Frames that are kept of one press.
std::size_t frames_of_press(std::size_t weights) {
  if (weights >= kSamplesForOwnNetwork) return 1;
  return 2 * weights >= kSamplesForOwnNetwork ? 2 : PressHold::kParts;
}

Status check_seconds(const char* field, Nanos time, double least, double most) {
  const double seconds = std::chrono::duration<double>(time).count();
  if (seconds >= least && seconds <= most) return Done{};
  return bad_input(fmt::format("{}: must be {:g} to {:g} s", field, least, most));
}

Status check_taxels(const std::vector<std::size_t>& taxels, const ArrayDescription& array) {
  if (taxels.empty()) return bad_input("taxels: there are none");
  std::vector<bool> seen(array.taxel_count());
  for (const std::size_t taxel : taxels) {
    if (taxel >= seen.size()) {
      return bad_input(fmt::format("taxels: {} is beyond the last one, {}", taxel, seen.size() - 1));
    }
    if (seen[taxel]) return bad_input("taxels: " + array.taxel_name(taxel) + " is there twice");
    seen[taxel] = true;
  }
  return Done{};
}

double ratio_per_count(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  const double reference =
      readout.adc_reference_v && readout.supply_v ? *readout.adc_reference_v / *readout.supply_v : 1.0;
  return reference / readout.full_scale_counts();
}

}  // namespace

Status CalibrationPlan::validate(const ArrayDescription& array) const {
  if (Status checked = check_taxels(taxels, array); !checked) return checked;
  if (weights_n.empty() || weights_n.size() > kMostWeights) {
    return bad_input(fmt::format("weights_n: must be 1 to {} weights", kMostWeights));
  }
  for (std::size_t k = 0; k < weights_n.size(); ++k) {
    if (!(weights_n[k] >= kLeastWeightN && weights_n[k] <= kMostWeightN)) {
      return bad_input(fmt::format("weights_n: {:g} is not {:g} to {:g} N", weights_n[k], kLeastWeightN, kMostWeightN));
    }
    if (std::count(weights_n.begin(), weights_n.end(), weights_n[k]) > 1) {
      return bad_input(fmt::format("weights_n: {:g} is there twice", weights_n[k]));
    }
  }
  const auto values = static_cast<double>(press_count() * frames_of_press(weights_n.size()) * array.taxel_count());
  if (press_count() > kMostGuidedPresses || values > kMostFrameValues) {
    return bad_input(fmt::format("taxels: {} presses are too many; press fewer taxels", press_count()));
  }
  if (Status checked = check_seconds("unloaded_time", unloaded_time, 0.2, 60.0); !checked) return checked;
  return check_seconds("hold_time", hold_time, 0.05, 30.0);
}

std::vector<std::size_t> taxels_with_stride(const ArrayDescription& array, std::size_t stride) {
  std::vector<std::size_t> taxels;
  const auto first = [&](std::size_t lines) { return (lines - 1) % stride / 2; };
  for (std::size_t row = first(array.rows); row < array.rows; row += stride) {
    for (std::size_t col = first(array.cols); col < array.cols; col += stride) taxels.push_back(array.index(row, col));
  }
  return taxels;
}

CalibrationPlan default_plan(const ArrayDescription& array) {
  const double stride = std::round(std::sqrt(static_cast<double>(array.taxel_count()) / kDefaultTaxels));
  CalibrationPlan plan;
  plan.taxels = taxels_with_stride(array, static_cast<std::size_t>(std::max(1.0, stride)));
  plan.weights_n.assign(kDefaultWeightsN.begin(), kDefaultWeightsN.end());
  return plan;
}

class GuidedCalibration::Implementation {
 public:
  Implementation(ArrayDescription array, CalibrationPlan plan);

  void feed(const RawFrame& raw);
  Status skip();
  Status repeat();
  Status finish();
  GuideState state() const;
  std::shared_ptr<const Calibration> calibration() const;
  GuidedData data() const;

 private:
  enum class Step : std::uint8_t { open, done, skipped };

  void wait_for_quiet(const RawFrame& raw);
  void follow_press(const RawFrame& raw);
  void wait_for_press(const RawFrame& raw, const Touch& touch);
  void hold(const RawFrame& raw, const Touch& touch);
  [[nodiscard]] bool is_released() const;
  [[nodiscard]] bool is_memory(const Touch& touch) const;
  void keep_press();
  void go_on();
  void ask(GuideHint hint) { hint_ = hint; }
  void start_fit(bool is_last);
  void take(GuideFitter::Outcome outcome);

  const ArrayDescription array_;
  const CalibrationPlan plan_;

  mutable std::mutex mutex_;
  preprocessing::Conditioner conditioner_;
  ConditionedFrame conditioned_;
  std::optional<Nanos> last_time_;
  double seconds_ = 0.0;  // since the frame before

  GuideStage stage_ = GuideStage::unloaded;
  GuideHint hint_ = GuideHint::none;
  QuietWindow quiet_;
  std::optional<TouchSense> sense_;
  PressHold hold_;
  Touch touch_;
  double other_seconds_ = 0.0;  // that another taxel is pressed
  double reading_ = 1.0;

  std::vector<Step> steps_;
  std::size_t step_ = 0;
  double kept_excess_ = 0.0;
  std::vector<std::size_t> kept_steps_;  // of presses_
  GuidedPresses presses_;
  std::shared_ptr<const std::vector<RawFrame>> unloaded_;

  std::size_t presses_at_fit_ = 0;
  std::optional<double> error_;
  std::optional<double> unpressed_error_;
  std::shared_ptr<const Calibration> calibration_;
  std::string outcome_;  // message of done and failed
  GuideFitter fitter_;   // last: its thread ends before the rest goes
};

GuidedCalibration::Implementation::Implementation(ArrayDescription array, CalibrationPlan plan)
    : array_(std::move(array)),
      plan_(std::move(plan)),
      conditioner_(array_),
      quiet_(plan_.unloaded_time, ratio_per_count(array_)),
      hold_(plan_.hold_time),
      steps_(plan_.press_count(), Step::open),
      fitter_(array_, [this](GuideFitter::Outcome outcome) { take(std::move(outcome)); }) {}

void GuidedCalibration::Implementation::feed(const RawFrame& raw) {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::unloaded && stage_ != GuideStage::pressing) return;
  conditioner_.process(raw, conditioned_);
  if (conditioner_.rejection() != preprocessing::Rejection::none) return;
  seconds_ = last_time_ ? std::chrono::duration<double>(raw.time - *last_time_).count() : 0.0;
  last_time_ = raw.time;
  stage_ == GuideStage::unloaded ? wait_for_quiet(raw) : follow_press(raw);
}

void GuidedCalibration::Implementation::wait_for_quiet(const RawFrame& raw) {
  quiet_.feed(raw, conditioned_.ratio);
  if (!quiet_.is_done()) return;
  unloaded_ = std::make_shared<const std::vector<RawFrame>>(quiet_.frames());
  sense_.emplace(quiet_.mean(), ratio_per_count(array_));
  stage_ = GuideStage::pressing;
  ask(GuideHint::press);
}

void GuidedCalibration::Implementation::follow_press(const RawFrame& raw) {
  const std::size_t taxel = plan_.taxel_of(step_);
  touch_ = sense_->feel(conditioned_.ratio, taxel);
  reading_ = sense_->relative(conditioned_.ratio, taxel);
  if (!touch_.strongest) sense_->follow(conditioned_.ratio, seconds_);
  if (hint_ == GuideHint::release) {
    if (is_released()) go_on();
  } else if (hold_.has_begun()) {
    hold(raw, touch_);
  } else {
    wait_for_press(raw, touch_);
  }
}

/// What is felt is what the material remembers of the last press.
bool GuidedCalibration::Implementation::is_memory(const Touch& touch) const {
  return !presses_.empty() && touch.strongest == presses_.back()->taxel && is_released();
}

void GuidedCalibration::Implementation::wait_for_press(const RawFrame& raw, const Touch& touch) {
  const std::size_t taxel = plan_.taxel_of(step_);
  if (touch.strongest == taxel && !touch.beside) {
    hold_.feed(raw, conditioned_.ratio, sense_->excess(conditioned_.ratio, taxel), sense_->noise(taxel));
    other_seconds_ = 0.0;
    return ask(GuideHint::hold);
  }
  const bool is_touched = touch.strongest && !is_memory(touch);
  other_seconds_ = is_touched ? other_seconds_ + seconds_ : 0.0;
  if (other_seconds_ > kOtherTaxelSeconds) {
    ask(touch.strongest == taxel ? GuideHint::several : GuideHint::other_taxel);
  } else if (!is_touched && hint_ != GuideHint::too_short) {
    ask(GuideHint::press);
  }
}

void GuidedCalibration::Implementation::hold(const RawFrame& raw, const Touch& touch) {
  const std::size_t taxel = plan_.taxel_of(step_);
  const double excess = sense_->excess(conditioned_.ratio, taxel);
  if (touch.strongest != taxel || touch.beside || excess < kLostShare * hold_.mean_excess()) {
    hold_.clear();
    return ask(touch.strongest ? GuideHint::hold : GuideHint::too_short);
  }
  hold_.feed(raw, conditioned_.ratio, excess, sense_->noise(taxel));
  ask(hold_.was_unsteady() ? GuideHint::unsteady : GuideHint::hold);
  if (hold_.is_done()) keep_press();
}

void GuidedCalibration::Implementation::keep_press() {
  auto press = std::make_shared<GuidedPress>();
  press->taxel = plan_.taxel_of(step_);
  press->newtons = plan_.weight_of(step_);
  press->frames = hold_.frames(frames_of_press(plan_.weights_n.size()));
  kept_excess_ = hold_.mean_excess();
  presses_.push_back(std::move(press));
  kept_steps_.push_back(step_);
  steps_[step_] = Step::done;
  hold_.clear();
  ask(GuideHint::release);
  const std::size_t due = presses_at_fit_ + std::max<std::size_t>(1, presses_at_fit_ / kFitsPerDoubling);
  if (presses_.size() >= std::max(kPressesForFirstFit, due)) start_fit(false);
}

/// Whether the taxel of the last press no longer feels it, but for what the material remembers.
bool GuidedCalibration::Implementation::is_released() const {
  const std::size_t taxel = presses_.back()->taxel;
  return sense_->excess(conditioned_.ratio, taxel) < std::max(kReleasedShare * kept_excess_, sense_->threshold(taxel));
}
/// To the first press that is neither kept nor skipped; after the last one to the fit.
void GuidedCalibration::Implementation::go_on() {
  hold_.clear();
  other_seconds_ = 0.0;
  const auto open = std::find(steps_.begin(), steps_.end(), Step::open);
  if (open == steps_.end()) return start_fit(true);
  step_ = static_cast<std::size_t>(open - steps_.begin());
  ask(GuideHint::press);
}

void GuidedCalibration::Implementation::start_fit(bool is_last) {
  if (is_last && presses_.empty()) {
    stage_ = GuideStage::failed;
    outcome_ = "Every press was skipped: there is nothing to fit.";
    return;
  }
  if (is_last) {
    stage_ = GuideStage::fitting;
    ask(GuideHint::none);
  }
  presses_at_fit_ = presses_.size();
  fitter_.fit({unloaded_, presses_, is_last});
}

void GuidedCalibration::Implementation::take(GuideFitter::Outcome outcome) {
  const std::lock_guard lock(mutex_);
  if (outcome.error) error_ = outcome.error;
  unpressed_error_ = outcome.unpressed_error;
  if (!outcome.calibration) return;
  if (!*outcome.calibration) {
    stage_ = GuideStage::failed;
    outcome_ = outcome.calibration->error().message;
    return;
  }
  calibration_ = std::make_shared<const Calibration>(std::move(outcome.calibration->value()));
  stage_ = GuideStage::done;
}

Status GuidedCalibration::Implementation::skip() {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::pressing) return bad_input("there is no press to skip");
  if (hint_ != GuideHint::release) steps_[step_] = Step::skipped;
  go_on();
  return Done{};
}

Status GuidedCalibration::Implementation::repeat() {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::pressing && stage_ != GuideStage::failed)
    return bad_input("there is no press to repeat now");
  if (presses_.empty()) return bad_input("there is no press to repeat yet");
  step_ = kept_steps_.back();
  steps_[step_] = Step::open;
  presses_.pop_back();
  kept_steps_.pop_back();
  presses_at_fit_ = std::min(presses_at_fit_, presses_.size());
  stage_ = GuideStage::pressing;
  hold_.clear();
  ask(GuideHint::press);
  return Done{};
}

Status GuidedCalibration::Implementation::finish() {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::pressing) return bad_input("there is nothing to finish");
  if (presses_.empty()) return bad_input("there is no press yet");
  start_fit(true);
  return Done{};
}

GuideState GuidedCalibration::Implementation::state() const {
  const std::lock_guard lock(mutex_);
  GuideState state;
  state.stage = stage_;
  state.hint = hint_;
  state.taxel = plan_.taxel_of(step_);
  state.weight_n = plan_.weight_of(step_);
  state.reading = reading_;
  if (last_time_) {
    state.hold_share = stage_ == GuideStage::unloaded ? quiet_.share(*last_time_) : hold_.share(*last_time_);
  }
  if (hint_ == GuideHint::release) state.hold_share = 1.0;
  if (stage_ == GuideStage::pressing) {
    state.pressed_taxel = hint_ == GuideHint::several ? touch_.beside : touch_.strongest;
  }
  state.presses_done = presses_.size();
  state.presses_total =
      steps_.size() - static_cast<std::size_t>(std::count(steps_.begin(), steps_.end(), Step::skipped));
  state.median_relative_error = error_;
  state.unpressed_relative_error = unpressed_error_;
  state.taxel_presses.resize(array_.taxel_count());
  for (const auto& press : presses_) ++state.taxel_presses[press->taxel];
  switch (stage_) {
    case GuideStage::none: break;
    case GuideStage::unloaded:
      state.message = quiet_.is_disturbed() ? "Something moves on the array: take everything off and leave it alone."
                                            : "Take everything off the array and leave it alone.";
      break;
    case GuideStage::pressing: state.message = describe_press(state, array_); break;
    case GuideStage::fitting: state.message = fmt::format("Fitting {} presses.", presses_.size()); break;
    case GuideStage::done: state.message = describe_result(*calibration_, state, presses_); break;
    case GuideStage::failed: state.message = outcome_; break;
  }
  return state;
}

std::shared_ptr<const Calibration> GuidedCalibration::Implementation::calibration() const {
  const std::lock_guard lock(mutex_);
  return calibration_;
}

GuidedData GuidedCalibration::Implementation::data() const {
  const std::lock_guard lock(mutex_);
  if (!unloaded_) return {};
  return labelled_frames(array_, *unloaded_, presses_);
}

GuidedCalibration::GuidedCalibration(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
GuidedCalibration::~GuidedCalibration() = default;

Result<std::unique_ptr<GuidedCalibration>> GuidedCalibration::create(ArrayDescription array, CalibrationPlan plan) {
  if (Status valid = array.validate(); !valid) return valid.error();
  if (Status valid = plan.validate(array); !valid) return valid.error();
  return std::unique_ptr<GuidedCalibration>(
      new GuidedCalibration(std::make_unique<Implementation>(std::move(array), std::move(plan))));
}

void GuidedCalibration::feed(const RawFrame& raw) {
  implementation_->feed(raw);
}
Status GuidedCalibration::skip() {
  return implementation_->skip();
}
Status GuidedCalibration::repeat() {
  return implementation_->repeat();
}
Status GuidedCalibration::finish() {
  return implementation_->finish();
}
GuideState GuidedCalibration::state() const {
  return implementation_->state();
}
std::shared_ptr<const Calibration> GuidedCalibration::calibration() const {
  return implementation_->calibration();
}
GuidedData GuidedCalibration::data() const {
  return implementation_->data();
}

}  // namespace dermis::calibration
