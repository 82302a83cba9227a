// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace dermis::benchmarks {

/// Writes the rows of a program, each with at least "work", "engine", "threads", "median", "unit" and "checked", as
/// <module>.json in the folder DERMIS_BENCH_FOLDER (default bench). Whether all of them are checked.
inline bool write_rows(const std::string& module, const nlohmann::ordered_json& rows) {
  const char* folder = std::getenv("DERMIS_BENCH_FOLDER");
  const std::filesystem::path path = std::filesystem::path(folder != nullptr ? folder : "bench") / (module + ".json");
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << rows.dump(2) << "\n";
  fmt::print("written: {}\n", path.string());
  return std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row["checked"].template get<bool>(); });
}

}  // namespace dermis::benchmarks
