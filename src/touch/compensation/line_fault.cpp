// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/line_fault.hpp"

#include <array>

namespace dermis::touch::compensation {
namespace {

using Effect = LineFaultEffect;
using Scope = LineFaultScope;

// In the order of LineFaultKind. The readings of a supplied row can be subtracted; a dead taxel conducts nothing.
constexpr std::array<LineFaultTraits, 11> kTraits{{
    {"silent_row", Effect::silent, Scope::line, Axis::row, true},
    {"silent_column", Effect::silent, Scope::line, Axis::column, true},
    {"supplied_row", Effect::supplied, Scope::line, Axis::row, false},
    {"supplied_column", Effect::supplied, Scope::line, Axis::column, true},
    {"shorted_rows", Effect::shorted, Scope::line_pair, Axis::row, false},
    {"shorted_columns", Effect::shorted, Scope::line_pair, Axis::column, false},
    {"stuck_taxel", Effect::stuck, Scope::taxel, {}, true},
    {"dead_taxel", Effect::dead, Scope::taxel, {}, false},
    {"shorted_crossing", Effect::crossed, Scope::taxel, {}, true},
    {"impossible_reading", Effect::impossible, Scope::taxel, {}, true},
    {"drifting_driver", Effect::drifting, Scope::driver, {}, false},
}};

}  // namespace

const LineFaultTraits& traits_of(LineFaultKind kind) noexcept {
  return kTraits[static_cast<std::size_t>(kind)];
}

const char* to_string(LineFaultKind kind) noexcept {
  return traits_of(kind).name;
}

std::string place_name(const LineFault& fault, const ArrayDescription& array) {
  const LineFaultTraits& traits = traits_of(fault.kind);
  const std::string line = std::to_string(fault.place);
  switch (traits.scope) {
    case Scope::line: return std::string(to_string(*traits.axis)) + " " + line;
    case Scope::line_pair:
      return std::string(to_string(*traits.axis)) + "s " + line + " and " + std::to_string(fault.place + 1);
    case Scope::taxel: return "taxel " + array.taxel_name(fault.place);
    case Scope::driver: break;
  }
  return std::string("driver of ") + to_string(driven_axis(array)) + " " + line;
}

bool silences_row(const LineFault& fault, const ArrayDescription& array) noexcept {
  return fault.kind == LineFaultKind::shorted_crossing && array.readout.circuit == Circuit::transimpedance;
}

std::size_t masked_taxel_count(const LineFault& fault, const ArrayDescription& array) noexcept {
  const LineFaultTraits& traits = traits_of(fault.kind);
  switch (traits.scope) {
    case Scope::line: return line_length(array, *traits.axis);
    case Scope::line_pair: return 2 * line_length(array, *traits.axis);
    case Scope::taxel: return silences_row(fault, array) ? array.cols : 1;
    case Scope::driver: break;
  }
  return 0;
}

}  // namespace dermis::touch::compensation
