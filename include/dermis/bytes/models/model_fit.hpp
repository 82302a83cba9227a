// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::models {

/// In what a model of the array `of_model` does not fit another one, but for their circuits; empty: it fits.
[[nodiscard]] std::string misfit(const ArrayDescription& array, const ArrayDescription& of_model);

}  // namespace dermis::bytes::models
