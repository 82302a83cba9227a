// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::bytes::files {

/// The outputs that this process has claimed and begun. A plugin has its own copy of this library: whoever loads it
/// shares those of the process with it.
struct ProcessOutputs;

/// Those of this copy of the library. Thread-safe.
[[nodiscard]] ProcessOutputs& process_outputs();

/// From now on this copy has those of another. Call it before an output is begun here.
void share_process_outputs(ProcessOutputs& outputs);

}  // namespace dermis::bytes::files
