// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/process_outputs.hpp"

#include <atomic>

#include "bytes/files/known_outputs.hpp"

namespace dermis::bytes::files {
namespace {

std::atomic<ProcessOutputs*> shared = nullptr;  // by another part of the process

}  // namespace

ProcessOutputs& process_outputs() {
  if (ProcessOutputs* const outputs = shared) return *outputs;
  static auto* const kOwn = new ProcessOutputs;  // never destroyed: outputs of static objects may end later
  return *kOwn;
}

void share_process_outputs(ProcessOutputs& outputs) {
  shared = &outputs;
}

}  // namespace dermis::bytes::files
