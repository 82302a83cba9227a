// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "touch/contacts/contact_gauge.hpp"
#include "touch/contacts/taxel_plane.hpp"

namespace dermis::touch::contacts {

/// The evidence that a taxel must show of another contact than the one measured.
struct Evidence {
  double onset_sigma = 0.0;  ///< Standard deviations of its force, material included, that it must stand out by.
  double share = 1.0;        ///< Share of the full evidence that is asked for.
};

/// Finds a weak contact beside a strong one, which makes no valley between them.
class ContactParting {
 public:
  /// `plane` is to outlive it.
  explicit ContactParting(const TaxelPlane& plane);

  /// Puts last those taxels of `measured` that its patch does not explain and that hang together, both parts by falling
  /// force. Returns how many come before them. `held`: the taxels of present contacts, one of which must be among those
  /// put last. Where it is empty, the strongest unexplained taxel must be.
  [[nodiscard]] std::size_t part(const ForceFrame& force, std::span<std::uint32_t> taxels, const Measurement& measured,
                                 Evidence evidence, std::span<const std::uint32_t> held);

  /// Whether `taxel` stands out of the patch of `measured`, which must exist. `scatter`: deviation of a taxel from the
  /// patch beside its noise [N].
  [[nodiscard]] bool stands_out(const ForceFrame& force, std::uint32_t taxel, const Measurement& measured,
                                Evidence evidence, float scatter) const;

 private:
  void keep_what_hangs_together(std::vector<std::uint32_t>& taxels) const;

  const TaxelPlane& plane_;
  std::vector<std::uint32_t> unexplained_;
  std::vector<std::uint32_t> apart_;
};

}  // namespace dermis::touch::contacts
