// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// expected error: nodiscard
#include "dermis/touch/frames/result.hpp"

dermis::Status save();

int main() {
#ifdef MISTAKE
  save();
  return 0;
#else
  return save() ? 0 : 1;
#endif
}
