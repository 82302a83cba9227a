// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <filesystem>
#include <string>

#include "support/places.hpp"

namespace dermis::support {

/// A folder of recordings of real arrays. Where it is not there, tests of them GTEST_SKIP() << not_checked(folder),
/// which ctest lists in its summary.
inline std::filesystem::path shared_data(const char* folder) {
  return shared_data_folder() / folder;
}

inline std::string not_checked(const std::filesystem::path& folder) {
  return "NOT CHECKED on real arrays: no " + folder.string() + "; cmake -D DERMIS_SHARED_DATA=FOLDER tells where it is";
}

}  // namespace dermis::support
