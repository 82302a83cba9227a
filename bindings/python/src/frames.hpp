// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::python {

/// A frame with its shape, which numpy needs.
struct ShapedRaw {
  FrameShape shape;
  RawFrame frame;
};
struct ShapedForce {
  FrameShape shape;
  ForceFrame frame;
};

/// Frames side by side: what numpy wants to see. NaN stands for a temperature or a supply that is not there.
struct Recording {
  FrameShape shape;
  std::vector<std::int64_t> time_ns;        // [frames]
  std::vector<double> temperature_celsius;  // [frames]
  std::vector<double> supply_v;             // [frames]
  std::vector<float> counts;                // [frames, rows, cols]
  bytes::recordings::FrameNotes notes;
  std::size_t sensors = 0;            // of temperature
  std::vector<float> sensor_celsius;  // [frames, sensors]

  [[nodiscard]] std::size_t size() const { return time_ns.size(); }
  void append(const RawFrame& frame);
  void read(std::size_t index, RawFrame& frame) const;
  [[nodiscard]] std::vector<RawFrame> frames() const;
};

/// A Recording, or the path of a file of frames.
Recording recording_of(const py::object& object);

/// The data beside the counts of frames, as Python gives it: times or a rate, and one number a frame, one for all, or
/// None.
struct FrameSeries {
  py::object time_ns;
  std::optional<double> rate_hz;
  py::object temperature_celsius;
  py::object supply_v;
  py::object sensor_celsius = py::none();
};

/// Counts [frames, rows, cols] as a recording. `array`: whose shape they must have; null: any.
Recording recording_of(const py::object& counts, const ArrayDescription* array, const FrameSeries& beside);

/// The forces of many frames side by side.
struct Forces {
  Forces(const FrameShape& array_shape, std::size_t frames);
  void set(std::size_t index, const ForceFrame& frame);

  FrameShape shape;
  std::vector<std::int64_t> time_ns;  // [frames]
  std::vector<std::uint16_t> status;  // [frames], flags of FrameStatus
  std::vector<float> newtons;         // [frames, rows, cols]
  std::vector<float> sigma_newtons;   // [frames, rows, cols]
  std::vector<std::uint8_t> taxels;   // [frames, rows, cols], TaxelStatus
  std::vector<double> total;          // [frames]
  std::vector<double> total_sigma;    // [frames]
};

}  // namespace dermis::python
