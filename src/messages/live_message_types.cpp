// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <string>

#include "dermis/messages/live_messages.hpp"
#include "messages/definition.hpp"

namespace dermis::messages {
namespace {

constexpr const char* kPointCloud = R"(std_msgs/Header header
uint32 height
uint32 width         # taxels
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step    # bytes of a point
uint32 row_step      # bytes of all
uint8[] data
bool is_dense
)";

constexpr const char* kPointField = R"(uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset  # bytes from the beginning of the point
uint8 datatype
uint32 count
)";

constexpr const char* kContacts = R"(std_msgs/Header header  # time of the frame; frame of the suit
string array            # whose frame it is
float64 total_force_n
float64 sigma_total_n
bool has_centre_of_pressure
geometry_msgs/Point centre_of_pressure  # in the suit's frame, metres
dermis_msgs/Contact[] contacts          # of this array
)";

constexpr const char* kContact = R"(uint8 ONSET=0
uint8 HELD=1
uint8 RELEASE=2
uint32 id  # of this array
uint8 phase
builtin_interfaces/Time onset
float64 x  # in the plane of the array: r0c0 is the origin, x along the columns, y along the rows, metres
float64 y
float64 sigma_x
float64 sigma_y
float64 velocity_x  # metres per second
float64 velocity_y
float64 force_n
float64 sigma_force_n
float64 area_m2
float64 peak_pressure_pa
float64 mean_pressure_pa
float64 major_axis_m
float64 minor_axis_m
float64 angle_rad
uint32 taxels
geometry_msgs/Point position    # in the suit's frame, metres
geometry_msgs/Vector3 normal
geometry_msgs/Vector3 velocity  # in the suit's frame, metres per second
)";

constexpr const char* kStatistics = R"(std_msgs/Header header
dermis_msgs/ArrayStatistics[] arrays
bool recording
string recording_file
uint64 recording_frames
uint32 clients
uint64 client_drops  # messages that slow clients did not get
)";

constexpr const char* kArrayStatistics = R"(string name
bool ended
string error
uint64 frames
uint64 rejected
uint64 lost
uint64 damaged
float64 rate_hz
float64 jitter_s
float64 latency_p50_s  # from the last byte of a frame to its contacts
float64 latency_p99_s
float64 temperature_celsius  # NaN: not known
float64 supply_v  # NaN: not known
)";

constexpr const char* kCalibrationState = R"(uint8 NONE=0
uint8 UNLOADED=1
uint8 PRESSING=2
uint8 FITTING=3
uint8 DONE=4
uint8 FAILED=5
std_msgs/Header header
string array
uint8 stage
string message  # what to do now, or what went wrong
uint32 taxel  # to be pressed, row-major
float64 weight_n  # with
float64 reading  # of that taxel now, relative to unloaded: 1 unloaded, rising
float64 hold_share  # of the hold that is done, 0 to 1
uint32 presses_done
uint32 presses_total
float64 median_relative_error  # of the fit so far on presses it did not see; NaN: too few
uint8[] taxel_presses  # good presses of each taxel so far
uint8 hint  # 0 none, 1 press, 2 hold still, 3 release, 4 another taxel is pressed, 5 not steady, 6 too short, 7 two pressed
uint32 pressed_taxel  # that feels most now; 4294967295: none
float64 unpressed_relative_error  # of the fit so far on taxels of which it saw no press; NaN: unknown
)";

constexpr const char* kDiagnostics = R"(std_msgs/Header header
diagnostic_msgs/DiagnosticStatus[] status
)";

constexpr const char* kDiagnosticStatus = R"(byte OK=0
byte WARN=1
byte ERROR=2
byte STALE=3
byte level
string name
string message
string hardware_id
diagnostic_msgs/KeyValue[] values
)";

constexpr const char* kKeyValue = R"(string key
string value
)";

constexpr const char* kTransforms = R"(geometry_msgs/TransformStamped[] transforms
)";

constexpr const char* kTransformStamped = R"(std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
)";

constexpr const char* kTransform = R"(geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
)";

}  // namespace

const MessageType& point_cloud_type() {
  static const MessageType kType{
      "sensor_msgs/msg/PointCloud2",
      with_dependencies(kPointCloud, {kHeaderType, kTimeType, {"sensor_msgs/PointField", kPointField}})};
  return kType;
}

const MessageType& contacts_type() {
  static const MessageType kType{
      "dermis_msgs/msg/Contacts",
      with_dependencies(kContacts,
                        {kHeaderType, kTimeType, kPointType, kVector3Type, {"dermis_msgs/Contact", kContact}})};
  return kType;
}

const MessageType& statistics_type() {
  static const MessageType kType{
      "dermis_msgs/msg/Statistics",
      with_dependencies(kStatistics, {kHeaderType, kTimeType, {"dermis_msgs/ArrayStatistics", kArrayStatistics}})};
  return kType;
}

const MessageType& calibration_state_type() {
  static const MessageType kType{"dermis_msgs/msg/CalibrationState",
                                 with_dependencies(kCalibrationState, {kHeaderType, kTimeType})};
  return kType;
}

const MessageType& diagnostics_type() {
  static const MessageType kType{
      "diagnostic_msgs/msg/DiagnosticArray",
      with_dependencies(kDiagnostics, {kHeaderType,
                                       kTimeType,
                                       {"diagnostic_msgs/DiagnosticStatus", kDiagnosticStatus},
                                       {"diagnostic_msgs/KeyValue", kKeyValue}})};
  return kType;
}

const MessageType& transforms_type() {
  static const MessageType kType{"tf2_msgs/msg/TFMessage",
                                 with_dependencies(kTransforms, {{"geometry_msgs/TransformStamped", kTransformStamped},
                                                                 kHeaderType,
                                                                 kTimeType,
                                                                 {"geometry_msgs/Transform", kTransform},
                                                                 kVector3Type,
                                                                 kQuaternionType})};
  return kType;
}

}  // namespace dermis::messages
