// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "support/places.hpp"

namespace dermis::support {

std::filesystem::path project_folder() {
  return DERMIS_PROJECT_FOLDER;
}

std::filesystem::path shared_data_folder() {
  return DERMIS_SHARED_DATA;
}

std::filesystem::path firmware_example() {
  return DERMIS_FIRMWARE_EXAMPLE;
}

}  // namespace dermis::support
