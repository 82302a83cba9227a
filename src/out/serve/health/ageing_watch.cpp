// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/ageing_watch.hpp"

#include <utility>

namespace dermis::out::serve {

AgeingWatch::AgeingWatch(const ServedSuit& suit) {
  for (const ServedArray& array : suit.arrays) arrays_.emplace_back(*array.model);
}

void AgeingWatch::add(const live::suits::ArrayResult& result) {
  Watched& watched = arrays_[result.array];
  const std::lock_guard lock(watched.mutex);
  watched.monitor.add(result.force);
}

learn::health::AgeingEvidence AgeingWatch::evidence(std::size_t array) const {
  const Watched& watched = arrays_[array];
  const std::lock_guard lock(watched.mutex);
  return watched.monitor.evidence();
}

void AgeingWatch::begin_anew(std::size_t array, const touch::pipeline::Model& model) {
  Watched& watched = arrays_[array];
  learn::health::AgeingMonitor fresh(model);
  const std::lock_guard lock(watched.mutex);
  watched.monitor = std::move(fresh);
}

}  // namespace dermis::out::serve
