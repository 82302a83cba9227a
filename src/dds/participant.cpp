// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dds/participant.hpp"

#include <dlfcn.h>

#include <string>

namespace dermis::dds {
namespace {

constexpr const char* kPlugin = "libdermis_dds.so";

Error failed_to_load() {
  const char* const why = dlerror();
  return bad_input(std::string("DDS needs ") + kPlugin + " of a build with DERMIS_BUILD_DDS, and Fast DDS (Debian: " +
                   "libfastrtps2.9): " + (why != nullptr ? why : "cannot be loaded"));
}

}  // namespace

Result<std::unique_ptr<Participant>> open_participant(const PublisherOptions& options) {
  // Never closed: threads and destructors of Fast DDS live as long as the process.
  void* const plugin = dlopen(kPlugin, RTLD_NOW | RTLD_LOCAL);
  if (plugin == nullptr) return failed_to_load();
  const auto open = reinterpret_cast<OpenParticipant>(dlsym(plugin, kOpenParticipant));
  if (open == nullptr) return failed_to_load();
  Result<std::unique_ptr<Participant>> opened{std::unique_ptr<Participant>()};
  open(options, opened);
  return opened;
}

}  // namespace dermis::dds
