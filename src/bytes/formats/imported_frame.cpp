// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/formats/imported_frame.hpp"

#include <optional>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {

Result<Nanos> time_of_frame(const std::string& place, std::size_t index, double rate_hz) {
  const std::optional<Nanos> time = files::nanos_from_seconds(static_cast<double>(index) / rate_hz);
  if (time) return *time;
  return bad_input(place + ": would be later than 9e9 seconds; give a higher rate");
}

void tell_cut(const ImportOptions& options, const std::string& place, std::size_t frames) {
  if (!options.loss) return;
  options.loss(place + ": is cut off; the " + std::to_string(frames) +
               (frames == 1 ? " frame before is read" : " frames before are read"));
}

}  // namespace dermis::bytes::formats
