// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/line_responses.hpp"

namespace dermis::touch::compensation {
namespace {

/// The line of this taxel on the side that floats.
std::size_t floating_line(const ScannedLines& lines, std::size_t taxel) noexcept {
  const std::size_t cols = lines.array().cols;
  const bool rows_float = lines.is_row(lines.driven_are_tied() ? lines.driven() : 0);
  return rows_float ? lines.row_line(taxel / cols) : lines.column_line(taxel % cols);
}

}  // namespace

LineResponses::LineResponses(const ScannedLines& lines, const LineNetwork& network)
    : lines_(lines),
      network_(network),
      potential_(at(network.nodes()), at(lines.count() + 1)),
      current_(Matrix::Zero(at(lines.count()), at(lines.count() + 1))),
      drop_(at(lines.count() + 1), at(lines.taxels())) {}

void LineResponses::solve() noexcept {
  find_potentials();
  find_currents();
  find_drops();
}

void LineResponses::find_potentials() noexcept {
  potential_.setZero();
  for (std::size_t line = 0; line < lines_.count(); ++line) {
    const Eigen::Index head = at(network_.head(line));
    const double source = lines_.is_tied(line) && !lines_.is_held(line) ? 1.0 / lines_.rho(line) : 1.0;
    potential_(head, at(line)) = source;
    if (line >= lines_.driven()) {
      potential_(head, at(lines_.count())) = source * lines_.sensed_head(line - lines_.driven()).emf;
    }
  }
  network_.solve(potential_);
}

void LineResponses::find_currents() noexcept {
  for (std::size_t line = 0; line < lines_.count(); ++line) {
    if (!lines_.is_tied(line)) continue;
    const std::size_t head = network_.head(line);
    const double rho = lines_.rho(line);
    auto out = current_.row(at(line));
    const auto at_head = potential_.row(at(head));
    if (lines_.is_held(line)) {
      out.setZero();
      for (const std::size_t edge : network_.head_edges(line)) {
        const auto& [a, b] = network_.edges()[edge];
        out += network_.siemens(edge) * (potential_.row(at(a == head ? b : a)) - at_head);
      }
      continue;
    }
    out = at_head / rho;
    out(at(line)) -= 1.0 / rho;
    if (line >= lines_.driven()) out(at(lines_.count())) -= lines_.sensed_head(line - lines_.driven()).emf / rho;
  }
}

void LineResponses::find_drops() noexcept {
  for (std::size_t taxel = 0; taxel < lines_.taxels(); ++taxel) {
    const auto& [row, col] = network_.edges()[taxel];
    drop_.col(at(taxel)) = (potential_.row(at(row)) - potential_.row(at(col))).transpose();
  }
}

// Nothing flows into a line without a taxel: it stands at 1 V, with those that a film connects to it.
double LineResponses::drive_floating_line(std::size_t line) noexcept {
  auto drops = drop_.row(at(line));
  if (!network_.is_isolated(line)) {
    const double admittance = 1.0 / (lines_.rho(line) + potential_(at(network_.head(line)), at(line)));
    drops *= admittance;
    return admittance;
  }
  for (std::size_t taxel = 0; taxel < lines_.taxels(); ++taxel) {
    const bool own = network_.is_joined(network_.head(floating_line(lines_, taxel)), network_.head(line));
    drops(at(taxel)) = own ? (lines_.is_row(line) ? 1.0 : -1.0) : 0.0;
  }
  return 0.0;
}

void LineResponses::clear_isolated_lines(std::size_t line, Matrix::RowXpr drops) const noexcept {
  for (std::size_t taxel = 0; taxel < lines_.taxels(); ++taxel) {
    const std::size_t other = floating_line(lines_, taxel);
    if (!network_.is_isolated(other)) continue;
    if (!network_.is_joined(network_.head(other), network_.head(line))) drops(at(taxel)) = 0.0;
  }
}

}  // namespace dermis::touch::compensation
