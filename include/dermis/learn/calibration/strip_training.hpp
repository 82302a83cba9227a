// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "dermis/touch/contacts/strip_table.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// Learns the position of touches on a strip from touches at known positions. It is an isotonic regression of the
/// position on the centre of mass of the signals that `model` gives. `positions` by rising frame. Errors: an array that
/// is no strip, fewer than 16 positions with a contact, positions that do not rise with the centre of mass.
[[nodiscard]] Result<touch::contacts::StripTable> train_strip(const touch::pipeline::Model& model,
                                                              std::span<const RawFrame> frames,
                                                              std::span<const TouchPosition> positions);

}  // namespace dermis::learn::calibration
