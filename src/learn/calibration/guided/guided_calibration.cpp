// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/guided_calibration.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

#include "dermis/touch/preprocessing/conditioner.hpp"
#include "learn/calibration/guided/guide_fitter.hpp"
#include "learn/calibration/guided/guide_messages.hpp"
#include "learn/calibration/guided/press_recogniser.hpp"
#include "learn/calibration/guided/press_sequence.hpp"
#include "learn/calibration/guided/proof_presses.hpp"
#include "learn/calibration/guided/touch_sense.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kPressesForFirstFit = 8;
constexpr std::size_t kFitsPerDoubling = 6;

double ratio_per_count(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  const double reference =
      readout.adc_reference_v && readout.supply_v ? *readout.adc_reference_v / *readout.supply_v : 1.0;
  return reference / readout.full_scale_counts();
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

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
  /// The findings of the fits so far.
  struct Fit {
    std::size_t presses = 0;  // of the last one that was asked for
    std::optional<double> error;
    std::optional<double> unpressed_error;
    std::shared_ptr<const Calibration> calibration;
    std::string failure;
    double share = 0.0;                           // done of the last one
    std::chrono::steady_clock::time_point begin;  // of the last one
  };

  void wait_for_quiet(const RawFrame& raw);
  void follow_press(const RawFrame& raw, double seconds);
  void keep_press();
  void ask_for_next();
  void start_fit(bool is_last);
  void ask_for_proof();
  void start_last_fit();
  void fail(std::string why);
  void accept_fit(FitOutcome outcome);
  void accept_share(double share);
  [[nodiscard]] std::string message(const GuideState& state) const;

  const ArrayDescription array_;
  const CalibrationPlan plan_;

  mutable std::mutex mutex_;
  GuideStage stage_ = GuideStage::unloaded;
  touch::preprocessing::Conditioner conditioner_;
  ConditionedFrame conditioned_;
  std::optional<Nanos> last_time_;
  QuietWindow quiet_;
  std::shared_ptr<const std::vector<RawFrame>> unloaded_;
  std::optional<PressRecogniser> recogniser_;  // once the unloaded array is known
  PressSequence presses_;
  Fit fit_;
  GuideFitter fitter_;  // last: its thread ends before the rest goes
};

GuidedCalibration::Implementation::Implementation(ArrayDescription array, CalibrationPlan plan)
    : array_(std::move(array)),
      plan_(std::move(plan)),
      conditioner_(array_),
      quiet_(plan_.unloaded_time, ratio_per_count(array_)),
      presses_(plan_, array_.cols),
      fitter_(
          array_, [this](FitOutcome outcome) { accept_fit(std::move(outcome)); },
          [this](double share) { accept_share(share); }) {}

void GuidedCalibration::Implementation::feed(const RawFrame& raw) {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::unloaded && stage_ != GuideStage::pressing) return;
  conditioner_.process(raw, conditioned_);
  if (conditioner_.rejection() != touch::preprocessing::Rejection::none) return;
  const double seconds = last_time_ ? std::chrono::duration<double>(raw.time - *last_time_).count() : 0.0;
  last_time_ = raw.time;
  stage_ == GuideStage::unloaded ? wait_for_quiet(raw) : follow_press(raw, seconds);
}

void GuidedCalibration::Implementation::wait_for_quiet(const RawFrame& raw) {
  quiet_.feed(raw, conditioned_.ratio);
  if (!quiet_.is_done()) return;
  unloaded_ = std::make_shared<const std::vector<RawFrame>>(quiet_.frames());
  recogniser_.emplace(TouchSense(quiet_.mean(), ratio_per_count(array_)), plan_.hold_time);
  recogniser_->expect(presses_.taxels());
  stage_ = GuideStage::pressing;
}

void GuidedCalibration::Implementation::follow_press(const RawFrame& raw, double seconds) {
  switch (recogniser_->feed(raw, conditioned_.ratio, seconds)) {
    case PressRecogniser::Event::none: break;
    case PressRecogniser::Event::held: keep_press(); break;
    case PressRecogniser::Event::released: ask_for_next(); break;
  }
}

void GuidedCalibration::Implementation::keep_press() {
  presses_.keep(recogniser_->keep_hold(plan_.frames_per_press()));
  const std::size_t due = fit_.presses + std::max<std::size_t>(1, fit_.presses / kFitsPerDoubling);
  if (presses_.kept().size() >= std::max(kPressesForFirstFit, due)) start_fit(false);
}

void GuidedCalibration::Implementation::ask_for_next() {
  ask_for_proof();
  if (!presses_.advance()) return start_last_fit();
  recogniser_->expect(presses_.taxels());
}

/// Presses after those of the plan. An unknown kind of circuit is found first: further presses may determine it.
void GuidedCalibration::Implementation::ask_for_proof() {
  if (presses_.has_open() || presses_.has_pairs() || array_.readout.circuit == Circuit::automatic) return;
  presses_.ask_for(proof_presses(array_, presses_.kept()));
}

