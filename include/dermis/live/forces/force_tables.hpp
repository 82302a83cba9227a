// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

#include "dermis/bytes/files/contacts_csv.hpp"
#include "dermis/bytes/files/forces_csv.hpp"
#include "dermis/bytes/files/totals_csv.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/surface_forces.hpp"

namespace dermis::live::forces {

/// Files to write (docs/file-formats.md); those that are empty are not.
struct ForceTablePaths {
  std::string forces;
  std::string sigmas;  ///< Of the forces, their standard deviations.
  std::string contacts;
  std::string totals{};  ///< The force on the whole array.
  bool surface = false;  ///< Forces and sigmas are those on the cover, where the model has one.

  [[nodiscard]] bool is_any() const { return !(forces + sigmas + contacts + totals).empty(); }
};

/// The forces of a model frame by frame as tables. Each appears complete with commit(), or not at all. Not thread-safe.
class ForceTables {
 public:
  /// Fails where a table cannot be written.
  [[nodiscard]] static Result<ForceTables> create(const ForceTablePaths& paths, const touch::pipeline::Model& model);

  [[nodiscard]] Status write(const ForceFrame& force);
  [[nodiscard]] Status commit();

 private:
  /// Writes the contacts on the array.
  struct ContactTable {
    [[nodiscard]] Status write(const ForceFrame& force);
    [[nodiscard]] Status commit() { return table.commit(); }

    touch::contacts::ContactTracker tracker;
    bytes::files::ContactsCsvWriter table;
    ContactReport report{};
  };

  ForceTables() = default;
  std::optional<touch::pipeline::SurfaceForces> surface_;
  std::optional<bytes::files::ForcesCsvWriter> forces_;
  std::optional<bytes::files::ForcesCsvWriter> sigmas_;
  std::optional<ContactTable> contacts_;
  std::optional<bytes::files::TotalsCsvWriter> totals_;
};

}  // namespace dermis::live::forces
