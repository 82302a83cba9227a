// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <string>

#include "dermis/messages/ros_messages.hpp"
#include "messages/definition.hpp"

namespace dermis::messages {
namespace {

constexpr const char* kImage = R"(std_msgs/Header header
uint32 height    # rows of taxels
uint32 width     # columns of taxels
string encoding  # 16UC1 or 32FC1: counts of the ADC
uint8 is_bigendian
uint32 step      # bytes of a row
uint8[] data     # row by row
)";

constexpr const char* kTemperature = R"(std_msgs/Header header
float64 temperature  # degrees Celsius
float64 variance     # 0: unknown
)";

constexpr const char* kGrid = R"(builtin_interfaces/Time timestamp
string frame_id
geometry_msgs/Pose pose            # of the corner of the grid
uint32 column_count
foxglove_msgs/Vector2 cell_size    # metres
uint32 row_stride                  # bytes
uint32 cell_stride                 # bytes
foxglove_msgs/PackedElementField[] fields
uint8[] data                       # row by row
)";

constexpr const char* kVector2 = R"(float64 x
float64 y
)";

constexpr const char* kPackedElementField = R"(uint8 UNKNOWN=0
uint8 UINT8=1
uint8 INT8=2
uint8 UINT16=3
uint8 INT16=4
uint8 UINT32=5
uint8 INT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset  # bytes from the beginning of the cell
uint8 type
)";

constexpr const char* kAcquisition = R"(int64 time_ns  # when the frame was taken
bool has_sequence
uint64 sequence  # the device's number of the frame
bool has_device_time
int64 device_time_ns  # the device's clock
int64 arrival_steady_ns  # the host's steady clock when the frame had come
int64 arrival_utc_ns  # the host's UTC clock at that moment, since 1970
uint32 lost_before  # frames known to be lost before this one
uint32 held_taxels  # taxels that the device did not send
bool has_supply_v
float64 supply_v  # measured supply, volts
)";

constexpr const char* kFrameStatus = R"(uint8 REJECTED=1
uint8 SATURATED=2
uint8 ABOVE_RANGE=4
uint8 DEAD_TAXELS=8
uint8 TEMPERATURE_UNKNOWN=16
uint8 TEMPERATURE_CLAMPED=32
uint8 NOT_CONVERGED=64
uint8 LINE_FAULT=128
int64 time_ns  # of the frame of forces
uint8 status   # flags; 0: all is well
)";

}  // namespace

const MessageType& image_type() {
  static const MessageType kType{"sensor_msgs/msg/Image", with_dependencies(kImage, {kHeaderType, kTimeType})};
  return kType;
}

const MessageType& temperature_type() {
  static const MessageType kType{"sensor_msgs/msg/Temperature",
                                 with_dependencies(kTemperature, {kHeaderType, kTimeType})};
  return kType;
}

const MessageType& grid_type() {
  static const MessageType kType{"foxglove_msgs/msg/Grid",
                                 with_dependencies(kGrid, {kTimeType,
                                                           kPoseType,
                                                           kPointType,
                                                           kQuaternionType,
                                                           {"foxglove_msgs/Vector2", kVector2},
                                                           {"foxglove_msgs/PackedElementField", kPackedElementField}})};
  return kType;
}

const MessageType& acquisition_type() {
  static const MessageType kType{"dermis_msgs/msg/Acquisition", kAcquisition};
  return kType;
}

const MessageType& frame_status_type() {
  static const MessageType kType{"dermis_msgs/msg/FrameStatus", kFrameStatus};
  return kType;
}

}  // namespace dermis::messages
