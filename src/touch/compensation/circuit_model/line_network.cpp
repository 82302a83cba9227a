// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/line_network.hpp"

#include <algorithm>

namespace dermis::touch::compensation {
namespace {

using Edges = std::vector<ResistorNetwork::Edge>;
using LineNodes = std::vector<std::vector<std::size_t>>;  // of every line, from its head on

/// Where a node stands in the order of elimination: the members are compared in turn.
struct NodePlace {
  bool is_held = false;
  std::size_t block = 0;
  bool is_along = false;
  std::size_t line = 0;
  std::size_t position = 0;  // on the line
  auto operator<=>(const NodePlace&) const = default;
};

/// Taxels of a line.
std::size_t length_of(const ScannedLines& lines, std::size_t line) {
  return lines.is_row(line) ? lines.array().cols : lines.array().rows;
}

// Nodes are numbered from one end of the longer side of the array to the other. Lines without resistance along it and
// held nodes are last, so every node has few later neighbours.
NodePlace place_of(const ScannedLines& lines, std::size_t line, std::size_t position) {
  const bool is_along = lines.is_row(line) != (lines.array().rows >= lines.array().cols);
  const std::size_t past_all = length_of(lines, line);
  const std::size_t along = lines.segment_ohm(line) > 0.0 ? position : past_all;
  return {lines.is_held(line) && position == 0, is_along ? along : lines.number(line), is_along, line, position};
}

LineNodes number_nodes(const ScannedLines& lines) {
  std::vector<NodePlace> places;
  LineNodes nodes(lines.count());
  for (std::size_t line = 0; line < lines.count(); ++line) {
    nodes[line].resize(lines.segment_ohm(line) > 0.0 ? length_of(lines, line) : 1);
    for (std::size_t position = 0; position < nodes[line].size(); ++position) {
      places.push_back(place_of(lines, line, position));
    }
  }
  std::sort(places.begin(), places.end());
  for (std::size_t node = 0; node < places.size(); ++node) nodes[places[node].line][places[node].position] = node;
  return nodes;
}

std::vector<std::size_t> heads(const LineNodes& nodes) {
  std::vector<std::size_t> head;
  for (const std::vector<std::size_t>& of_line : nodes) head.push_back(of_line.front());
  return head;
}

std::size_t node_at(const LineNodes& nodes, std::size_t line, std::size_t position) {
  return nodes[line][nodes[line].size() > 1 ? position : 0];
}

Edges connect(const ScannedLines& lines, const LineNodes& nodes) {
  Edges edges;
  for (std::size_t row = 0; row < lines.array().rows; ++row) {
    for (std::size_t col = 0; col < lines.array().cols; ++col) {
      edges.emplace_back(node_at(nodes, lines.row_line(row), col), node_at(nodes, lines.column_line(col), row));
    }
  }
  for (const std::vector<std::size_t>& line : nodes) {
    for (std::size_t position = 0; position + 1 < line.size(); ++position) {
      edges.emplace_back(line[position], line[position + 1]);
    }
  }
  return edges;
}

/// Between two lines of single nodes one edge, else one a taxel.
std::vector<std::size_t> connect_film(const ScannedLines& lines, const LineNodes& nodes, Edges& edges) {
  std::vector<std::size_t> counts;
  const auto connect_lines = [&](std::size_t line, std::size_t next) {
    counts.push_back(std::max(nodes[line].size(), nodes[next].size()));
    for (std::size_t position = 0; position < counts.back(); ++position) {
      edges.emplace_back(node_at(nodes, line, position), node_at(nodes, next, position));
    }
  };
  if (!lines.has_film()) return counts;
  for (std::size_t row = 0; row + 1 < lines.array().rows; ++row) {
    connect_lines(lines.row_line(row), lines.row_line(row + 1));
  }
  for (std::size_t col = 0; col + 1 < lines.array().cols; ++col) {
    connect_lines(lines.column_line(col), lines.column_line(col + 1));
  }
  return counts;
}

/// All that two lines have together. The rest above the unloaded film is where the taxels beside it conduct. Taxel k of
/// the first line is taxels[k * along], its neighbour stands `beside` after it.
void spread_film(double together, double unloaded, const double* taxels, std::size_t along, std::size_t beside,
                 std::span<double> edges) noexcept {
  const auto count = static_cast<double>(edges.size());
  const double rise = edges.size() > 1 ? std::max(together - unloaded, 0.0) : 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < edges.size(); ++k) sum += taxels[k * along] + taxels[k * along + beside];
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double share = sum > 0.0 ? (taxels[k * along] + taxels[k * along + beside]) / sum : 1.0 / count;
    edges[k] = (together - rise) / count + rise * share;
  }
}

