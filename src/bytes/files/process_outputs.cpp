// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/process_outputs.hpp"

#include <atomic>

#include "bytes/files/known_outputs.hpp"

namespace dermis::bytes::files {
namespace {

/// Never destroyed: outputs of static objects may end later.
std::atomic<ProcessOutputs*>& outputs_of_process() {
  static std::atomic<ProcessOutputs*> outputs = new ProcessOutputs;
  return outputs;
}

}  // namespace

ProcessOutputs& process_outputs() {
  return *outputs_of_process();
}

void share_process_outputs(ProcessOutputs& outputs) {
  outputs_of_process() = &outputs;
}

}  // namespace dermis::bytes::files
