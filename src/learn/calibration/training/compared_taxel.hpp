// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

namespace dermis::learn::calibration {

/// A press that was left out, and what either method makes of it.
struct JudgedPress {
  std::size_t moment = 0;  // TaxelPoint::press
  double of_network = 0.0;
  double of_table = 0.0;  // mean relative errors, without sign
};

/// A sample of it.
struct JudgedSample {
  std::size_t sample = 0;  // in the database
  double newtons = 0.0;
  double error_of_table = 0.0;  // relative
  std::size_t touch = 0;        // TaxelPoint::touch
};

/// Forces of a method where nothing presses [N].
struct Ghosts {
  std::vector<float> of_network;
  std::vector<float> of_table;
};

/// The network of a taxel and its table, on presses and on the unloaded taxel.
struct ComparedTaxel {
  std::vector<JudgedPress> presses;
  std::vector<JudgedSample> samples;
  Ghosts ghosts;
};

}  // namespace dermis::learn::calibration
