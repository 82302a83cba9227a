// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "touch/contacts/patch_response.hpp"

namespace dermis::touch::contacts {

/// Position and velocity along one axis: a Kalman filter with white acceleration.
class AxisFilter {
 public:
  void begin(double position, double sigma) noexcept;
  void update(double seconds, double position, double sigma) noexcept;
  [[nodiscard]] double predicted(double seconds) const noexcept { return position_ + velocity_ * seconds; }
  [[nodiscard]] double velocity() const noexcept { return velocity_; }

 private:
  double position_ = 0.0;
  double velocity_ = 0.0;
  double variance_position_ = 0.0;
  double covariance_ = 0.0;
  double variance_velocity_ = 0.0;
};

/// The expectation of a contact by the frames before.
struct ExpectedContact {
  PlaneVector place;
  double radius_m = 0.0;
  PatchProfile profile = PatchProfile::hertz;
};

/// A contact of the frame at hand, not yet known by its id.
struct FoundContact {
  Contact contact;         ///< All but id, phase, onset and velocity.
  std::uint32_t peak = 0;  ///< Its strongest taxel.
  PatchProfile profile = PatchProfile::hertz;
  bool can_begin = false;  ///< Strong enough for an onset; else it can only go on.
};

/// Follows contacts from frame to frame: each goes on as the one found nearest to its predicted place, the nearest
/// pairs first. One whose strongest taxel has no force for a while is held as it was.
class ContactTracks {
 public:
  static constexpr double kBlindSeconds = 0.5;

  /// A contact `reach_m` or more from the predicted place is another one.
  explicit ContactTracks(double reach_m);

  /// Replaces `contacts` by those of this frame, released ones included, by id.
  void update(const ForceFrame& force, std::span<const FoundContact> found, std::vector<Contact>& contacts);
  void forget() noexcept { tracks_.clear(); }

  /// The contacts expected at `time`.
  void predict(Nanos time, std::vector<ExpectedContact>& expected) const;

 private:
  struct Track {
    Contact contact;
    AxisFilter x;
    AxisFilter y;
    Nanos seen{};
    std::uint32_t peak = 0;
    PatchProfile profile = PatchProfile::hertz;
    bool is_found = false;

    [[nodiscard]] PlaneVector predicted(Nanos time) const noexcept;
  };
  struct Pair {
    double distance = 0.0;
    std::size_t track = 0;
    std::size_t found = 0;
  };

  void pair_up(Nanos time, std::span<const FoundContact> found);
  void go_on(Track& track, Nanos time, const FoundContact& found);
  void begin(Nanos time, const FoundContact& found);
  void end_or_hold(const ForceFrame& force);

  double reach_m_;
  std::uint32_t next_id_ = 1;
  std::vector<Track> tracks_;  // by id
  std::vector<Pair> pairs_;
  std::vector<bool> is_taken_;  // [found]
};

}  // namespace dermis::touch::contacts
