// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::ros_messages {

/// foxglove_msgs/PackedElementField.
enum class PackedElementType : std::uint8_t { unknown, uint8, int8, uint16, int16, uint32, int32, float32, float64 };

/// foxglove_msgs/PackedElementField of a cell.
struct GridField {
  const char* name;
  std::uint32_t offset;
  PackedElementType type;
};

/// The cell of a grid of forces or conductances: a float32, its standard deviation as float32, its status as uint8.
inline constexpr std::size_t kSigmaOffset = 4;
inline constexpr std::size_t kCellStatusOffset = 8;
inline constexpr std::size_t kCellBytes = 9;

/// The place of a grid: when, how large, where.
struct GridPlace {
  Nanos time;
  FrameShape shape;
  Pitch pitch;
  std::string_view frame_id;
};

/// foxglove_msgs/msg/Grid with cells of zeros; returns their place, row-major.
std::span<std::uint8_t> write_grid(const GridPlace& place, std::span<const GridField> fields, std::size_t cell_bytes,
                                   std::vector<std::uint8_t>& message);

/// foxglove_msgs/msg/Grid of forces or conductances, their standard deviations and status [taxels].
template <typename Real>
void write_taxels(const GridPlace& place, std::span<const GridField> fields, const std::vector<Real>& values,
                  const std::vector<Real>& sigmas, const std::vector<TaxelStatus>& taxels,
                  std::vector<std::uint8_t>& message) {
  const std::size_t count = place.shape.taxel_count();
  assert(values.size() == count && sigmas.size() == count && taxels.size() == count);
  std::uint8_t* cell = write_grid(place, fields, kCellBytes, message).data();
  for (std::size_t i = 0; i < count; ++i, cell += kCellBytes) {
    const auto value = static_cast<float>(values[i]);
    const auto sigma = static_cast<float>(sigmas[i]);
    std::memcpy(cell, &value, sizeof(float));
    std::memcpy(cell + kSigmaOffset, &sigma, sizeof(float));
    cell[kCellStatusOffset] = static_cast<std::uint8_t>(taxels[i]);
  }
}

/// The cells of write_taxels().
void read_taxels(std::span<const std::uint8_t> cells, std::vector<float>& values, std::vector<float>& sigmas,
                 std::vector<TaxelStatus>& taxels);

}  // namespace dermis::bytes::ros_messages