std::vector<double> segment_conductances(const ScannedLines& lines, const LineNodes& nodes, std::size_t edges) {
  std::vector<double> siemens(lines.taxels(), 0.0);
  for (std::size_t line = 0; line < lines.count(); ++line) {
    siemens.insert(siemens.end(), nodes[line].size() - 1, 1.0 / lines.segment_ohm(line));
  }
  siemens.resize(edges);
  return siemens;
}

std::vector<std::vector<std::size_t>> edges_at_held_heads(const ScannedLines& lines, const LineNodes& nodes,
                                                          const Edges& edges) {
  std::vector<std::vector<std::size_t>> found(lines.count());
  for (std::size_t line = 0; line < lines.count(); ++line) {
    if (!lines.is_held(line)) continue;
    const std::size_t head = nodes[line].front();
    for (std::size_t edge = 0; edge < edges.size(); ++edge) {
      if (edges[edge].first == head || edges[edge].second == head) found[line].push_back(edge);
    }
  }
  return found;
}

std::size_t count_nodes(const LineNodes& nodes) {
  std::size_t count = 0;
  for (const std::vector<std::size_t>& of_line : nodes) count += of_line.size();
  return count;
}

std::size_t count_held(const ScannedLines& lines) {
  const std::vector<bool> held = lines.held();
  return static_cast<std::size_t>(std::count(held.begin(), held.end(), true));
}

}  // namespace

LineNetwork::LineNetwork(const ScannedLines& lines) : LineNetwork(lines, number_nodes(lines)) {}

LineNetwork::LineNetwork(const ScannedLines& lines, const LineNodes& nodes)
    : head_(heads(nodes)),
      edges_(connect(lines, nodes)),
      film_counts_(connect_film(lines, nodes, edges_)),
      edge_siemens_(segment_conductances(lines, nodes, edges_.size())),
      head_edges_(edges_at_held_heads(lines, nodes, edges_)),
      nodes_(count_nodes(nodes)),
      ground_siemens_(nodes_ - count_held(lines), 0.0),
      network_(nodes_, ground_siemens_.size(), edges_) {}

void LineNetwork::eliminate(const ScannedLines& lines, std::span<const double> siemens) noexcept {
  std::copy(siemens.begin(), siemens.end(), edge_siemens_.begin());
  if (!film_counts_.empty()) copy_film(lines, siemens);
  std::fill(ground_siemens_.begin(), ground_siemens_.end(), 0.0);
  for (std::size_t line = 0; line < lines.count(); ++line) {
    if (lines.is_tied(line) && !lines.is_held(line)) ground_siemens_[head_[line]] = 1.0 / lines.rho(line);
  }
  network_.eliminate(edge_siemens_, ground_siemens_);
}

void LineNetwork::copy_film(const ScannedLines& lines, std::span<const double> siemens) noexcept {
  const ArrayDescription& array = lines.array();
  const FilmConductances& film = lines.film();
  const std::size_t rows = film.between_rows.size();
  double* of_pair = edge_siemens_.data() + edge_siemens_.size();
  for (std::size_t pair = film_counts_.size(); pair-- > 0;) {
    const bool is_of_rows = pair < rows;
    const double together = is_of_rows ? film.between_rows[pair] : film.between_cols[pair - rows];
    const double* const first = &siemens[is_of_rows ? pair * array.cols : pair - rows];
    const std::size_t along = is_of_rows ? 1 : array.cols;
    const std::size_t beside = is_of_rows ? array.cols : 1;
    of_pair -= film_counts_[pair];
    spread_film(together, 1.0 / array.readout.film->unloaded_ohm, first, along, beside, {of_pair, film_counts_[pair]});
  }
}

}  // namespace dermis::touch::compensation
