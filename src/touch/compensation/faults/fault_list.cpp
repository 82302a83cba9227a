// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/fault_list.hpp"

#include <algorithm>

#include "touch/compensation/faults/masked_taxels.hpp"
#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {
namespace {

std::uint8_t cause_of(const LineFaultTraits& traits) {
  switch (traits.effect) {
    case LineFaultEffect::silent:
    case LineFaultEffect::supplied: return kLineCause[*traits.axis];
    case LineFaultEffect::shorted: return kPairCause;
    case LineFaultEffect::stuck:
    case LineFaultEffect::crossed:
    case LineFaultEffect::impossible: return kStuckCause;
    case LineFaultEffect::dead: return kDeadCause;
    case LineFaultEffect::drifting: break;
  }
  return 0;
}

}  // namespace

FaultList::FaultList(const ArrayDescription& array)
    : array_(array),
      lines_(array.rows, array.cols),
      causes_(array.taxel_count()),
      witnesses_{std::vector<float>(array.taxel_count(), 1.0F), std::vector<float>(array.taxel_count(), 1.0F)} {
  suspected_.reserve(array.taxel_count());
  faults_.reserve(3 * (array.rows + array.cols) + 2 * array.taxel_count());
}

void FaultList::add(const LineFault& fault) noexcept {
  if (faults_.size() == faults_.capacity()) return;
  if (traits_of(fault.kind).effect == LineFaultEffect::silent) forget_dead_taxels(fault);
  faults_.push_back(fault);
  mask_taxels();
  count_change();
}

/// A silent line explains the silence of its taxels.
void FaultList::forget_dead_taxels(const LineFault& line) noexcept {
  for_each_masked_taxel(line, array_, [&](std::size_t taxel) {
    std::erase_if(faults_, [&](const LineFault& fault) {
      return fault.kind == LineFaultKind::dead_taxel && fault.place == taxel;
    });
  });
}

void FaultList::remove(LineFaultKind kind, std::size_t place) noexcept {
  std::erase_if(faults_, [&](const LineFault& fault) { return fault.kind == kind && fault.place == place; });
  mask_taxels();
  count_change();
}

/// The taxels of lines that touch one line together.
void FaultList::mark_joined_lines() noexcept {
  if (!contains(LineFaultKind::shorted_crossing)) return;
  lines_.separate();
  for (const LineFault& fault : faults_) lines_.join(fault, array_);
  for (std::size_t taxel = 0; taxel < causes_.size(); ++taxel) {
    if (lines_.has_other_row(taxel / array_.cols) || lines_.has_other_column(taxel % array_.cols)) {
      causes_[taxel] |= kStuckCause;
    }
  }
}

void FaultList::mask_taxels() noexcept {
  std::fill(causes_.begin(), causes_.end(), std::uint8_t{0});
  for (const LineFault& fault : faults_) {
    const std::uint8_t cause = cause_of(traits_of(fault.kind));
    for_each_masked_taxel(fault, array_, [&](std::size_t taxel) { causes_[taxel] |= cause; });
  }
  mark_joined_lines();
  for (const Axis axis : kAxes) {
    const int own = kLineCause[axis] | kDeadCause;
    for (std::size_t taxel = 0; taxel < causes_.size(); ++taxel) {
      witnesses_[axis][taxel] = (causes_[taxel] & ~own) == 0 ? 1.0F : 0.0F;
    }
  }
  // A column held by a row reads next to nothing of its other taxels; at virtual ground the row does.
  const Axis axis = sharing_axis(array_).value_or(Axis::column);
  for (const std::size_t taxel : suspected_) {
    const std::size_t line = line_of(array_, axis, taxel);
    for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
      for (const Axis witnessed : kAxes) witnesses_[witnessed][taxel_on_line(array_, axis, line, k)] = 0.0F;
    }
  }
}

}  // namespace dermis::touch::compensation
