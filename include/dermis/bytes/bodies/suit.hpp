// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/bytes/bodies/surface.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// One array of a suit: the source of its frames, its model and its pose.
struct SuitArray {
  std::string name;        ///< Unique in the suit; a letter, then letters, digits and '_': topics are /<name>/raw, ...
  std::string from;        ///< URI of a device or of the simulator.
  std::string model;       ///< Path of its model file.
  std::string classes{};   ///< Path of a classes file for its touches; empty: none.
  std::string link{};      ///< Link of the body that carries the array; empty: its first.
  Pose base_from_array{};  ///< In the frame of the link; without a body, in that of the suit.
  bool mirrored = false;
  ArrayShape shape{};
};

/// Several arrays on one body.
struct SuitDescription {
  std::string name = "suit";
  std::string classes{};          ///< Path of a classes file for touches of several arrays together; empty: none.
  std::string body{};             ///< Path of what the body looks like: URDF or a mesh; empty: nothing is known of it.
  double body_scale = 1.0;        ///< Factor from the numbers of a mesh to metres, > 0.
  std::vector<SuitArray> arrays;  ///< 1 ... 256

  /// Names the first field that is wrong, as "array 'chest': ...".
  [[nodiscard]] Status validate() const;
};

}  // namespace dermis
