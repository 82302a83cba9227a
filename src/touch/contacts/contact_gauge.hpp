// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "dermis/touch/contacts/strip_table.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "touch/contacts/contact_tracks.hpp"
#include "touch/contacts/patch_search.hpp"
#include "touch/contacts/small_contact_table.hpp"
#include "touch/contacts/taxel_plane.hpp"

namespace dermis::touch::contacts {

/// A contact as the taxels of one stressed area show it.
struct Measurement {
  Contact contact;                ///< All but id, phase, onset and velocity.
  std::uint32_t peak = 0;         ///< Its strongest taxel.
  std::optional<PatchFit> patch;  ///< About the peak, in radii of a taxel; none: the taxels do not determine it.

  [[nodiscard]] PatchProfile profile() const noexcept { return patch ? patch->profile : PatchProfile::hertz; }
};

/// Finds the exact position and the force of a contact.
class ContactGauge {
 public:
  /// `strip`: learned positions, which then take the place of the fit; consistent. `plane`, that of the array, is to
  /// outlive it.
  ContactGauge(const TaxelPlane& plane, std::optional<StripTable> strip);

  /// `taxels`: those of the area, by falling force; at least one. Other taxels from `pressed_sigma` standard deviations
  /// of the noise on belong to other contacts. `expected`, or null: where to begin the search for a patch on many
  /// taxels, which is faster, and leads to the same one.
  [[nodiscard]] Measurement measure(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                    double pressed_sigma, const ExpectedContact* expected);

  /// The deviation of the weak taxels in and around the area of `measured` from its patch, which must exist [N].
  [[nodiscard]] float scatter_of_weak_taxels(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                             double pressed_sigma, const Measurement& measured);

 private:
  /// The place from the table, from the patch, which it leaves in `measured`, or from both. Empty where the taxels do
  /// not determine it.
  [[nodiscard]] std::optional<ContactPlace> place(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                                  double pressed_sigma, const ExpectedContact* expected,
                                                  Measurement& measured);
  /// Puts a contact on a strip to the learned position.
  void correct(const ForceFrame& force, std::span<const std::uint32_t> taxels, Contact& contact) const;
  /// Mixes a fit and the centre of mass. The more uncertain the fit is, the more the centre of mass counts, without a
  /// jump.
  [[nodiscard]] ContactPlace blend(const FoundPatch& found, const Contact& contact) const;
  [[nodiscard]] double reach(std::span<const std::uint32_t> taxels, PlaneVector place) const;
  /// Empty at the edge, beside a taxel without force, and on more than a block of 2 x 2 taxels.
  [[nodiscard]] std::optional<ContactPlace> look_up(const ForceFrame& force,
                                                    std::span<const std::uint32_t> taxels) const;

  const TaxelPlane& plane_;
  std::optional<StripTable> strip_;
  std::shared_ptr<const SmallContactTable> small_contacts_;  // null for a strip, which is all edge
  PatchSearch search_;
};

}  // namespace dermis::touch::contacts
