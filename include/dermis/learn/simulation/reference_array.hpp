// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::learn::simulation {

/// The array of examples/chest, of any size: conductive rubber, drivers of 20 ohm, a load of 200 ohm a column, 5 V.
[[nodiscard]] ArrayDescription reference_array(FrameShape shape = {16, 16});

}  // namespace dermis::learn::simulation
