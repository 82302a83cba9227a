// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/compensation/circuit_model.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compensation/resistor_network.hpp"

namespace dermis::compensation {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Index = Eigen::Index;

/// The factor of a resistive network of lines grows with taxels times lines: 128x128 takes about 0.2 GB.
constexpr std::size_t kMostTaxelsOfResistiveLines = 128 * 128;

Index at(std::size_t index) {
  return static_cast<Index>(index);
}

double of_line(const std::vector<double>& ohms, std::size_t line) {
  return ohms.empty() ? 0.0 : ohms[line];
}

bool has_resistance(const std::vector<double>& ohms) {
  return std::any_of(ohms.begin(), ohms.end(), [](double ohm) { return ohm > 0.0; });
}

}  // namespace

/// Every reading is an affine function of the current I_ds that leaves sensed line s while line d is driven:
/// r = gain_s I_ds + offset_s. "Lines" counts the driven lines first, then the sensed ones; each has a resistance rho
/// at its head: the driver, or what stands between the line and the node that the amplifier holds.
///
/// The base network has those lines tied through their rho that stay tied in all scans: all lines when idle lines are
/// grounded and loaded. `potential_` holds, for each tied line, the response to 1 V behind its rho and, for each
/// floating line, to 1 A into its head. A scan ties one driven line, one sensed line, or both, on top: rank-1 changes
/// of which the potentials are known already. By reciprocity (Tellegen) a conductance g across the drops f of the scan
/// and h of the response to 1 V behind rho_s moves the current by dI_ds/dg = -f h, and rho_t with the currents i and k
/// into the network moves it by dI_ds/drho_t = i k.
struct CircuitModel::Implementation {
  explicit Implementation(ArrayDescription description);

  void set_resistors();
  void build_network();
  void solve(std::span<const double> siemens);
  void find_currents();
  void find_drops();
  void clear_isolated_lines();
  void scan();
  void read();
  void derive(std::size_t driven, std::size_t sensed, Eigen::Map<Eigen::RowVectorXd> row) const;
  [[nodiscard]] double current_by_resistor(std::size_t driven, std::size_t sensed, std::size_t line) const;

  [[nodiscard]] std::size_t reading(std::size_t driven, std::size_t sensed) const {
    return columns_are_driven ? array.index(sensed, driven) : array.index(driven, sensed);
  }
  [[nodiscard]] bool is_tied(std::size_t line) const { return line < driven_lines ? driven_tied : sensed_tied; }
  [[nodiscard]] bool is_held(std::size_t line) const { return is_tied(line) && rho[line] == 0.0; }
  [[nodiscard]] bool is_isolated(std::size_t line) const {
    return network->root(head[line]) != ResistorNetwork::kGround && driven_tied != sensed_tied;
  }
  [[nodiscard]] bool is_row(std::size_t line) const { return (line < driven_lines) != columns_are_driven; }
  /// The line at which a taxel hangs on the driven or sensed side, as an index of lines.
  [[nodiscard]] std::size_t driven_line(std::size_t taxel) const {
    return columns_are_driven ? taxel % array.cols : taxel / array.cols;
  }
  [[nodiscard]] std::size_t sensed_line(std::size_t taxel) const {
    return driven_lines + (columns_are_driven ? taxel / array.cols : taxel % array.cols);
  }

  ArrayDescription array;
  bool columns_are_driven;
  bool driven_tied;  // idle driven lines
  bool sensed_tied;  // idle sensed lines
  std::size_t driven_lines;
  std::size_t sensed_lines;
  std::size_t lines;
  std::size_t taxels;
  std::vector<double> rho;          // [lines]
  std::vector<double> rho_by_load;  // d rho / d load_ohm [sensed]
  std::vector<double> gain;         // d r / d I [sensed]
  std::vector<double> gain_by_load;
  std::vector<double> offset;  // r at no current [sensed]
  std::vector<double> emf;     // voltage behind rho from the amplifier's offset [sensed]
  std::vector<bool> held;      // [lines], as the network was built

