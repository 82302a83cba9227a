// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/fleet/robot_health.hpp"
#include "dermis/health/ageing_monitor.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/messages/live_messages.hpp"
#include "dermis/pipeline/model.hpp"

/// The state of an array at work, in the words of messages.
namespace dermis::serve {

[[nodiscard]] messages::ArrayStatistics statistics_message(const std::string& array,
                                                           const live::ArrayStatistics& statistics);

/// The worst that is wrong with the array, the faults of its lines and taxels, and how its gains have aged.
[[nodiscard]] messages::Diagnosis diagnosis_message(const std::string& array, const pipeline::Model& model,
                                                    const live::ArrayStatistics& statistics,
                                                    const health::AgeingEvidence& ageing = {});

/// The same for a fleet: all that these tell of an array.
void fill_in(fleet::ArrayHealth& array, const pipeline::Model& model, const live::ArrayStatistics& statistics,
             const health::AgeingEvidence& ageing);

}  // namespace dermis::serve
