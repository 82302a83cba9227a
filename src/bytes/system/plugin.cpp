// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/system/plugin.hpp"

#include <dlfcn.h>

namespace dermis {

Result<void*> find_plugin_function(const Plugin& plugin, const char* name) {
  void* const library = dlopen(plugin.file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = library != nullptr ? dlsym(library, name) : nullptr;
  if (function != nullptr) return function;
  const char* const why = dlerror();
  return bad_input(plugin.use + " needs " + plugin.file + " " + plugin.needs + ": " +
                   (why != nullptr ? why : "cannot be loaded"));
}

}  // namespace dermis