  std::unique_ptr<ResistorNetwork> network;
  std::vector<ResistorNetwork::Edge> edges;  // taxels, then segments
  std::vector<double> edge_siemens;
  std::vector<double> ground_siemens;           // [free nodes]
  std::vector<std::size_t> head;                // [lines]
  std::vector<std::vector<std::size_t>> nodes;  // of each line
  std::vector<std::vector<std::size_t>> head_edges;

  // Columns: the lines, then the offsets of the amplifiers.
  ResistorNetwork::Potentials potential;  // [nodes, lines + 1]
  Matrix current;                         // out of the head of each line [lines, lines + 1]
  Matrix drop;                            // row node - column node at every taxel [lines + 1, taxels]
  Matrix forward;                  // drops of the scan, of the base network where sensed lines float [driven, taxels]
  Matrix adjoint;                  // drops for 1 V at a sensed line, driven lines as in the base [sensed, taxels]
  Matrix square;                   // what the line tied by the scan takes away [driven or sensed, taxels]
  std::vector<double> admittance;  // of the loop through a floating line's rho [lines]
  Matrix scan_current;             // I_ds [driven, sensed]
  std::vector<double> ratio;
};

CircuitModel::Implementation::Implementation(ArrayDescription description)
    : array(std::move(description)),
      columns_are_driven(array.readout.circuit == Circuit::flexitac),
      driven_tied(columns_are_driven || array.readout.idle_rows == IdleRows::grounded),
      sensed_tied(!columns_are_driven && array.readout.idle_columns == IdleColumns::loaded),
      driven_lines(array.driven_lines()),
      sensed_lines(array.sensed_lines()),
      lines(driven_lines + sensed_lines),
      taxels(array.taxel_count()),
      rho(lines),
      rho_by_load(sensed_lines),
      gain(sensed_lines),
      gain_by_load(sensed_lines),
      offset(sensed_lines),
      emf(sensed_lines),
      current(Matrix::Zero(at(lines), at(lines + 1))),
      drop(at(lines + 1), at(taxels)),
      forward(at(driven_lines), at(taxels)),
      adjoint(at(sensed_lines), at(taxels)),
      square(driven_tied == sensed_tied ? 0 : at(driven_tied ? sensed_lines : driven_lines), at(taxels)),
      admittance(lines),
      scan_current(at(driven_lines), at(sensed_lines)),
      ratio(taxels) {
  set_resistors();
}

// An amplifier of open-loop gain A0 and offset off (over the supply) reads r = (I RL - off) / (1 + 1/A0) and holds its
// input at off A0 / (1 + A0) + I RL / (1 + A0).
void CircuitModel::Implementation::set_resistors() {
  const Readout& readout = array.readout;
  std::copy(readout.drive_ohm.begin(), readout.drive_ohm.end(), rho.begin());
  for (std::size_t s = 0; s < sensed_lines; ++s) {
    double& rho_s = rho[driven_lines + s];
    const double load = readout.load_ohm[s];
    if (readout.circuit != Circuit::transimpedance) {
      rho_s = gain[s] = load;
      rho_by_load[s] = gain_by_load[s] = 1.0;
      continue;
    }
    const double inverse_gain = readout.amplifier_gain ? 1.0 / *readout.amplifier_gain : 0.0;
    const double off = readout.amplifier_offset_v.empty() ? 0.0 : readout.amplifier_offset_v[s] / *readout.supply_v;
    rho_by_load[s] = inverse_gain / (1.0 + inverse_gain);
    gain_by_load[s] = 1.0 / (1.0 + inverse_gain);
    rho_s = of_line(readout.column_switch_ohm, s) + load * rho_by_load[s];
    gain[s] = load * gain_by_load[s];
    offset[s] = -off * gain_by_load[s];
    emf[s] = off * gain_by_load[s];
  }
  std::vector<bool> now_held(lines);
  for (std::size_t line = 0; line < lines; ++line) now_held[line] = is_held(line);
  if (network != nullptr && now_held == held) return;
  held = std::move(now_held);
  build_network();
}

