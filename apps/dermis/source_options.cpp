// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "source_options.hpp"

#include "lost_input.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {

live::sources::SourceOptions source_options(const ArrayDescription* array) {
  return {.array = array, .stop = &stop_flag(), .notice = print_notice, .loss = note_loss};
}

}  // namespace dermis::app
