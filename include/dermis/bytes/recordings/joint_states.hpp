// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Joints of a robot in an MCAP recording, as ROS 2 records them beside frames.
namespace dermis::bytes::recordings {

/// The topics of sensor_msgs/msg/JointState in CDR. A recording without index is read to its end.
[[nodiscard]] Result<std::vector<std::string>> joint_topics(const std::string& path);

/// Calls `take` with every message of a topic, in the order of the file, and its log time.
[[nodiscard]] Status read_joint_states(const std::string& path, const std::string& topic,
                                       const std::function<void(Nanos, const ros_messages::JointNumbers&)>& take);

}  // namespace dermis::bytes::recordings
