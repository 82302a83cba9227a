// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/touch/network/levenberg_marquardt.hpp"

namespace dermis::paper {

/// Minimises the weighted error of a network over samples, eq. (6), by Levenberg-Marquardt: Hagan and Menhaj 1994. The
/// Jacobian is never stored. `parameters` [network.shape().parameter_count()]; the rest as touch::network::minimise().
touch::network::LevenbergMarquardtReport minimise(FeedForward<double>& network, const PackedSamples<double>& samples,
                                                  std::vector<double>& parameters,
                                                  const touch::network::LevenbergMarquardtOptions& options = {});

}  // namespace dermis::paper
