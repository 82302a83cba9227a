// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/suit/models_in_use.hpp"

#include <utility>

namespace dermis::out::serve {

ModelsInUse::ModelsInUse(const ServedSuit& suit) {
  for (const ServedArray& array : suit.arrays) used_.push_back({array.model});
}

std::shared_ptr<const touch::pipeline::Model> ModelsInUse::of(std::size_t array) const {
  const std::lock_guard lock(mutex_);
  return used_[array].model;
}

bool ModelsInUse::is_new(std::size_t array) const {
  const std::lock_guard lock(mutex_);
  return used_[array].is_new;
}

void ModelsInUse::replace(std::size_t array, std::shared_ptr<const touch::pipeline::Model> model) {
  const std::lock_guard lock(mutex_);
  used_[array] = {std::move(model), true};
}

}  // namespace dermis::out::serve
