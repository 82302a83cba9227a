// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/learn/health/ageing_monitor.hpp"
#include "dermis/live/fleet/robot_health.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/touch/pipeline/model.hpp"

/// The state of an array at work, in the words of messages.
namespace dermis::out::serve {

[[nodiscard]] bytes::ros_messages::ArrayStatistics statistics_message(const std::string& array,
                                                                      const live::suits::ArrayStatistics& statistics);

/// The worst that is wrong with the array, the faults of its lines and taxels, and how its gains have aged.
[[nodiscard]] bytes::ros_messages::Diagnosis diagnosis_message(const std::string& array,
                                                               const touch::pipeline::Model& model,
                                                               const live::suits::ArrayStatistics& statistics,
                                                               const learn::health::AgeingEvidence& ageing = {});

/// The same for a fleet: all that these tell of an array.
void fill_in(live::fleet::ArrayHealth& array, const touch::pipeline::Model& model,
             const live::suits::ArrayStatistics& statistics, const learn::health::AgeingEvidence& ageing);

}  // namespace dermis::out::serve
