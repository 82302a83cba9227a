// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// expected error: nodiscard
#include <string>

#include "dermis/pipeline/model.hpp"

bool is_model(const std::string& path);

bool is_model(const std::string& path) {
#ifdef MISTAKE
  dermis::pipeline::read_model(path);
  return true;
#else
  return dermis::pipeline::read_model(path).has_value();
#endif
}