// Nodes are numbered from one end of the longer side of the array to the other, lines without resistance along it and
// held nodes last: every node then has few later neighbours.
void CircuitModel::Implementation::build_network() {
  const bool along_rows = array.rows >= array.cols;
  using Key = std::tuple<bool, std::size_t, bool, std::size_t, std::size_t>;  // held, block, kind, line, position
  std::vector<Key> keys;
  const auto number_of = [&](std::size_t line) { return line < driven_lines ? line : line - driven_lines; };
  for (std::size_t line = 0; line < lines; ++line) {
    const bool row = is_row(line);
    const std::size_t number = number_of(line);
    const bool resistive =
        of_line(row ? array.readout.row_segment_ohm : array.readout.column_segment_ohm, number) > 0.0;
    const std::size_t length = row ? array.cols : array.rows;
    const bool across = row == along_rows;  // the line lies within one block
    for (std::size_t position = 0; position < (resistive ? length : 1); ++position) {
      const std::size_t past_all = row ? array.cols : array.rows;
      const std::size_t block = across ? number : (resistive ? position : past_all);
      keys.emplace_back(held[line] && position == 0, block, !across, line, position);
    }
  }
  std::sort(keys.begin(), keys.end());
  nodes.assign(lines, {});
  for (std::size_t node = 0; node < keys.size(); ++node) {
    const auto& [is_held_node, block, kind, line, position] = keys[node];
    if (nodes[line].size() <= position) nodes[line].resize(position + 1);
    nodes[line][position] = node;
  }
  head.clear();
  for (const auto& of_line_nodes : nodes) head.push_back(of_line_nodes.front());

  edges.clear();
  edge_siemens.assign(taxels, 0.0);
  const std::size_t first_row = columns_are_driven ? driven_lines : 0;
  const std::size_t first_col = columns_are_driven ? 0 : driven_lines;
  const auto node_at = [&](std::size_t line, std::size_t position) {
    return nodes[line][nodes[line].size() > 1 ? position : 0];
  };
  for (std::size_t row = 0; row < array.rows; ++row) {
    for (std::size_t col = 0; col < array.cols; ++col) {
      edges.emplace_back(node_at(first_row + row, col), node_at(first_col + col, row));
    }
  }
  for (std::size_t line = 0; line < lines; ++line) {
    const Readout& readout = array.readout;
    for (std::size_t position = 0; position + 1 < nodes[line].size(); ++position) {
      edges.emplace_back(nodes[line][position], nodes[line][position + 1]);
      edge_siemens.push_back(1.0 /
                             (is_row(line) ? readout.row_segment_ohm : readout.column_segment_ohm)[number_of(line)]);
    }
  }
  head_edges.assign(lines, {});
  for (std::size_t line = 0; line < lines; ++line) {
    if (!held[line]) continue;
    for (std::size_t edge = 0; edge < edges.size(); ++edge) {
      if (edges[edge].first == head[line] || edges[edge].second == head[line]) head_edges[line].push_back(edge);
    }
  }
  const auto held_nodes = static_cast<std::size_t>(std::count(held.begin(), held.end(), true));
  network = std::make_unique<ResistorNetwork>(keys.size(), keys.size() - held_nodes, edges);
  ground_siemens.assign(keys.size() - held_nodes, 0.0);
  potential.resize(at(keys.size()), at(lines + 1));
}

