// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/learn/simulation/scene.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::simulation {

/// Round patches that come, rest or slide, and go: the scene "contacts". Before the first and after the last frame
/// nothing touches the array, so the script can be played in a loop. Thread-safe.
class ContactScript {
 public:
  static constexpr double kFrameS = 0.01;

  ContactScript(const ArrayDescription& array, std::size_t frames, std::uint64_t seed);

  /// The contacts in frame `index`, and the force on each taxel [N], which is added to `force_n`.
  void frame(std::size_t index, std::vector<AppliedContact>& contacts, std::vector<double>& force_n) const;

 private:
  struct Touch {
    PatchShape shape = PatchShape::hertz;
    double diameter_m = 0.0;
    double force_n = 0.0;
    std::size_t first = 0;               ///< First frame with a force,
    std::size_t frames = 0;              ///< and the number of these.
    double onset_s = 0.0;                ///< How long the force takes to rise,
    double release_s = 0.0;              ///< and to fall.
    PlaneVector begin{}, bend{}, end{};  ///< A quadratic Bezier curve [m].

    [[nodiscard]] PlaneVector position(std::size_t frame) const;
    [[nodiscard]] double force(std::size_t frame) const;
  };

  void fill_slot(std::size_t slot, Random& random, std::size_t frames);
  [[nodiscard]] bool place(Touch& touch, Random& random) const;
  void draw_path(Touch& touch, Random& random) const;
  [[nodiscard]] PlaneVector draw_point(Random& random, double margin) const;
  [[nodiscard]] bool keeps_apart(const Touch& touch) const;
  [[nodiscard]] double spread(const AppliedContact& contact, std::vector<double>& force_n) const;

  ArrayDescription array_;
  double taxel_radius_m_;
  double pitch_m_;              // The larger one.
  std::vector<Touch> touches_;  // By their first frame.
};

}  // namespace dermis::learn::simulation
