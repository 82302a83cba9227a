// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/line_faults.hpp"

#include <tuple>

#include "touch/compensation/faults/dead_taxel_detector.hpp"
#include "touch/compensation/faults/drifting_driver_detector.hpp"
#include "touch/compensation/faults/equal_presses.hpp"
#include "touch/compensation/faults/grounded_line_detector.hpp"
#include "touch/compensation/faults/impossible_reading_detector.hpp"
#include "touch/compensation/faults/shorted_line_detector.hpp"
#include "touch/compensation/faults/silent_line_detector.hpp"
#include "touch/compensation/faults/stuck_taxel_detector.hpp"
#include "touch/compensation/faults/supplied_column_detector.hpp"
#include "touch/compensation/faults/supplied_row_detector.hpp"
#include "touch/compensation/faults/unloaded_witnesses.hpp"

namespace dermis::touch::compensation {

class LineFaultMonitor::Implementation {
 public:
  Implementation(const ArrayDescription& array, std::span<const double> unloaded_siemens)
      : array_(array), unloaded_(array_, unloaded_siemens), sums_(array_), faults_(array_) {}

  bool observe(const ConditionedFrame& conditioned, const ConductanceFrame& conductance) noexcept {
    const std::size_t frame = frame_++;
    if (has(conditioned.status, FrameStatus::rejected | FrameStatus::supply_implausible)) return false;
    const bool solved = !has(conductance.status, FrameStatus::not_converged);
    sums_.sum(conditioned, conductance, solved);
    unloaded_.expect(conditioned, sums_, frame, solved);
    const Observation seen{conditioned, conductance, sums_, unloaded_, witnesses_, frame, solved};
    const std::size_t changes = faults_.changes();
    std::apply([&](auto&... detector) { (detector.judge(seen, faults_), ...); }, detectors_);
    return faults_.changes() != changes;
  }

  [[nodiscard]] std::span<const LineFault> faults() const noexcept { return faults_.all(); }

  [[nodiscard]] std::vector<LineFault> suspicions() const {
    std::vector<LineFault> suspicions;
    std::get<ShortedLineDetector>(detectors_).suspect(faults_, suspicions);
    std::get<SuppliedRowDetector>(detectors_).suspect(faults_, suspicions);
    return suspicions;
  }

  [[nodiscard]] bool sees_silent(Axis axis, std::size_t line) const noexcept {
    return std::get<SilentLineDetector>(detectors_).sees(axis, line);
  }

 private:
  ArrayDescription array_;
  UnloadedTaxels unloaded_;
  LineSums sums_;
  FaultList faults_;
  UnloadedWitnesses witnesses_;
  EqualPresses equal_presses_;
  // In the order in which they judge a frame; each sees what those before it have found.
  std::tuple<ImpossibleReadingDetector, SilentLineDetector, SuppliedColumnDetector, StuckTaxelDetector,
             DeadTaxelDetector, ShortedLineDetector, SuppliedRowDetector, GroundedLineDetector, DriftingDriverDetector>
      detectors_{ImpossibleReadingDetector(array_),
                 SilentLineDetector(array_, unloaded_, witnesses_),
                 SuppliedColumnDetector(array_),
                 StuckTaxelDetector(array_),
                 DeadTaxelDetector(array_),
                 ShortedLineDetector(array_, equal_presses_),
                 SuppliedRowDetector(array_, equal_presses_),
                 GroundedLineDetector(array_),
                 DriftingDriverDetector(array_)};
  std::size_t frame_ = 0;
};

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

std::vector<LineFault> LineFaultMonitor::suspicions() const {
  return implementation_->suspicions();
}

bool LineFaultMonitor::sees_silent_row(std::size_t row) const noexcept {
  return implementation_->sees_silent(Axis::row, row);
}

bool LineFaultMonitor::sees_silent_column(std::size_t col) const noexcept {
  return implementation_->sees_silent(Axis::column, col);
}

}  // namespace dermis::touch::compensation
