// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace dermis::touch::compensation {

/// Node potentials of a network of resistors by star-mesh elimination. A node p is taken out, whose pivot g is the sum
/// of all conductances at it. Each pair of its neighbours q, r gains g_pq g_pr / g. This is a sparse Cholesky
/// factorisation of the nodal equations without a single subtraction. So every potential is right to a few roundings of
/// itself, however far apart the conductances are. 0 S is a conductance like any other.
///
/// Nodes 0 ... free_nodes - 1 are eliminated in this order, the others are held at given potentials.
class ResistorNetwork {
 public:
  using Potentials = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Edge = std::pair<std::size_t, std::size_t>;

  ResistorNetwork(std::size_t nodes, std::size_t free_nodes, const std::vector<Edge>& edges);

  /// Conductances >= 0 of every edge and from every free node to 0 V [S].
  void eliminate(std::span<const double> edge_siemens, std::span<const double> ground_siemens) noexcept;

  /// In: injected currents of the free nodes, potentials of the held ones [nodes, any]. Out: potentials of all. A part
  /// of the network with no path to 0 V or a held node has its root at 0 V. No net current may be injected there.
  void solve(Potentials& potentials) const noexcept;

  /// The root of a floating part of the network (the same for all its nodes). kGround for a node with a path to 0 V or
  /// to a held node.
  [[nodiscard]] std::size_t root(std::size_t node) const noexcept { return root_[node]; }
  static constexpr std::size_t kGround = static_cast<std::size_t>(-1);

  /// Links that elimination makes, a measure of its cost.
  [[nodiscard]] std::size_t link_count() const noexcept { return neighbour_.size(); }

 private:
  struct Update {  // what node `from` gives to a later one: its link and those after it
    std::size_t from;
    std::size_t link;
  };

  void find_links(const std::vector<Edge>& edges);
  void place_edges(const std::vector<Edge>& edges);
  void eliminate_node(std::size_t node) noexcept;
  void find_roots() noexcept;

  std::size_t free_nodes_;
  std::vector<std::size_t> first_link_;    // of each free node and the end [free_nodes + 1]
  std::vector<std::size_t> neighbour_;     // of each link: the later node
  std::vector<std::size_t> first_update_;  // of each free node and the end [free_nodes + 1]
  std::vector<Update> updates_;
  std::vector<std::size_t> edge_link_;  // where each edge stands among the links; link_count() between held nodes
  std::vector<double> link_siemens_;
  std::vector<double> share_;           // of the links of a node in all its conductances
  std::vector<double> ground_siemens_;  // [free_nodes]
  std::vector<double> pivot_ohm_;       // [free_nodes], 0 at the root of a floating part
  std::vector<double> work_;            // [nodes]
  std::vector<std::size_t> root_;       // [nodes]
};

}  // namespace dermis::touch::compensation
