// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/resistor_network.hpp"

#include <algorithm>
#include <set>

namespace dermis::touch::compensation {

ResistorNetwork::ResistorNetwork(std::size_t nodes, std::size_t free_nodes, const std::vector<Edge>& edges)
    : free_nodes_(free_nodes), work_(nodes, 0.0), root_(nodes, kGround) {
  find_links(edges);
  place_edges(edges);
  link_siemens_.resize(link_count());
  share_.resize(link_count());
  ground_siemens_.resize(free_nodes_);
  pivot_ohm_.resize(free_nodes_);
}

// A node's links go to its later neighbours and, handed on by the nodes eliminated before it, to theirs.
void ResistorNetwork::find_links(const std::vector<Edge>& edges) {
  std::vector<std::set<std::size_t>> later(free_nodes_);
  for (const auto& [a, b] : edges) {
    if (std::min(a, b) < free_nodes_) later[std::min(a, b)].insert(std::max(a, b));
  }
  std::vector<std::vector<Update>> updates(free_nodes_);
  first_link_.push_back(0);
  for (std::size_t node = 0; node < free_nodes_; ++node) {
    for (const std::size_t neighbour : later[node]) {
      if (neighbour < free_nodes_) updates[neighbour].push_back({node, neighbour_.size()});
      neighbour_.push_back(neighbour);
    }
    first_link_.push_back(neighbour_.size());
    if (later[node].empty()) continue;
    const std::size_t next = *later[node].begin();
    if (next < free_nodes_) later[next].insert(std::next(later[node].begin()), later[node].end());
    later[node].clear();
  }
  first_update_.push_back(0);
  for (const std::vector<Update>& of_node : updates) {
    updates_.insert(updates_.end(), of_node.begin(), of_node.end());
    first_update_.push_back(updates_.size());
  }
}

void ResistorNetwork::place_edges(const std::vector<Edge>& edges) {
  for (const auto& [a, b] : edges) {
    const std::size_t node = std::min(a, b);
    if (node >= free_nodes_) {
      edge_link_.push_back(link_count());
      continue;
    }
    const auto first = neighbour_.begin() + static_cast<std::ptrdiff_t>(first_link_[node]);
    const auto last = neighbour_.begin() + static_cast<std::ptrdiff_t>(first_link_[node + 1]);
    edge_link_.push_back(static_cast<std::size_t>(std::lower_bound(first, last, std::max(a, b)) - neighbour_.begin()));
  }
}

void ResistorNetwork::eliminate(std::span<const double> edge_siemens, std::span<const double> ground_siemens) noexcept {
  std::fill(link_siemens_.begin(), link_siemens_.end(), 0.0);
  for (std::size_t edge = 0; edge < edge_siemens.size(); ++edge) {
    if (edge_link_[edge] < link_count()) link_siemens_[edge_link_[edge]] += edge_siemens[edge];
  }
  std::copy(ground_siemens.begin(), ground_siemens.end(), ground_siemens_.begin());
  for (std::size_t node = 0; node < free_nodes_; ++node) eliminate_node(node);
  find_roots();
}

void ResistorNetwork::eliminate_node(std::size_t node) noexcept {
  const std::size_t first = first_link_[node];
  const std::size_t last = first_link_[node + 1];
  for (std::size_t k = first_update_[node]; k < first_update_[node + 1]; ++k) {
    const auto [from, link] = updates_[k];
    const double siemens = link_siemens_[link];
    for (std::size_t other = link + 1; other < first_link_[from + 1]; ++other) {
      work_[neighbour_[other]] += siemens * share_[other];
    }
    ground_siemens_[node] += siemens * (ground_siemens_[from] * pivot_ohm_[from]);
  }
  double pivot = ground_siemens_[node];
  for (std::size_t link = first; link < last; ++link) {
    link_siemens_[link] += work_[neighbour_[link]];
    work_[neighbour_[link]] = 0.0;
    pivot += link_siemens_[link];
  }
  pivot_ohm_[node] = pivot > 0.0 ? 1.0 / pivot : 0.0;
  for (std::size_t link = first; link < last; ++link) share_[link] = link_siemens_[link] * pivot_ohm_[node];
}

void ResistorNetwork::find_roots() noexcept {
  for (std::size_t node = free_nodes_; node-- > 0;) {
    root_[node] = kGround;
    if (pivot_ohm_[node] == 0.0) {
      root_[node] = node;
      continue;
    }
    if (ground_siemens_[node] > 0.0) continue;
    for (std::size_t link = first_link_[node]; link < first_link_[node + 1]; ++link) {
      if (share_[link] > 0.0) {
        root_[node] = root_[neighbour_[link]];
        break;
      }
    }
  }
}

void ResistorNetwork::solve(Potentials& potentials) const noexcept {
  const auto row = [&](std::size_t node) { return potentials.row(static_cast<Eigen::Index>(node)); };
  for (std::size_t node = 0; node < free_nodes_; ++node) {
    for (std::size_t link = first_link_[node]; link < first_link_[node + 1]; ++link) {
      if (neighbour_[link] < free_nodes_) row(neighbour_[link]) += share_[link] * row(node);
    }
  }
  for (std::size_t node = free_nodes_; node-- > 0;) {
    row(node) *= pivot_ohm_[node];
    for (std::size_t link = first_link_[node]; link < first_link_[node + 1]; ++link) {
      row(node) += share_[link] * row(neighbour_[link]);
    }
  }
}

}  // namespace dermis::touch::compensation
