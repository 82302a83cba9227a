// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <filesystem>

/// Where things are on this machine. One source alone knows, so that all others compile to the same wherever they are.
namespace dermis::support {

[[nodiscard]] std::filesystem::path project_folder();
[[nodiscard]] std::filesystem::path shared_data_folder();
[[nodiscard]] std::filesystem::path firmware_example();  ///< The program examples/firmware.

}  // namespace dermis::support
