// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "touch/contacts/contact_tracks.hpp"
#include "touch/contacts/patch_fit.hpp"
#include "touch/contacts/taxel_plane.hpp"

namespace dermis::touch::contacts {

/// Where a contact is, how sure that is, and how large the contact is [m].
struct ContactPlace {
  PlaneVector position;
  PlaneVector sigma;
  double radius_m = 0.0;
};

/// The patch that explains the taxels of an area best.
struct FoundPatch {
  PatchFit most_likely;  ///< About the strongest taxel of the area, in radii of a taxel.
  ContactPlace place;    ///< The mean over patches that explain the taxels nearly as well.
  double misfit = 1.0;   ///< Misfit of the first fit relative to the noise; at least 1.
};

/// A taxel so weak beside the peak of a contact that another contact may press it without a valley between them.
[[nodiscard]] bool is_weak(float newtons, float peak_newtons) noexcept;

/// Looks for the patch that presses an area of taxels.
class PatchSearch {
 public:
  static constexpr std::size_t kSmall = 4;        ///< Taxels that patches of many sizes press.
  static constexpr std::size_t kMostTaxels = 40;  ///< With more, the centre of mass is as good.

  /// `plane` is to outlive it.
  explicit PatchSearch(const TaxelPlane& plane);

  /// Takes the taxels of an area, by falling force, at most kMostTaxels, and those around it. Those from
  /// `pressed_sigma` standard deviations of the noise on belong to other contacts and are left out.
  void gather(const ForceFrame& force, std::span<const std::uint32_t> taxels, double pressed_sigma);

  /// Starts from `start` and a force of that size. Empty where the taxels determine nothing.
  [[nodiscard]] std::optional<FoundPatch> find(const ExpectedContact& start, double newtons);

  /// The deviation of the weak taxels from `patch` [N].
  [[nodiscard]] float scatter_of_weak_taxels(const PatchFit& patch) const;

 private:
  void add(const ForceFrame& force, std::uint32_t taxel);
  void add_mismatch(const PatchFit& fit);
  [[nodiscard]] Patch start_at(const ExpectedContact& start, double newtons) const;

  const TaxelPlane& plane_;
  PatchPrior prior_;
  std::vector<FitTaxel> taxels_;
  std::uint32_t peak_ = 0;  // the strongest taxel, the origin of taxels_
  float peak_newtons_ = 0.0F;
  bool is_small_ = false;
  std::vector<std::uint32_t> visited_;  // [taxels]: the last area that looked at a taxel
  std::uint32_t area_ = 0;
};

}  // namespace dermis::touch::contacts
