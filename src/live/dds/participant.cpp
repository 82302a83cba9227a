// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/dds/participant.hpp"

#include "dermis/bytes/system/plugin.hpp"

namespace dermis::live::dds {

Result<std::unique_ptr<Participant>> open_participant(const PublisherOptions& options) {
  const Result<void*> function = find_plugin_function(
      {"DDS", "libdermis_dds.so",
       "of a build with DERMIS_BUILD_DDS or of the Debian package dermis, and Fast DDS (Debian: libfastrtps2.9)"},
      kOpenParticipant);
  if (!function) return function.error();
  Result<std::unique_ptr<Participant>> opened{std::unique_ptr<Participant>()};
  reinterpret_cast<OpenParticipant>(*function)(options, opened);
  return opened;
}

}  // namespace dermis::live::dds
