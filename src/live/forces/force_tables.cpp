// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/force_tables.hpp"

#include <utility>

namespace dermis::live::forces {
namespace {

Status create_table(std::optional<bytes::files::ForcesCsvWriter>& table, const std::string& path,
                    const ArrayDescription& array, bytes::files::ForceColumn column) {
  if (path.empty()) return Done{};
  Result<bytes::files::ForcesCsvWriter> created =
      bytes::files::ForcesCsvWriter::create(path, array.rows, array.cols, column);
  if (!created) return created.error();
  table.emplace(std::move(*created));
  return Done{};
}

}  // namespace

Result<ForceTables> ForceTables::create(const ForceTablePaths& paths, const touch::pipeline::Model& model) {
  const ArrayDescription& array = model.array;
  ForceTables tables;
  if (paths.surface && array.cover) tables.surface_.emplace(array);
  const Status forces = create_table(tables.forces_, paths.forces, array, bytes::files::ForceColumn::newtons);
  if (!forces) return forces.error();
  const Status sigmas = create_table(tables.sigmas_, paths.sigmas, array, bytes::files::ForceColumn::sigma_newtons);
  if (!sigmas) return sigmas.error();
  if (!paths.totals.empty()) {
    Result<bytes::files::TotalsCsvWriter> totals = bytes::files::TotalsCsvWriter::create(paths.totals);
    if (!totals) return totals.error();
    tables.totals_.emplace(*std::move(totals));
  }
  if (paths.contacts.empty()) return tables;
  Result<bytes::files::ContactsCsvWriter> contacts = bytes::files::ContactsCsvWriter::create(paths.contacts);
  if (!contacts) return contacts.error();
  tables.contacts_.emplace(ContactTable{touch::contacts::ContactTracker(array, {}, model.strip), *std::move(contacts)});
  return tables;
}

Status ForceTables::write(const ForceFrame& force) {
  Status status = Done{};
  const ForceFrame& shown = surface_ ? surface_->process(force) : force;
  if (forces_) status = forces_->write(shown);
  if (status && sigmas_) status = sigmas_->write(shown);
  if (status && totals_) status = totals_->write(force);
  if (status && contacts_) status = contacts_->write(force);
  return status;
}

Status ForceTables::commit() {
  Status status = Done{};
  if (forces_) status = forces_->commit();
  if (status && sigmas_) status = sigmas_->commit();
  if (status && totals_) status = totals_->commit();
  if (status && contacts_) status = contacts_->commit();
  return status;
}

Status ForceTables::ContactTable::write(const ForceFrame& force) {
  tracker.process(force, report);
  return table.write(report);
}

}  // namespace dermis::live::forces
