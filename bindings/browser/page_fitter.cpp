// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// GuideFitter for the page that the module is part of. A fit runs in a second worker, in a copy of this module and of
// its whole memory. So the job is there as it is here. The outcome comes back as bytes.
#include <optional>
#include <utility>

#include "bindings/browser/fit_link.hpp"
#include "bindings/browser/outcome_bytes.hpp"
#include "learn/calibration/guided/guide_fitter.hpp"
#include "out/serve/calibration/end_apart.hpp"

#define DERMIS_IMPORT(name) __attribute__((import_module("fits"), import_name(#name)))

extern "C" {
/// The page copies this module now, and calls dermis_fit() there.
DERMIS_IMPORT(begin) void begin_fit();
/// It forgets the copy.
DERMIS_IMPORT(end) void end_fit();
/// Called in the copy, for dermis_fit_share() here.
DERMIS_IMPORT(tell_share) void tell_fit_share(double share);
}

namespace dermis {
namespace browser {
namespace {

FitLink* made_last = nullptr;

}  // namespace

FitLink* fit_link() noexcept {
  return made_last;
}

}  // namespace browser

namespace learn::calibration {

class GuideFitter::Implementation final : public browser::FitLink {
 public:
  Implementation(ArrayDescription array, std::function<void(FitOutcome)> on_outcome,
                 std::function<void(double)> on_progress)
      : array_(std::move(array)), on_outcome_(std::move(on_outcome)), on_progress_(std::move(on_progress)) {
    browser::made_last = this;
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() override {
    if (running_) end_fit();
    if (browser::made_last == this) browser::made_last = nullptr;
  }

  void fit(FitJob job) {
    waiting_ = std::move(job);
    if (!running_) begin();
  }

  [[nodiscard]] std::string run() override {
    return browser::outcome_to_bytes(fit_presses(array_, *running_, tell_fit_share));
  }
  void accept(std::string_view outcome) override;
  void accept_share(double share) override {
    if (running_ && running_->is_last) on_progress_(share);
  }
  void fail(std::string_view why) override;

 private:
  void begin() {
    running_ = std::exchange(waiting_, std::nullopt);
    if (running_) begin_fit();
  }
  /// It may lead to the next job.
  void finish(FitOutcome outcome) {
    running_.reset();
    on_outcome_(std::move(outcome));
    if (!running_) begin();
  }

  const ArrayDescription array_;
  const std::function<void(FitOutcome)> on_outcome_;
  const std::function<void(double)> on_progress_;
  std::optional<FitJob> running_;
  std::optional<FitJob> waiting_;
};

void GuideFitter::Implementation::accept(std::string_view outcome) {
  if (!running_) return;
  Result<FitOutcome> accepted = browser::outcome_from_bytes(outcome);
  if (!accepted) return fail(accepted.error().message);
  finish(*std::move(accepted));
}

void GuideFitter::Implementation::fail(std::string_view why) {
  if (!running_) return;
  FitOutcome outcome;
  if (running_->is_last) outcome.calibration = failed("The fit was not done: " + std::string(why) + ".");
  finish(std::move(outcome));
}

GuideFitter::GuideFitter(ArrayDescription array, std::function<void(FitOutcome)> on_outcome,
                         std::function<void(double)> on_progress)
    : implementation_(
          std::make_unique<Implementation>(std::move(array), std::move(on_outcome), std::move(on_progress))) {}

GuideFitter::~GuideFitter() = default;

void GuideFitter::fit(FitJob job) {
  implementation_->fit(std::move(job));
}

}  // namespace learn::calibration

/// Its end does not wait here.
std::shared_ptr<void> out::serve::end_apart(std::shared_ptr<learn::calibration::GuidedCalibration> /*calibration*/) {
  return nullptr;
}

}  // namespace dermis
