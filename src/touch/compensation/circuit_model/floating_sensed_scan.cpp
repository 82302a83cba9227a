// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/floating_sensed_scan.hpp"

namespace dermis::touch::compensation {

FloatingSensedScan::FloatingSensedScan(const ScannedLines& lines, const LineNetwork& network)
    : CircuitScan(lines),
      responses_(lines, network),
      drops_(lines.driven(), lines.sensed(), lines.taxels()),
      loop_siemens_(lines.sensed()),
      squares_(at(lines.sensed()), at(lines.taxels())),
      square_sums_(at(lines.sensed())) {}

void FloatingSensedScan::solve() noexcept {
  responses_.solve();
  drops_.forward = responses_.driven_drops();
  for (std::size_t s = 0; s < lines().sensed(); ++s) sense(s);
  drops_.prepare_sums();
}

void FloatingSensedScan::sense(std::size_t sensed) noexcept {
  const Eigen::Index s = at(sensed);
  const std::size_t line = lines().driven() + sensed;
  loop_siemens_[sensed] = responses_.drive_floating_line(line);
  drops_.adjoint.row(s) = responses_.drops().row(at(line));
  responses_.clear_isolated_lines(line, drops_.adjoint.row(s));
  squares_.row(s) = drops_.adjoint.row(s).cwiseAbs2();
  for (std::size_t d = 0; d < lines().driven(); ++d) {
    current(d, sensed) = loop_siemens_[sensed] * responses_.current(d, line);
  }
}

double FloatingSensedScan::current_by_resistor(std::size_t driven, std::size_t sensed,
                                               std::size_t line) const noexcept {
  const std::size_t sensed_line = lines().driven() + sensed;
  const double loop = loop_siemens_[sensed];
  if (line >= lines().driven()) return line == sensed_line ? -currents()(at(driven), at(sensed)) * loop : 0.0;
  const double through_line = responses_.current(line, sensed_line);
  return loop * through_line *
         (responses_.current(line, driven) - responses_.current(driven, sensed_line) * loop * through_line);
}

void FloatingSensedScan::derive(std::size_t driven, std::size_t sensed, std::size_t first,
                                std::span<double> out) const noexcept {
  const double gain = lines().sensed_head(sensed).gain;
  Eigen::Map<Eigen::RowVectorXd> row(out.data(), at(out.size()));
  drops_.derive(driven, sensed, gain, first, row);
  row += gain * responses_.current(driven, lines().driven() + sensed) *
         squares_.row(at(sensed)).segment(at(first), row.size());
}

void FloatingSensedScan::multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept {
  const Matrix& sums = drops_.sum(change);
  square_sums_.noalias() = squares_ * Eigen::Map<const Eigen::VectorXd>(change.data(), at(change.size()));
  lines().for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    const double taken = responses_.current(d, lines().driven() + s) * square_sums_(at(s));
    product[reading] = -lines().sensed_head(s).gain * (sums(at(d), at(s)) - taken);
  });
}

}  // namespace dermis::touch::compensation
