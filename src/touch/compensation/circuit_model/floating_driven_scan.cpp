// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/floating_driven_scan.hpp"

namespace dermis::touch::compensation {

FloatingDrivenScan::FloatingDrivenScan(const ScannedLines& lines, const LineNetwork& network)
    : CircuitScan(lines),
      network_(network),
      responses_(lines, network),
      drops_(lines.driven(), lines.sensed(), lines.taxels()),
      loop_siemens_(lines.driven()),
      squares_(at(lines.driven()), at(lines.taxels())),
      square_sums_(at(lines.driven())) {}

void FloatingDrivenScan::solve() noexcept {
  responses_.solve();
  drops_.adjoint = responses_.sensed_drops();
  drops_.prepare_sums();
  for (std::size_t d = 0; d < lines().driven(); ++d) drive(d);
}

void FloatingDrivenScan::drive(std::size_t driven) noexcept {
  const Eigen::Index d = at(driven);
  loop_siemens_[driven] = responses_.drive_floating_line(driven);
  const double volts = source_volts(driven);
  drops_.forward.row(d) = volts * responses_.drops().row(d) + responses_.offset_drops();
  responses_.clear_isolated_lines(driven, drops_.forward.row(d));
  squares_.row(d) = drops_.forward.row(d).cwiseProduct(responses_.drops().row(d));
  for (std::size_t s = 0; s < lines().sensed(); ++s) {
    const std::size_t line = lines().driven() + s;
    current(driven, s) =
        volts * loop_siemens_[driven] * responses_.current(line, driven) + responses_.offset_current(line);
  }
}

double FloatingDrivenScan::source_volts(std::size_t driven) const noexcept {
  return network_.is_isolated(driven) ? 1.0 : 1.0 - responses_.offset_potential(driven);
}

double FloatingDrivenScan::current_by_resistor(std::size_t driven, std::size_t sensed,
                                               std::size_t line) const noexcept {
  const std::size_t sensed_line = lines().driven() + sensed;
  const double loop = loop_siemens_[driven];
  const double share = responses_.current(sensed_line, driven);
  const double drive = source_volts(driven) * loop;
  if (line < lines().driven()) return line == driven ? -drive * loop * share : 0.0;
  const double through_line = responses_.current(line, driven);
  return (responses_.offset_current(line) + drive * through_line) *
         (responses_.current(line, sensed_line) - share * loop * through_line);
}

void FloatingDrivenScan::derive(std::size_t driven, std::size_t sensed, std::size_t first,
                                std::span<double> out) const noexcept {
  const double gain = lines().sensed_head(sensed).gain;
  Eigen::Map<Eigen::RowVectorXd> row(out.data(), at(out.size()));
  drops_.derive(driven, sensed, gain, first, row);
  row += gain * responses_.current(lines().driven() + sensed, driven) *
         squares_.row(at(driven)).segment(at(first), row.size());
}

void FloatingDrivenScan::multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept {
  const Matrix& sums = drops_.sum(change);
  square_sums_.noalias() = squares_ * Eigen::Map<const Eigen::VectorXd>(change.data(), at(change.size()));
  lines().for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    const double taken = responses_.current(lines().driven() + s, d) * square_sums_(at(d));
    product[reading] = -lines().sensed_head(s).gain * (sums(at(d), at(s)) - taken);
  });
}

}  // namespace dermis::touch::compensation
