// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "touch/compensation/circuit_model/scanned_lines.hpp"
#include "touch/compensation/resistor_network.hpp"

namespace dermis::touch::compensation {

/// The base network: taxels and a film between lines, and those lines tied through their rho that stay tied in all
/// scans. A line is one node, or one a taxel where it has resistance. An unloaded film is then spread evenly over the
/// taxels, and what it conducts under load as their conductances are.
class LineNetwork {
 public:
  using Potentials = ResistorNetwork::Potentials;  // [nodes, any]

  explicit LineNetwork(const ScannedLines& lines);

  /// Conductances of the taxels [S]. The held lines are those with which the network was built.
  void eliminate(const ScannedLines& lines, std::span<const double> siemens) noexcept;

  /// See ResistorNetwork::solve().
  void solve(Potentials& potentials) const noexcept { network_.solve(potentials); }

  [[nodiscard]] std::size_t nodes() const noexcept { return nodes_; }
  [[nodiscard]] std::size_t head(std::size_t line) const noexcept { return head_[line]; }
  /// Taxels (node of the row, node of the column), then segments of lines, then the film.
  [[nodiscard]] const std::vector<ResistorNetwork::Edge>& edges() const noexcept { return edges_; }
  [[nodiscard]] double siemens(std::size_t edge) const noexcept { return edge_siemens_[edge]; }
  /// The edges at the head of a held line; none of other lines.
  [[nodiscard]] const std::vector<std::size_t>& head_edges(std::size_t line) const noexcept {
    return head_edges_[line];
  }
  /// A floating line without a taxel, where the others are tied; with a film, all of its kind.
  [[nodiscard]] bool is_isolated(std::size_t line) const noexcept {
    return network_.root(head_[line]) != ResistorNetwork::kGround;
  }
  /// Two nodes of one part of a network that floats, or neither floats.
  [[nodiscard]] bool is_joined(std::size_t a, std::size_t b) const noexcept {
    return network_.root(a) == network_.root(b);
  }

 private:
  LineNetwork(const ScannedLines& lines, const std::vector<std::vector<std::size_t>>& line_nodes);
  void copy_film(const ScannedLines& lines, std::span<const double> siemens) noexcept;

  std::vector<std::size_t> head_;  // [lines]
  std::vector<ResistorNetwork::Edge> edges_;
  std::vector<std::size_t> film_counts_;  // edges of the film: of each two rows, then columns, that it connects
  std::vector<double> edge_siemens_;
  std::vector<std::vector<std::size_t>> head_edges_;  // [lines]
  std::size_t nodes_;
  std::vector<double> ground_siemens_;  // [free nodes]
  ResistorNetwork network_;
};

}  // namespace dermis::touch::compensation
