// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Frames as ROS 2 messages, in CDR. encode_...() replace the content of `message`, and allocate nothing once it has
/// its size. decode_...() accept any bytes. Their errors name the problem, but no place.
namespace dermis::bytes::ros_messages {

/// A type of message: its name and its definition as "ros2msg". The definition holds the fields, and after a line of 80
/// '=' those of each type that they use.
struct MessageType {
  const char* name;  ///< "sensor_msgs/msg/Image"
  std::string definition;
  const char* hash;  ///< "RIHS01_...", by which nodes of ROS 2 see that they mean the same type (REP 2016).
};

[[nodiscard]] const MessageType& image_type();
[[nodiscard]] const MessageType& temperature_type();
[[nodiscard]] const MessageType& grid_type();
[[nodiscard]] const MessageType& acquisition_type();
[[nodiscard]] const MessageType& frame_status_type();
[[nodiscard]] const MessageType& raw_frame_type();
[[nodiscard]] const MessageType& mark_type();

/// sensor_msgs/msg/Image of frame.counts, stamped with frame.time: "16UC1" if all counts are whole numbers of 0 ...
/// 65535, else "32FC1". Reads back with the same bits.
void encode_image(const RawFrame& frame, const FrameShape& shape, std::string_view frame_id,
                  std::vector<std::uint8_t>& message);
/// One value of each taxel, such as newtons, as an image "32FC1".
void encode_value_image(std::span<const float> values, Nanos time, const FrameShape& shape, std::string_view frame_id,
                        std::vector<std::uint8_t>& message);
/// Sets counts, and time to the stamp. Accepts the encodings of one channel: mono8, mono16, 8UC1, 8SC1, 16UC1, 16SC1,
/// 32SC1, 32FC1 and 64FC1, with 1x1 ... 1024x1024 taxels, in either byte order.
[[nodiscard]] Result<FrameShape> decode_image(std::span<const std::uint8_t> message, RawFrame& frame);

/// The text of a std_msgs/msg/String, which stays in the message.
[[nodiscard]] Result<std::string_view> decode_text(std::span<const std::uint8_t> message);

/// dermis_msgs/msg/Mark: a moment with a name. Texts hold no NUL.
struct Mark {
  Nanos time{};
  std::string label{};  ///< Lasts until the next mark; empty: the label before it ends.
  std::string by{};     ///< Who set it.
  std::string event{};  ///< Empty: a mark of a person. "tare": the server tells of a zero.

  bool operator==(const Mark&) const = default;
};
void encode_mark(const Mark& mark, std::string_view frame_id, std::vector<std::uint8_t>& message);
[[nodiscard]] Result<Mark> decode_mark(std::span<const std::uint8_t> message);

/// tactile_msgs/msg/TactileState, as other robots have it: the values of sensors. Those of as many values each are the
/// rows; else all values are one row. Sets counts, and time to the stamp. Accepts 1x1 ... 1024x1024 values.
inline constexpr const char* kTactileState = "tactile_msgs/msg/TactileState";
[[nodiscard]] Result<FrameShape> decode_tactile_state(std::span<const std::uint8_t> message, RawFrame& frame);

/// sensor_msgs/msg/JointState, as other robots have it: a number for each joint. They are the positions of the joints
/// or, where the message has none, their velocities or efforts. Names without any number are no joints.
inline constexpr const char* kJointState = "sensor_msgs/msg/JointState";
struct JointNumbers {
  std::vector<std::string> names;
  std::vector<double> numbers;  ///< Of each name.
};
[[nodiscard]] Status decode_joint_state(std::span<const std::uint8_t> message, JointNumbers& joints);

/// sensor_msgs/msg/Temperature [C]; the variance is given as 0, unknown.
void encode_temperature(double celsius, Nanos time, std::string_view frame_id, std::vector<std::uint8_t>& message);
[[nodiscard]] Result<double> decode_temperature(std::span<const std::uint8_t> message);

/// dermis_msgs/msg/Acquisition: frame.acquisition, frame.time and frame.supply_v, without loss.
void encode_acquisition(const RawFrame& frame, std::vector<std::uint8_t>& message);
/// Sets those fields.
[[nodiscard]] Status decode_acquisition(std::span<const std::uint8_t> message, RawFrame& frame);

/// dermis_msgs/msg/RawFrame: all of a frame, without loss.
void encode_raw_frame(const RawFrame& frame, const FrameShape& shape, std::string_view frame_id,
                      std::vector<std::uint8_t>& message);
/// Sets all of the frame. Accepts 1x1 ... 1024x1024 taxels, and up to 64 temperatures or one of each taxel.
[[nodiscard]] Result<FrameShape> decode_raw_frame(std::span<const std::uint8_t> message, RawFrame& frame);

/// Distance between neighbouring taxels [m].
struct Pitch {
  double row_m = 0.010;
  double col_m = 0.010;
};

/// foxglove_msgs/msg/Grid with newtons and sigma_newtons (float32) and status (uint8, TaxelStatus) of each taxel. r0c0
/// is at the origin of `frame_id`, with columns along x and rows along y.
void encode_grid(const ForceFrame& frame, const FrameShape& shape, const Pitch& pitch, std::string_view frame_id,
                 std::vector<std::uint8_t>& message);
/// Sets time, newtons, sigma_newtons and taxels, with the bits that encode_grid() took. Accepts its fields alone, of
/// 1x1 ... 1024x1024 taxels.
[[nodiscard]] Result<FrameShape> decode_grid(std::span<const std::uint8_t> message, ForceFrame& frame);

/// dermis_msgs/msg/FrameStatus: the time and the status of a frame of forces.
void encode_frame_status(const ForceFrame& frame, std::vector<std::uint8_t>& message);

}  // namespace dermis::bytes::ros_messages
