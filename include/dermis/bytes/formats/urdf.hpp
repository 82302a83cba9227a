// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/bytes/bodies/body.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// The bodies that URDF describes: links, joints, and what is seen of them. Collisions, masses and everything that
/// other tools read is skipped; planar and floating joints stand still. At most 4 MiB, 512 links, 512 joints and 4096
/// visuals. `name` stands for the path in messages: "robot.urdf:7: ...".
[[nodiscard]] Result<Body> body_from_urdf(std::string_view text, const std::string& name);

/// The same from a file.
[[nodiscard]] Result<Body> read_urdf(const std::string& path);

}  // namespace dermis::bytes::formats
