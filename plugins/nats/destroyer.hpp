// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::live::fleet {

/// Frees what a library of C has made, for std::unique_ptr.
template <auto Destroy>
struct Destroyer {
  template <typename Made>
  void operator()(Made* made) const {
    Destroy(made);
  }
};

}  // namespace dermis::live::fleet
