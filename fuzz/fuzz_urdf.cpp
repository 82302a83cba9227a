// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "check_error.hpp"
#include "dermis/bytes/formats/urdf.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto body = dermis::bytes::formats::body_from_urdf({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!body) {
    dermis::fuzz::check_error(body.error());
    return 0;
  }
  const std::vector<double> positions(body->joints.size(), 0.5);
  for (const dermis::Pose& pose : dermis::link_poses(*body, positions)) {
    if (!std::isfinite(pose.translation.x) || !std::isfinite(pose.rotation.w)) std::abort();
  }
  return 0;
}
