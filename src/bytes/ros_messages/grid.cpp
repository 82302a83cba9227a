// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/ros_messages/grid.hpp"

#include "bytes/ros_messages/cdr.hpp"
#include "bytes/ros_messages/header.hpp"

namespace dermis::bytes::ros_messages {

std::span<std::uint8_t> write_grid(const GridPlace& place, std::span<const GridField> fields, std::size_t cell_bytes,
                                   std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, place.time, place.frame_id);
  for (const double pose : {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) writer.write(pose);  // position, orientation x y z w
  writer.write(static_cast<std::uint32_t>(place.shape.cols));
  writer.write(place.pitch.col_m);
  writer.write(place.pitch.row_m);
  writer.write(static_cast<std::uint32_t>(place.shape.cols * cell_bytes));
  writer.write(static_cast<std::uint32_t>(cell_bytes));
  writer.write(static_cast<std::uint32_t>(fields.size()));
  for (const GridField& field : fields) {
    writer.write_text(field.name);
    writer.write(field.offset);
    writer.write(static_cast<std::uint8_t>(field.type));
  }
  return writer.write_bytes(place.shape.taxel_count() * cell_bytes);
}

void read_taxels(std::span<const std::uint8_t> cells, std::vector<float>& values, std::vector<float>& sigmas,
                 std::vector<TaxelStatus>& taxels) {
  const std::size_t count = cells.size() / kCellBytes;
  values.resize(count);
  sigmas.resize(count);
  taxels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::span<const std::uint8_t> cell = cells.subspan(i * kCellBytes, kCellBytes);
    std::memcpy(&values[i], cell.data(), sizeof(float));
    std::memcpy(&sigmas[i], cell.data() + kSigmaOffset, sizeof(float));
    taxels[i] = static_cast<TaxelStatus>(cell[kCellStatusOffset]);
  }
}

}  // namespace dermis::bytes::ros_messages
