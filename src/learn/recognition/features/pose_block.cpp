// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/pose_block.hpp"

namespace dermis::learn::recognition {

void write_pose(const ImageAnalysis& analysis, std::span<double> out) {
  const Moments& moments = analysis.moments();
  const Lattice& lattice = analysis.lattice();
  const double elongation = 1.0 - moments.minor / moments.major;
  out[0] = moments.row / (lattice.row_step * static_cast<double>(lattice.rows));
  out[1] = moments.col / (lattice.col_step * static_cast<double>(lattice.cols));
  out[2] = elongation * (moments.axis_col * moments.axis_col - moments.axis_row * moments.axis_row);
  out[3] = elongation * 2.0 * moments.axis_col * moments.axis_row;
}

}  // namespace dermis::learn::recognition
