// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "dermis/touch/contacts/strip_table.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::touch::contacts {

/// At once, in one array.
inline constexpr std::size_t kMostContacts = 255;

struct ContactOptions {
  /// A contact begins where a taxel exceeds an unloaded one by this many standard deviations of the additive noise, 1
  /// ... 100. Several taxels may exceed it by less if they are together as unlikely.
  double onset_sigma = 5.0;
  double onset_force_n = 0.1;      ///< The sum over the area must also be at least this [N], 0 ... 1000.
  double release_share = 0.5;      ///< It ends below this share of both, 0.1 ... 1 (hysteresis).
  std::size_t most_contacts = 32;  ///< At once, 1 ... kMostContacts; if there are more, the strongest are kept.

  /// Names the first field that is out of its range, as "contacts.onset_sigma: ...".
  [[nodiscard]] Status validate() const;
};

/// The paper's image processing: the stressed area first, then fine positioning inside it, then the size of the force.
/// Finds the contacts of each frame and follows them from frame to frame.
/// Not thread-safe: one per stream of frames.
class ContactTracker {
 public:
  /// `array` and `options` must be valid. `strip` holds the model's learned positions, if it has them, and must be
  /// consistent. Without taxel_area_m2 a taxel is a disc of 0.7 of the smaller pitch.
  explicit ContactTracker(const ArrayDescription& array, const ContactOptions& options = {},
                          std::optional<StripTable> strip = {});
  ContactTracker(ContactTracker&&) noexcept;
  ContactTracker& operator=(ContactTracker&&) noexcept;
  ~ContactTracker();

  /// Never fails; taxels without force (NaN) are neither pressed nor unpressed. Allocates nothing once `report` has
  /// held most_contacts contacts.
  void process(const ForceFrame& force, ContactReport& report) noexcept;

  /// Forgets the present contacts without a release, because the next frames are of another time. Ids continue.
  void forget() noexcept;

  /// Takes effect from the next frame on. Contacts keep their ids.
  void set_options(const ContactOptions& options) noexcept;
  [[nodiscard]] const ContactOptions& options() const noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::touch::contacts