void CircuitModel::Implementation::solve(std::span<const double> siemens) {
  std::copy(siemens.begin(), siemens.end(), edge_siemens.begin());
  std::fill(ground_siemens.begin(), ground_siemens.end(), 0.0);
  potential.setZero();
  for (std::size_t line = 0; line < lines; ++line) {
    const double source = is_tied(line) && !held[line] ? 1.0 / rho[line] : 1.0;
    potential(at(head[line]), at(line)) = source;
    if (line >= driven_lines) potential(at(head[line]), at(lines)) = source * emf[line - driven_lines];
    if (is_tied(line) && !held[line]) ground_siemens[head[line]] = 1.0 / rho[line];
  }
  network->eliminate(edge_siemens, ground_siemens);
  network->solve(potential);
  find_currents();
  find_drops();
  if (driven_tied != sensed_tied) clear_isolated_lines();
  scan();
  read();
}

void CircuitModel::Implementation::find_currents() {
  for (std::size_t line = 0; line < lines; ++line) {
    if (!is_tied(line)) continue;
    auto out = current.row(at(line));
    const auto at_head = potential.row(at(head[line]));
    if (held[line]) {
      out.setZero();
      for (const std::size_t edge : head_edges[line]) {
        const auto& [a, b] = edges[edge];
        out += edge_siemens[edge] * (potential.row(at(a == head[line] ? b : a)) - at_head);
      }
      continue;
    }
    out = at_head / rho[line];
    out(at(line)) -= 1.0 / rho[line];
    if (line >= driven_lines) out(at(lines)) -= emf[line - driven_lines] / rho[line];
  }
}

void CircuitModel::Implementation::find_drops() {
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto& [row, col] = edges[taxel];
    drop.col(at(taxel)) = (potential.row(at(row)) - potential.row(at(col))).transpose();
  }
}

// A floating line without a taxel: nothing flows into it, so its potential while driven is that of its source. While it
// is idle, a first taxel there would leave the line at the potential of the taxel's other end: no drop.
void CircuitModel::Implementation::clear_isolated_lines() {
  const std::size_t first = driven_tied ? driven_lines : 0;
  const std::size_t last = driven_tied ? lines : driven_lines;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const std::size_t own = driven_tied ? sensed_line(taxel) : driven_line(taxel);
    if (!is_isolated(own)) continue;
    for (std::size_t line = first; line < last; ++line) drop(at(line), at(taxel)) = 0.0;
    drop(at(own), at(taxel)) = is_row(own) ? 1.0 : -1.0;
  }
}

void CircuitModel::Implementation::scan() {
  const auto sensed_rows = [&] { return at(driven_lines); };
  const auto offsets = drop.row(at(lines));
  for (std::size_t line = 0; line < lines; ++line) {
    const double self = potential(at(head[line]), at(line));
    admittance[line] = is_tied(line) || is_isolated(line) ? 0.0 : 1.0 / (rho[line] + self);
  }
  if (driven_tied && sensed_tied) {
    forward = drop.topRows(at(driven_lines)).rowwise() + offsets;
    adjoint = drop.middleRows(sensed_rows(), at(sensed_lines));
    for (std::size_t d = 0; d < driven_lines; ++d) {
      for (std::size_t s = 0; s < sensed_lines; ++s) {
        scan_current(at(d), at(s)) = current(at(driven_lines + s), at(d)) + current(at(driven_lines + s), at(lines));
      }
    }
  } else if (sensed_tied) {
    adjoint = drop.middleRows(sensed_rows(), at(sensed_lines));
    for (std::size_t d = 0; d < driven_lines; ++d) {
      const bool isolated = is_isolated(d);
      const double source = isolated ? 1.0 : 1.0 - potential(at(head[d]), at(lines));
      const double scale = isolated ? 1.0 : admittance[d];
      forward.row(at(d)) = source * scale * drop.row(at(d)) + offsets;
      square.row(at(d)) = scale * forward.row(at(d)).cwiseProduct(drop.row(at(d)));
      for (std::size_t s = 0; s < sensed_lines; ++s) {
        scan_current(at(d), at(s)) =
            current(at(driven_lines + s), at(lines)) + source * admittance[d] * current(at(driven_lines + s), at(d));
      }
    }
  } else if (driven_tied) {
    forward = drop.topRows(at(driven_lines));
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      const std::size_t line = driven_lines + s;
      adjoint.row(at(s)) = (is_isolated(line) ? 1.0 : admittance[line]) * drop.row(at(line));
      square.row(at(s)) = adjoint.row(at(s)).cwiseProduct(adjoint.row(at(s)));
      for (std::size_t d = 0; d < driven_lines; ++d) {
        scan_current(at(d), at(s)) = admittance[line] * current(at(d), at(line));
      }
    }
  } else {
    for (std::size_t d = 0; d < driven_lines; ++d) {
      for (std::size_t s = 0; s < sensed_lines; ++s) {
        const std::size_t line = driven_lines + s;
        const double ohm = potential(at(head[d]), at(d)) - potential(at(head[line]), at(d)) -
                           potential(at(head[d]), at(line)) + potential(at(head[line]), at(line));
        const bool joined = network->root(head[d]) == network->root(head[line]);
        scan_current(at(d), at(s)) = joined ? 1.0 / (rho[d] + rho[line] + ohm) : 0.0;
      }
    }
  }
}

