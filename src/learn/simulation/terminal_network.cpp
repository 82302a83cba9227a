// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/terminal_network.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace dermis::learn::simulation {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

/// A conductance below this is none, so that what it leads to stays finite.
constexpr double kOpenSiemens = 1e-100;

double segment_ohm(std::span<const double> ohms, Index line) {
  return ohms.empty() ? 0.0 : ohms[static_cast<std::size_t>(line)];
}

/// The nodes of lines with resistance. First come the terminals of the driven and of the sensed lines. Then comes each
/// taxel's node on a line of more than 0 ohm, but for the one at the terminal.
class LineNodes {
 public:
  LineNodes(Index driven, Index sensed, std::span<const double> driven_ohm, std::span<const double> sensed_ohm)
      : node_count_(driven + sensed), on_driven_(driven, sensed), on_sensed_(driven, sensed) {
    for (Index i = 0; i < driven; ++i) {
      for (Index j = 0; j < sensed; ++j) {
        on_driven_(i, j) = place(j, segment_ohm(driven_ohm, i), i);
        on_sensed_(i, j) = place(i, segment_ohm(sensed_ohm, j), driven + j);
      }
    }
  }

  [[nodiscard]] Index count() const { return node_count_; }
  [[nodiscard]] Index on_driven(Index i, Index j) const { return on_driven_(i, j); }
  [[nodiscard]] Index on_sensed(Index i, Index j) const { return on_sensed_(i, j); }

 private:
  Index place(Index along, double ohm, Index terminal) { return along == 0 || ohm == 0.0 ? terminal : node_count_++; }

  Index node_count_;
  Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic> on_driven_;
  Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic> on_sensed_;
};

/// Nodal equations, split into terminals and inner nodes:
///   inner [inner, inner], between [inner, terminal] >= 0, direct [terminal, terminal] >= 0
class NodalEquations {
 public:
  NodalEquations(Index terminals, Index nodes)
      : terminals_(terminals),
        direct_(TerminalNetwork::Zero(terminals, terminals)),
        inner_(nodes - terminals, nodes - terminals),
        between_(nodes - terminals, terminals) {}

  void connect(Index a, Index b, double siemens) {
    if (a < b) std::swap(a, b);
    if (a == b) return;
    if (a < terminals_) {
      direct_(a, b) += siemens;
      direct_(b, a) += siemens;
      return;
    }
    const Index inner = a - terminals_;
    inner_entries_.emplace_back(inner, inner, siemens);
    if (b < terminals_) {
      between_entries_.emplace_back(inner, b, siemens);
      return;
    }
    inner_entries_.emplace_back(b - terminals_, b - terminals_, siemens);
    inner_entries_.emplace_back(inner, b - terminals_, -siemens);
  }

  /// Without the inner nodes (Kron reduction): direct + between^T inner^-1 between.
  TerminalNetwork reduced() {
    if (inner_.rows() == 0) return direct_;
    inner_.setFromTriplets(inner_entries_.begin(), inner_entries_.end());
    between_.setFromTriplets(between_entries_.begin(), between_entries_.end());
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors(inner_);
    assert(factors.info() == Eigen::Success);
    TerminalNetwork network = direct_;
    for (Index terminal = 0; terminal < terminals_; ++terminal) {
      const Eigen::VectorXd voltage = factors.solve(Eigen::VectorXd(between_.col(terminal)));
      network.col(terminal) += between_.transpose() * voltage;
    }
    return network;
  }

 private:
  Index terminals_;
  TerminalNetwork direct_;
  Eigen::SparseMatrix<double> inner_;  // lower triangle
  Eigen::SparseMatrix<double> between_;
  std::vector<Eigen::Triplet<double>> inner_entries_;
  std::vector<Eigen::Triplet<double>> between_entries_;
};

}  // namespace

FilmTables film_tables(const Film& film, const Table& newtons) {
  const Index driven = newtons.rows();
  const Index sensed = newtons.cols();
  const double of_sensed = 1.0 / (film.unloaded_ohm * static_cast<double>(sensed));
  const double of_driven = 1.0 / (film.unloaded_ohm * static_cast<double>(driven));
  FilmTables tables{Table(driven - 1, sensed), Table(driven, sensed - 1)};
  for (Index i = 0; i < driven; ++i) {
    for (Index j = 0; j < sensed; ++j) {
      if (i > 0) tables.along_sensed(i - 1, j) = of_sensed + film.rise(newtons(i - 1, j), newtons(i, j));
      if (j > 0) tables.along_driven(i, j - 1) = of_driven + film.rise(newtons(i, j - 1), newtons(i, j));
    }
  }
  return tables;
}

