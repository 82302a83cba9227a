// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

/// Contacts of an array, in its plane. The origin is the centre of taxel r0c0. x runs along the columns (x = col *
/// col_pitch_m), y along the rows (y = row * row_pitch_m).
namespace dermis {

/// A point or a direction in the plane of an array [m].
struct PlaneVector {
  double x = 0.0;
  double y = 0.0;

  bool operator==(const PlaneVector&) const = default;
};

/// The life of a contact. Each contact is reported once with `onset` and once, the last time, with `release`.
enum class ContactPhase : std::uint8_t { onset, held, release };

/// One stressed area, or one of several that were separated in it.
struct Contact {
  std::uint32_t id = 0;  ///< From 1 on; the same from onset to release, never used again by the same tracker.
  ContactPhase phase = ContactPhase::onset;
  Nanos onset{};                   ///< Time of the frame in which it was found.
  PlaneVector position{};          ///< Centre of the pressed patch [m].
  PlaneVector sigma_position_m{};  ///< Standard deviation of both [m], > 0.
  PlaneVector velocity{};          ///< Velocity of the position [m/s]; 0 at onset.
  double force_n = 0.0;            ///< Sum of the forces on its taxels [N], >= 0, without what presses between taxels.
  double sigma_force_n = 0.0;      ///< Its standard deviation [N], > 0; infinite where a taxel is saturated.
  double area_m2 = 0.0;            ///< Area of the pressed patch [m2], > 0.
  double peak_pressure_pa = 0.0;   ///< Highest pressure on a taxel [Pa].
  double mean_pressure_pa = 0.0;   ///< force_n over the area of its taxels [Pa].
  double major_axis_m = 0.0;       ///< Standard deviation of the pressure along its longest axis [m],
  double minor_axis_m = 0.0;       ///< and across it; major >= minor >= 0.
  double angle_rad = 0.0;          ///< Angle of the longest axis against x, -pi/2 < angle <= pi/2.
  std::uint32_t taxels = 0;        ///< Number of taxels in it, >= 1.

  bool operator==(const Contact&) const = default;
};

/// Unit 4 -> the robot: what touches an array in one frame.
struct ContactReport {
  Nanos time{};
  FrameStatus status = FrameStatus::ok;
  std::vector<Contact> contacts;                    ///< By id, rising.
  double total_force_n = 0.0;                       ///< Over all contacts [N].
  double sigma_total_n = 0.0;                       ///< Its standard deviation [N].
  std::optional<PlaneVector> centre_of_pressure{};  ///< Centre of all contacts; empty where there is none.

  bool operator==(const ContactReport&) const = default;
};

}  // namespace dermis
