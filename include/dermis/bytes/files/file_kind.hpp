// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dermis::bytes::files {

inline constexpr std::string_view kMcapKind = "an MCAP recording";
inline constexpr std::string_view kHdf5Kind = "an HDF5 file";
inline constexpr std::string_view kNpyKind = "a NumPy array (.npy)";
inline constexpr std::string_view kZipKind = "a zip archive (.npz)";
inline constexpr std::string_view kSafetensorsKind = "a safetensors file";
inline constexpr std::string_view kPickleKind = "a pickle of Python, which may run any program when it is read";
inline constexpr std::string_view kTomlKind = "a TOML file";
inline constexpr std::string_view kTableKind = "a table (CSV)";

/// The kind of a file by its first bytes, one of the above or another common one; empty where they do not show it.
[[nodiscard]] std::string_view kind_of(std::string_view first_bytes);

/// "is an MCAP recording, not a safetensors file", where the latter was wanted; empty where the bytes show no other
/// kind.
[[nodiscard]] std::optional<std::string> wrong_kind(std::string_view first_bytes, std::string_view wanted);

}  // namespace dermis::bytes::files
