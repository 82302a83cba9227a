// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// A library of ours that is loaded when asked for. Linked, its own libraries would cost every command their start.
struct Plugin {
  std::string use;    ///< "DDS": what it is for, in messages.
  std::string file;   ///< "libdermis_dds.so"
  std::string needs;  ///< "of a build with DERMIS_BUILD_DDS, and Fast DDS (Debian: libfastrtps2.9)"
};

/// The function of this name in the plugin. It is loaded with the first call and never unloaded, as threads of its
/// libraries live as long as the process. Fails where the plugin or one of its libraries is not there. Thread-safe.
[[nodiscard]] Result<void*> find_plugin_function(const Plugin& plugin, const char* name);

}  // namespace dermis
