// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// expected error: RawFrame.*ConductanceFrame
#include "dermis/touch/fusion/force_fusion.hpp"

void fuse(dermis::touch::fusion::ForceFusion& fusion, dermis::ForceFrame& force);

void fuse(dermis::touch::fusion::ForceFusion& fusion, dermis::ForceFrame& force) {
#ifdef MISTAKE
  const dermis::RawFrame frame;
#else
  const dermis::ConductanceFrame frame;
#endif
  fusion.process(frame, force);
}
