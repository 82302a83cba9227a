// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/described_sensors.hpp"

#include "dermis/bytes/files/array_toml.hpp"

namespace dermis::bytes::recordings {

std::size_t described_sensors(const FrameNotes& notes) {
  if (notes.array_toml.empty()) return 0;
  const Result<ArrayDescription> array = files::array_from_toml(notes.array_toml, notes.name);
  return array ? array->temperature_sensors.size() : 0;
}

}  // namespace dermis::bytes::recordings
