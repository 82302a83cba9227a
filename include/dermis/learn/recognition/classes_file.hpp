// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/learn/recognition/classes.hpp"
#include "dermis/touch/frames/result.hpp"

/// Classes as safetensors: docs/model-file.md names its tensors. The same classes give the same bytes.
namespace dermis::learn::recognition {

inline constexpr bytes::files::FileFormat kClassesFormat{"dermis classes 2", "dermis classes 1",
                                                         "holds no classes; learning writes them"};

[[nodiscard]] Status write_classes(const std::string& path, const Classes& classes);

/// Reads back what write_classes() wrote. Whatever else a file holds gives one line that names it.
[[nodiscard]] Result<Classes> read_classes(const std::string& path);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<Classes> classes_from_bytes(std::string_view bytes, const std::string& name);

}  // namespace dermis::learn::recognition
