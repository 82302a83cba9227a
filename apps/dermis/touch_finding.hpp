// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/recognition/examples.hpp"
#include "dermis/recognition/touch_finder.hpp"

namespace dermis::app {

/// Prints how well the limits find the labels in the stream, and how many others a minute where its rate is known.
void print_finding(const recognition::LabelledFrames& data, const recognition::TouchLimits& limits);

}  // namespace dermis::app
