// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/paper/ranks.hpp"

namespace dermis::paper {

class OneProcess final : public Ranks {
 public:
  [[nodiscard]] std::size_t rank() const noexcept override { return 0; }
  [[nodiscard]] std::size_t count() const noexcept override { return 1; }
  void broadcast(std::span<std::byte> /*bytes*/, std::size_t /*root*/) override {}
};

}  // namespace dermis::paper
