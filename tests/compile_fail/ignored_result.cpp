// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// expected error: nodiscard
#include <string>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/touch/pipeline/model.hpp"

bool is_model(const std::string& path);

bool is_model(const std::string& path) {
#ifdef MISTAKE
  dermis::bytes::models::read_model(path);
  return true;
#else
  return dermis::bytes::models::read_model(path).has_value();
#endif
}
