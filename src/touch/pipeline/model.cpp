// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/model.hpp"

#include <cstddef>

namespace dermis::touch::pipeline {

bool is_consistent(const Model& model) {
  const std::size_t taxels = model.array.taxel_count();
  if (model.networks.taxel_count() != taxels || !model.networks.is_consistent()) return false;
  for (const fusion::LookUpTables& tables : model.baselines) {
    if (tables.taxel_count() != taxels || !tables.is_consistent()) return false;
  }
  if (model.memory && !model.memory->is_consistent()) return false;
  if (model.supply && !model.supply->is_consistent()) return false;
  const bool is_strip = (model.array.rows > 1) != (model.array.cols > 1);
  return !model.strip || (is_strip && model.strip->is_consistent());
}

}  // namespace dermis::touch::pipeline
