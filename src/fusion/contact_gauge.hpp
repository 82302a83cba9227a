// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/contacts.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/fusion/strip_table.hpp"
#include "fusion/contact_tracks.hpp"
#include "fusion/patch_fit.hpp"
#include "fusion/small_contact_table.hpp"

namespace dermis::fusion {

/// Fine positioning and the size of the force: what the taxels of one stressed area tell about the contact on it.
class ContactGauge {
 public:
  /// `strip`: learned positions, which then take the place of the fit; consistent.
  explicit ContactGauge(const ArrayDescription& array, std::optional<StripTable> strip = {});

  /// `taxels`: those of the area, by falling force; at least one. Other taxels from `pressed_sigma` standard deviations
  /// of the noise on belong to other contacts. `expected`, or null: where to begin the search for a patch on many
  /// taxels, which is faster, and leads to the same one. Of the result id, phase, onset and velocity are left.
  [[nodiscard]] Contact measure(const ForceFrame& force, std::span<const std::uint32_t> taxels, double pressed_sigma,
                                const ExpectedContact* expected);

  /// Of the contact measured last.
  [[nodiscard]] PatchProfile profile() const noexcept { return fit_ ? fit_->profile : PatchProfile::hertz; }

  /// Of the taxels measured last, those that the patch found does not explain and that hang together are put last, both
  /// parts by falling force; returns how many stay. A weak contact beside a strong one makes no valley, but leaves such
  /// taxels. `onset_sigma`: standard deviations of its force, material included, by which a taxel must stand out of the
  /// patch; `share`: of all that is asked of them. `held`: the taxels of contacts that are there, one of which must be
  /// among those put last; where empty, the strongest that is unexplained.
  [[nodiscard]] std::size_t part(const ForceFrame& force, std::span<std::uint32_t> taxels, double onset_sigma,
                                 double share, std::span<const std::uint32_t> held);

  /// Whether `taxel` stands out of the contact measured last, to which it does not belong: by so many standard
  /// deviations of its force and of what the weak taxels of that contact differ by from its patch.
  [[nodiscard]] bool stands_out(const ForceFrame& force, std::uint32_t taxel, double onset_sigma, double share) const;

 private:
  struct Place {
    PlaneVector position;  // [m]
    PlaneVector sigma;     // [m]
    double radius_m = 0.0;
  };

  void sum_forces(const ForceFrame& force, std::span<const std::uint32_t> taxels, Contact& contact) const;
  void find_moments(const ForceFrame& force, std::span<const std::uint32_t> taxels, Contact& contact) const;
  [[nodiscard]] PlaneVector centre_of_mass(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                           PlaneVector of_forces) const;
  [[nodiscard]] std::optional<Place> place(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                           const Contact& contact, const ExpectedContact* expected);
  /// Puts a contact on a strip to the learned position.
  void correct(const ForceFrame& force, std::span<const std::uint32_t> taxels, Contact& contact) const;
  /// Empty where the taxels tell nothing.
  [[nodiscard]] std::optional<Place> fit(std::span<const std::uint32_t> taxels, const Patch& start,
                                         PatchProfile profile);
  /// A fit and the centre of mass: the more uncertain the fit beside it, the more of the centre of mass, without a
  /// jump.
  [[nodiscard]] Place blend(const Place& of_fit, const Contact& contact) const;
  [[nodiscard]] Patch start_at(PlaneVector place, double radius_m, double newtons) const;
  [[nodiscard]] double reach(std::span<const std::uint32_t> taxels, PlaneVector place) const;
  /// Empty at the edge, beside a taxel without force, and on more than a block of 2 x 2 taxels.
  [[nodiscard]] std::optional<Place> look_up(const ForceFrame& force, std::span<const std::uint32_t> taxels) const;
  void gather(const ForceFrame& force, std::span<const std::uint32_t> taxels);
  void add_taxel(const ForceFrame& force, std::uint32_t taxel);
  void add_mismatch(const PatchFit& fit);
  void keep_what_hangs_together(std::vector<std::uint32_t>& taxels) const;
  [[nodiscard]] bool are_neighbours(std::size_t a, std::size_t b) const noexcept;
  [[nodiscard]] bool stands_out(const ForceFrame& force, std::uint32_t taxel, double onset_sigma, double share,
                                float scatter) const;
  [[nodiscard]] bool is_weak(float newtons) const noexcept;
  [[nodiscard]] float scatter_of_weak_taxels() const;
  [[nodiscard]] PlaneVector centre(std::size_t taxel) const noexcept {
    const std::size_t row = taxel / cols_;
    return {static_cast<double>(taxel - row * cols_) * col_pitch_m_, static_cast<double>(row) * row_pitch_m_};
  }

  std::size_t rows_;
  std::size_t cols_;
  double row_pitch_m_;
  double col_pitch_m_;
  double taxel_area_m2_;
  double taxel_radius_m_;
  std::optional<StripTable> strip_;
  PatchPrior prior_;
  std::shared_ptr<const SmallContactTable> small_contacts_;  // null for a strip, which is all edge
  std::uint32_t origin_taxel_ = 0;
  PlaneVector origin_;  // of fit_taxels_: the strongest taxel [m]
  float peak_newtons_ = 0.0F;
  float pressed_sigma_ = 0.0F;
  std::optional<PatchFit> fit_;  // of the area measured last
  double misfit_ = 1.0;          // of its first fit, over what noise explains; at least 1
  std::vector<std::uint32_t> unexplained_;
  std::vector<std::uint32_t> apart_;
  std::vector<PlaneVector> places_;  // of the taxels, in radii of a taxel
  std::vector<FitTaxel> fit_taxels_;
  std::vector<std::uint32_t> visited_;  // [rows + 2, cols + 2]: the last area that looked at a taxel
  std::uint32_t area_ = 0;
};

}  // namespace dermis::fusion