void GuidedCalibration::Implementation::start_last_fit() {
  recogniser_->rest();
  if (presses_.kept().empty()) return fail("Every press was skipped: there is nothing to fit.");
  stage_ = GuideStage::fitting;
  fit_.share = 0.0;
  fit_.begin = std::chrono::steady_clock::now();
  start_fit(true);
}

void GuidedCalibration::Implementation::start_fit(bool is_last) {
  fit_.presses = presses_.kept().size();
  fitter_.fit({unloaded_, presses_.kept(), is_last});
}

void GuidedCalibration::Implementation::fail(std::string why) {
  stage_ = GuideStage::failed;
  fit_.failure = std::move(why);
}

void GuidedCalibration::Implementation::accept_fit(FitOutcome outcome) {
  const std::lock_guard lock(mutex_);
  if (outcome.error) fit_.error = outcome.error;
  fit_.unpressed_error = outcome.unpressed_error;
  if (!outcome.calibration) return;
  if (!*outcome.calibration) return fail(outcome.calibration->error().message);
  const std::vector<PressPair>& discriminating = outcome.calibration->value().report.discriminating_presses;
  if (!discriminating.empty() && !presses_.has_pairs()) {
    presses_.ask_for(discriminating);
    stage_ = GuideStage::pressing;
    return ask_for_next();
  }
  fit_.calibration = std::make_shared<const Calibration>(std::move(outcome.calibration->value()));
  stage_ = GuideStage::done;
}

void GuidedCalibration::Implementation::accept_share(double share) {
  const std::lock_guard lock(mutex_);
  fit_.share = std::max(fit_.share, share);
}

Status GuidedCalibration::Implementation::skip() {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::pressing) return bad_input("there is no press to skip");
  if (recogniser_->hint() != GuideHint::release) presses_.skip();
  ask_for_next();
  return Done{};
}

Status GuidedCalibration::Implementation::repeat() {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::pressing && stage_ != GuideStage::failed)
    return bad_input("there is no press to repeat now");
  if (presses_.kept().empty()) return bad_input("there is no press to repeat yet");
  presses_.repeat();
  fit_.presses = std::min(fit_.presses, presses_.kept().size());
  stage_ = GuideStage::pressing;
  recogniser_->expect(presses_.taxels());
  return Done{};
}

Status GuidedCalibration::Implementation::finish() {
  const std::lock_guard lock(mutex_);
  if (stage_ != GuideStage::pressing) return bad_input("there is nothing to finish");
  if (presses_.kept().empty()) return bad_input("there is no press yet");
  presses_.skip_rest();
  start_last_fit();
  return Done{};
}

GuideState GuidedCalibration::Implementation::state() const {
  const std::lock_guard lock(mutex_);
  GuideState state;
  state.stage = stage_;
  state.taxel = presses_.taxel();
  state.weight_n = presses_.weight_n();
  state.together_with = presses_.together_with();
  if (recogniser_) {
    state.hint = recogniser_->hint();
    state.reading = recogniser_->reading(0);
    if (state.together_with) state.together_reading = recogniser_->reading(1);
    state.hold_share = recogniser_->share(*last_time_);
  } else if (last_time_) {
    state.hold_share = quiet_.share(*last_time_);
  }
  if (stage_ == GuideStage::fitting) state.hold_share = fit_.share;
  if (stage_ == GuideStage::pressing) {
    state.pressed_taxel = recogniser_->pressed_taxel();
    state.missing_taxel = recogniser_->missing_taxel();
  }
  state.presses_done = presses_.kept().size();
  state.presses_total = presses_.count();
  state.median_relative_error = fit_.error;
  state.unpressed_relative_error = fit_.unpressed_error;
  state.taxel_presses.resize(array_.taxel_count());
  for (const auto& press : presses_.kept()) {
    ++state.taxel_presses[press->taxel];
    if (press->together_with) ++state.taxel_presses[*press->together_with];
  }
  state.message = message(state);
  return state;
}

std::string GuidedCalibration::Implementation::message(const GuideState& state) const {
  switch (stage_) {
    case GuideStage::none: break;
    case GuideStage::unloaded: return describe_quiet(quiet_.is_disturbed());
    case GuideStage::pressing: return describe_press(state, array_);
    case GuideStage::fitting: return describe_fitting(presses_.kept(), fit_.share, seconds_since(fit_.begin));
    case GuideStage::done: return describe_result(*fit_.calibration, state, presses_.kept());
    case GuideStage::failed: return fit_.failure;
  }
  return {};
}

std::shared_ptr<const Calibration> GuidedCalibration::Implementation::calibration() const {
  const std::lock_guard lock(mutex_);
  return fit_.calibration;
}

GuidedData GuidedCalibration::Implementation::data() const {
  const std::lock_guard lock(mutex_);
  if (!unloaded_) return {};
  return labelled_frames(array_, *unloaded_, presses_.kept());
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

}  // namespace dermis::learn::calibration
