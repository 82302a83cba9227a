// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/bodies/body.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// A mesh of a body, as clients get it.
struct BodyFile {
  std::string name;  ///< Its name in the description of the body.
  std::string path;  ///< "/body/0.stl"
  std::string bytes;
};

/// The parts of a body.
struct BodyParts {
  Body body;
  std::vector<BodyFile> files;
};

/// Reads a body: URDF with its meshes, or one mesh (.stl, .glb), of which `scale` makes metres. Meshes of URDF must lie
/// in its folder: STL and GLB of at most 20 MB each, 60 MB together. One that is not there or another is left out, and
/// told to `notice`.
[[nodiscard]] Result<BodyParts> read_body(const std::string& path, double scale,
                                          const std::function<void(const std::string&)>& notice);

/// The body that wears a suit: how it stands, and where it carries the arrays. Thread-safe.
class WornBody {
 public:
  /// An array on a link.
  struct Carried {
    std::size_t link = 0;
    Pose link_from_array{};
  };

  /// `arrays`: in the order of the suit. All joints are at 0.
  WornBody(std::shared_ptr<const BodyParts> parts, std::vector<Carried> arrays);

  /// Another of the same parts, which has not moved.
  [[nodiscard]] std::shared_ptr<WornBody> at_rest() const { return std::make_shared<WornBody>(parts_, arrays_); }

  [[nodiscard]] const Body& body() const noexcept { return parts_->body; }
  [[nodiscard]] const std::vector<BodyFile>& files() const noexcept { return parts_->files; }
  [[nodiscard]] const std::string& link_of(std::size_t array) const { return body().links[arrays_[array].link].name; }

  /// Joints by their names, at positions [rad] or [m]. Joints that are not named stay. Errors: lists of two lengths, a
  /// joint that is not there, a position that is not finite; nothing moves then.
  [[nodiscard]] Status set_joints(std::span<const std::string> names, std::span<const double> positions);

  /// Rises with each set_joints().
  [[nodiscard]] std::uint64_t version() const noexcept { return version_; }

  [[nodiscard]] std::vector<Pose> suit_from_links() const;      ///< Of all links, now.
  [[nodiscard]] Pose suit_from_array(std::size_t array) const;  ///< Now.
  /// Poses of all links with all joints at 0.
  [[nodiscard]] const std::vector<Pose>& rest() const noexcept { return rest_; }
  /// The move of an array from its place at rest to its present one.
  [[nodiscard]] Pose move_of(std::size_t array) const;

 private:
  const std::shared_ptr<const BodyParts> parts_;
  const std::vector<Carried> arrays_;
  const std::vector<Pose> rest_;  // of links
  std::atomic<std::uint64_t> version_ = 0;
  mutable std::mutex mutex_;  // of those below
  std::vector<double> positions_;
  std::vector<Pose> links_;
  std::vector<Pose> moves_;  // of arrays
};

}  // namespace dermis::out::serve