void CircuitModel::Implementation::read() {
  for (std::size_t d = 0; d < driven_lines; ++d) {
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      ratio[reading(d, s)] = gain[s] * scan_current(at(d), at(s)) + offset[s];
    }
  }
}

void CircuitModel::Implementation::derive(std::size_t driven, std::size_t sensed,
                                          Eigen::Map<Eigen::RowVectorXd> row) const {
  const Index d = at(driven);
  const Index s = at(sensed);
  const std::size_t line = driven_lines + sensed;
  if (driven_tied || sensed_tied) {
    row = -gain[sensed] * forward.row(d).cwiseProduct(adjoint.row(s));
    // The share of the tied line in the current of the other: what flows there when the scan does not tie it.
    if (!driven_tied) row += gain[sensed] * current(at(line), d) * square.row(d);
    if (!sensed_tied) row += gain[sensed] * current(d, at(line)) * square.row(s);
    return;
  }
  const std::size_t root_d = network->root(head[driven]);
  const std::size_t root_s = network->root(head[line]);
  const double amperes = scan_current(d, s);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto& [a, b] = edges[taxel];
    const std::size_t root_a = network->root(a);
    const std::size_t root_b = network->root(b);
    double volts = 0.0;
    if (root_d == root_s) {
      if (root_a == root_b) volts = amperes * (drop(d, at(taxel)) - drop(at(line), at(taxel)));
    } else if ((root_a == root_d && root_b == root_s) || (root_a == root_s && root_b == root_d)) {
      volts = 1.0;
    }
    row(at(taxel)) = gain[sensed] * volts * volts;
  }
}

double CircuitModel::Implementation::current_by_resistor(std::size_t driven, std::size_t sensed,
                                                         std::size_t line) const {
  const Index d = at(driven);
  const Index s = at(driven_lines + sensed);
  const Index t = at(line);
  const double amperes = scan_current(d, at(sensed));
  const bool is_driver = line < driven_lines;
  if (driven_tied && sensed_tied) return (current(t, d) + current(t, at(lines))) * current(t, s);
  if (sensed_tied) {
    const double share = current(s, d);
    const double source = 1.0 - potential(at(head[driven]), at(lines));
    if (is_driver) return line == driven ? -source * admittance[driven] * admittance[driven] * share : 0.0;
    const double by_scan = current(t, at(lines)) + source * admittance[driven] * current(t, d);
    return by_scan * (current(t, s) - share * admittance[driven] * current(t, d));
  }
  const double loop = admittance[driven_lines + sensed];
  if (driven_tied) {
    if (!is_driver) return t == s ? -amperes * loop : 0.0;
    return loop * current(t, s) * (current(t, d) - current(d, s) * loop * current(t, s));
  }
  return line == driven || t == s ? -amperes * amperes : 0.0;
}

