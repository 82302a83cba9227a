// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <initializer_list>
#include <string>

namespace dermis::messages {

/// A type that others use: its name without "msg/", and its fields.
struct Dependency {
  const char* name;
  const char* fields;
};

/// A "ros2msg": the fields, and after a line of 80 '=' those of each type that they use.
[[nodiscard]] inline std::string with_dependencies(const char* fields, std::initializer_list<Dependency> dependencies) {
  std::string definition = fields;
  for (const Dependency& dependency : dependencies) {
    definition.append(80, '=').append("\nMSG: ").append(dependency.name).append("\n").append(dependency.fields);
  }
  return definition;
}

inline constexpr Dependency kTimeType{"builtin_interfaces/Time", R"(int32 sec
uint32 nanosec
)"};

inline constexpr Dependency kHeaderType{"std_msgs/Header", R"(builtin_interfaces/Time stamp
string frame_id
)"};

inline constexpr Dependency kPoseType{"geometry_msgs/Pose", R"(geometry_msgs/Point position
geometry_msgs/Quaternion orientation
)"};

inline constexpr Dependency kPointType{"geometry_msgs/Point", R"(float64 x
float64 y
float64 z
)"};

inline constexpr Dependency kVector3Type{"geometry_msgs/Vector3", kPointType.fields};

inline constexpr Dependency kQuaternionType{"geometry_msgs/Quaternion", R"(float64 x
float64 y
float64 z
float64 w
)"};

}  // namespace dermis::messages
