// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/touch/frames/result.hpp"
#include "recognising/labelled_examples.hpp"

namespace dermis::app {

/// 'dermis evaluate --classes': prints what the classes of a file answer to labelled examples.
[[nodiscard]] Status evaluate_classes(const std::string& classes, recognising::ExampleOptions examples, bool json);

}  // namespace dermis::app