CircuitModel::CircuitModel(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
CircuitModel::CircuitModel(CircuitModel&&) noexcept = default;
CircuitModel& CircuitModel::operator=(CircuitModel&&) noexcept = default;
CircuitModel::~CircuitModel() = default;

Result<CircuitModel> CircuitModel::create(const ArrayDescription& array) {
  if (Status valid = array.validate(); !valid) return valid.error();
  const Readout& readout = array.readout;
  if (readout.circuit == Circuit::none || array.has_unknown_circuit()) {
    return bad_input("readout: the circuit and all its resistances must be known to compute readings");
  }
  if ((has_resistance(readout.row_segment_ohm) || has_resistance(readout.column_segment_ohm)) &&
      array.taxel_count() > kMostTaxelsOfResistiveLines) {
    return bad_input("readout: lines with resistance are solved up to " + std::to_string(kMostTaxelsOfResistiveLines) +
                     " taxels: leave row_segment_ohm and column_segment_ohm out");
  }
  return CircuitModel(std::make_unique<Implementation>(array));
}

void CircuitModel::solve(std::span<const double> siemens) noexcept {
  assert(siemens.size() == implementation_->taxels);
  implementation_->solve(siemens);
}

void CircuitModel::set_resistors(std::span<const double> drive_ohm, std::span<const double> load_ohm) {
  Readout& readout = implementation_->array.readout;
  assert(drive_ohm.size() == readout.drive_ohm.size() && load_ohm.size() == readout.load_ohm.size());
  readout.drive_ohm.assign(drive_ohm.begin(), drive_ohm.end());
  readout.load_ohm.assign(load_ohm.begin(), load_ohm.end());
  implementation_->set_resistors();
}

std::span<const double> CircuitModel::ratio() const noexcept {
  return implementation_->ratio;
}

void CircuitModel::taxel_jacobian(std::span<double> jacobian) const noexcept {
  const std::size_t taxels = implementation_->taxels;
  assert(jacobian.size() == taxels * taxels);
  for (std::size_t d = 0; d < implementation_->driven_lines; ++d) {
    for (std::size_t s = 0; s < implementation_->sensed_lines; ++s) {
      double* row = jacobian.data() + implementation_->reading(d, s) * taxels;
      implementation_->derive(d, s, Eigen::Map<Eigen::RowVectorXd>(row, at(taxels)));
    }
  }
}

void CircuitModel::drive_jacobian(std::span<double> jacobian) const noexcept {
  const std::size_t lines = implementation_->driven_lines;
  assert(jacobian.size() == implementation_->taxels * lines);
  for (std::size_t d = 0; d < lines; ++d) {
    for (std::size_t s = 0; s < implementation_->sensed_lines; ++s) {
      for (std::size_t line = 0; line < lines; ++line) {
        jacobian[implementation_->reading(d, s) * lines + line] =
            implementation_->gain[s] * implementation_->current_by_resistor(d, s, line);
      }
    }
  }
}

void CircuitModel::load_jacobian(std::span<double> jacobian) const noexcept {
  const std::size_t lines = implementation_->sensed_lines;
  assert(jacobian.size() == implementation_->taxels * lines);
  for (std::size_t d = 0; d < implementation_->driven_lines; ++d) {
    for (std::size_t s = 0; s < lines; ++s) {
      for (std::size_t line = 0; line < lines; ++line) {
        const double by_rho = implementation_->current_by_resistor(d, s, implementation_->driven_lines + line);
        double& entry = jacobian[implementation_->reading(d, s) * lines + line];
        entry = implementation_->gain[s] * by_rho * implementation_->rho_by_load[line];
        if (line == s) entry += implementation_->gain_by_load[s] * implementation_->scan_current(at(d), at(s));
      }
    }
  }
}

}  // namespace dermis::compensation
