// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/compensation/crosstalk.hpp"

#include <algorithm>

#include "compensation/grounded_divider.hpp"
#include "compensation/proportional.hpp"
#include "compensation/virtual_ground.hpp"

namespace dermis::compensation {

Result<std::unique_ptr<CrosstalkInversion>> make_crosstalk_inversion(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  switch (readout.circuit) {
    case Circuit::divider:
      if (readout.idle_rows == IdleRows::floating) {
        return bad_input(
            "readout.idle_rows = \"floating\" with a divider cannot be inverted yet: ground the idle rows, or set "
            "circuit = \"none\"");
      }
      return std::unique_ptr<CrosstalkInversion>(std::make_unique<GroundedDivider>(array));
    case Circuit::transimpedance: return std::unique_ptr<CrosstalkInversion>(std::make_unique<VirtualGround>(array));
    case Circuit::none: return std::unique_ptr<CrosstalkInversion>(std::make_unique<Proportional>());
  }
  return bad_input("readout.circuit: unknown");
}

Result<Compensator> Compensator::create(const ArrayDescription& array) {
  Result<std::unique_ptr<CrosstalkInversion>> inversion = make_crosstalk_inversion(array);
  if (!inversion) return inversion.error();
  return Compensator(std::move(*inversion));
}

void Compensator::process(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept {
  conductance.time = conditioned.time;
  conductance.status = conditioned.status;
  conductance.temperature_celsius = conditioned.temperature_celsius;
  conductance.taxels = conditioned.taxels;
  conductance.siemens.resize(conditioned.ratio.size());
  if (has(conditioned.status, FrameStatus::rejected)) {
    std::fill(conductance.siemens.begin(), conductance.siemens.end(), 0.0);
    return;
  }
  if (inversion_->invert(conditioned.ratio, conductance.siemens)) return;
  conductance.status |= FrameStatus::not_converged;
  std::fill(conductance.taxels.begin(), conductance.taxels.end(), TaxelStatus::invalid);
}

}  // namespace dermis::compensation