TerminalNetwork lumped_network(const Table& taxels, const FilmTables& film) {
  const Index driven = taxels.rows();
  const Index sensed = taxels.cols();
  TerminalNetwork network = TerminalNetwork::Zero(driven + sensed, driven + sensed);
  network.topRightCorner(driven, sensed) = taxels;
  network.bottomLeftCorner(sensed, driven) = taxels.transpose();
  const auto join = [&](Index first, double siemens) {
    network(first, first + 1) = network(first + 1, first) = siemens;
  };
  for (Index i = 0; i < film.along_sensed.rows(); ++i) join(i, film.along_sensed.row(i).sum());
  for (Index j = 0; j < film.along_driven.cols(); ++j) join(driven + j, film.along_driven.col(j).sum());
  return network;
}

TerminalNetwork resistive_network(const Table& taxels, std::span<const double> driven_segment_ohm,
                                  std::span<const double> sensed_segment_ohm, const FilmTables& film) {
  const Index driven = taxels.rows();
  const Index sensed = taxels.cols();
  const LineNodes nodes(driven, sensed, driven_segment_ohm, sensed_segment_ohm);
  NodalEquations equations(driven + sensed, nodes.count());
  for (Index i = 0; i < driven; ++i) {
    for (Index j = 0; j < sensed; ++j) {
      const double along_driven = segment_ohm(driven_segment_ohm, i);
      const double along_sensed = segment_ohm(sensed_segment_ohm, j);
      equations.connect(nodes.on_driven(i, j), nodes.on_sensed(i, j), taxels(i, j));
      if (j > 0 && along_driven > 0.0) {
        equations.connect(nodes.on_driven(i, j - 1), nodes.on_driven(i, j), 1.0 / along_driven);
      }
      if (i > 0 && along_sensed > 0.0) {
        equations.connect(nodes.on_sensed(i - 1, j), nodes.on_sensed(i, j), 1.0 / along_sensed);
      }
      if (i > 0 && film.along_sensed.size() > 0) {
        equations.connect(nodes.on_driven(i - 1, j), nodes.on_driven(i, j), film.along_sensed(i - 1, j));
      }
      if (j > 0 && film.along_driven.size() > 0) {
        equations.connect(nodes.on_sensed(i, j - 1), nodes.on_sensed(i, j), film.along_driven(i, j - 1));
      }
    }
  }
  return equations.reduced();
}

// Gaussian elimination, one terminal after another, written so that it only adds (Grassmann, Taksar and Heyman 1985). A
// removed terminal leaves a conductance between each two of its neighbours, `c_i c_j / (sum of all that it was
// connected to)`: the star-mesh transform. It also leaves one between each of them and the sources.
Solution solve(TerminalNetwork network, const Electronics& electronics) {
  const Index terminals = network.rows();
  const Index cases = electronics.source_v.cols();
  Table current = electronics.current_a;
  ArrayXd to_sources = ArrayXd::Zero(terminals);  // by way of removed terminals
  ArrayXd inner(terminals);                       // all conductance of a terminal but its own series resistor
  ArrayXd impedance(terminals);                   // its voltage for a current into it, neighbours and sources at 0 V
  ArrayXd share(terminals);                       // its voltage for 1 V of its own source, the others at 0 V
  for (Index k = 0; k < terminals; ++k) {
    const Index left = terminals - k - 1;
    const Eigen::VectorXd neighbour = network.col(k).tail(left);
    const double ohm = electronics.series_ohm(k);
    inner(k) = to_sources(k) + neighbour.sum();
    const bool is_open = std::isinf(ohm);
    share(k) = is_open ? 0.0 : 1.0 / (1.0 + ohm * inner(k));
    impedance(k) = is_open ? 1.0 / std::max(inner(k), kOpenSiemens) : ohm * share(k);
    network.bottomRightCorner(left, left).noalias() += impedance(k) * neighbour * neighbour.transpose();
    to_sources.tail(left) += neighbour.array() * (impedance(k) * to_sources(k) + share(k));
    current.bottomRows(left).noalias() +=
        neighbour * (impedance(k) * current.row(k) + share(k) * electronics.source_v.row(k));
  }
  Solution solution{Table(terminals, cases), Table(terminals, cases)};
  for (Index k = terminals - 1; k >= 0; --k) {
    const Index left = terminals - k - 1;
    const auto source = electronics.source_v.row(k);
    current.row(k).noalias() += network.col(k).tail(left).transpose() * solution.voltage_v.bottomRows(left);
    solution.voltage_v.row(k) = impedance(k) * current.row(k) + share(k) * source;
    solution.sunk_a.row(k) = share(k) * (current.row(k) - inner(k) * source);
  }
  return solution;
}

}  // namespace dermis::learn::simulation
