// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/two_terminal_scan.hpp"

#include <algorithm>

namespace dermis::touch::compensation {
namespace {

constexpr Eigen::Index kReadingsAtOnce = 256;  // whose potentials stay in the cache while all taxels are summed

}  // namespace

TwoTerminalScan::TwoTerminalScan(const ScannedLines& lines, const LineNetwork& network)
    : CircuitScan(lines),
      network_(network),
      potential_(at(network.nodes()), at(lines.taxels())),
      square_sums_(at(lines.taxels())),
      part_(lines.count()),
      across_(at(lines.count()), at(lines.count())) {}

bool TwoTerminalScan::is_joined(std::size_t driven, std::size_t sensed) const noexcept {
  return network_.is_joined(network_.head(driven), network_.head(lines().driven() + sensed));
}

void TwoTerminalScan::number_parts() noexcept {
  for (std::size_t line = 0; line < lines().count(); ++line) {
    part_[line] = 0;
    while (!network_.is_joined(network_.head(part_[line]), network_.head(line))) ++part_[line];
  }
}

void TwoTerminalScan::solve() noexcept {
  number_parts();
  potential_.setZero();
  lines().for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    potential_(at(network_.head(d)), at(reading)) = 1.0;
    potential_(at(network_.head(lines().driven() + s)), at(reading)) = -1.0;
  });
  network_.solve(potential_);
  lines().for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    const std::size_t line = lines().driven() + s;
    const double ohm = potential_(at(network_.head(d)), at(reading)) - potential_(at(network_.head(line)), at(reading));
    current(d, s) = is_joined(d, s) ? 1.0 / (lines().rho(d) + ohm + lines().rho(line)) : 0.0;
  });
}

double TwoTerminalScan::current_by_resistor(std::size_t driven, std::size_t sensed, std::size_t line) const noexcept {
  const double amperes = currents()(at(driven), at(sensed));
  return line == driven || line == lines().driven() + sensed ? -amperes * amperes : 0.0;
}

// Over the supply. In a scan across two parts of the array without a taxel between them, one stands at 1 V.
double TwoTerminalScan::drop(std::size_t driven, std::size_t sensed, std::size_t taxel) const noexcept {
  const std::size_t from = network_.head(driven);
  const std::size_t to = network_.head(lines().driven() + sensed);
  const auto joined = [this](std::size_t a, std::size_t b) { return network_.is_joined(a, b); };
  const auto [a, b] = network_.edges()[taxel];
  if (!joined(from, to)) return (joined(a, from) && joined(b, to)) || (joined(b, from) && joined(a, to)) ? 1.0 : 0.0;
  if (!joined(a, b)) return 0.0;
  const Eigen::Index scan = at(lines().reading(driven, sensed));
  return currents()(at(driven), at(sensed)) * (potential_(at(a), scan) - potential_(at(b), scan));
}

void TwoTerminalScan::derive(std::size_t driven, std::size_t sensed, std::size_t first,
                             std::span<double> out) const noexcept {
  const double gain = lines().sensed_head(sensed).gain;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double volts = drop(driven, sensed, first + k);
    out[k] = gain * volts * volts;
  }
}

void TwoTerminalScan::multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept {
  square_sums_.setZero();
  across_.setZero();
  for (std::size_t taxel = 0; taxel < lines().taxels(); ++taxel) {
    const auto [a, b] = network_.edges()[taxel];
    const std::size_t row = lines().row_line(taxel / lines().array().cols);
    const std::size_t col = lines().column_line(taxel % lines().array().cols);
    if (!network_.is_joined(a, b)) across_(at(part_[row]), at(part_[col])) += change[taxel];
  }
  for (Eigen::Index first = 0; first < square_sums_.size(); first += kReadingsAtOnce) {
    const Eigen::Index count = std::min(kReadingsAtOnce, square_sums_.size() - first);
    for (std::size_t taxel = 0; taxel < lines().taxels(); ++taxel) {
      const auto [a, b] = network_.edges()[taxel];
      if (!network_.is_joined(a, b)) continue;
      const auto drops = potential_.row(at(a)).segment(first, count) - potential_.row(at(b)).segment(first, count);
      square_sums_.segment(first, count) += change[taxel] * drops.cwiseAbs2();
    }
  }
  lines().for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    const double amperes = currents()(at(d), at(s));
    double sum = amperes * amperes * square_sums_(at(reading));
    if (!is_joined(d, s)) {
      const Eigen::Index from = at(part_[d]);
      const Eigen::Index to = at(part_[lines().driven() + s]);
      sum = across_(from, to) + across_(to, from);
    }
    product[reading] = lines().sensed_head(s).gain * sum;
  });
}

}  // namespace dermis::touch::compensation
