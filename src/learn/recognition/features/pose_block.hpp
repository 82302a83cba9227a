// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "learn/recognition/features/feature_group.hpp"
#include "learn/recognition/features/image_analysis.hpp"

namespace dermis::learn::recognition {

inline constexpr FeatureGroup kPoseGroup{"centre and direction", FeatureAspect::place, 4};

/// Where on the array the contact is, along its rows and columns, and its direction: (1 - minor/major) (cos 2 angle,
/// sin 2 angle). The direction counts more the longer the contact is.
void write_pose(const ImageAnalysis& analysis, std::span<double> out);

}  // namespace dermis::learn::recognition
