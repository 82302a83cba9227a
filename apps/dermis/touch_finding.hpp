// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/learn/recognition/examples.hpp"
#include "dermis/learn/recognition/touch_finder.hpp"

namespace dermis::app {

/// Prints how well the limits find the labels in the stream, and how many others a minute where its rate is known.
void print_finding(const learn::recognition::LabelledFrames& data, const learn::recognition::TouchLimits& limits);

}  // namespace dermis::app
