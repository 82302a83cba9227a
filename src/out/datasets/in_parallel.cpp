// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/in_parallel.hpp"

#include <tbb/parallel_for.h>

namespace dermis::out::datasets {

void in_parallel(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, count, body);
}

}  // namespace dermis::out::datasets
