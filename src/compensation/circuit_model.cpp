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

#include "compensation/matrix_product.hpp"
#include "compensation/readout_parts.hpp"
#include "compensation/resistor_network.hpp"
#include "compensation/sensed_line.hpp"

namespace dermis::compensation {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Index = Eigen::Index;

/// Potentials are kept for every pair of a scanned line and a node: 0.3 GB.
constexpr std::size_t kMostPotentials = std::size_t{1} << 25U;

Index at(std::size_t index) {
  return static_cast<Index>(index);
}

double of_line(const std::vector<double>& ohms, std::size_t line) {
  return ohms.empty() ? 0.0 : ohms[line];
}

std::size_t potential_count(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  const bool resistive = has_resistive_lines(readout);
  const std::size_t lines = array.rows + array.cols;
  const bool two_terminal = readout.idle_rows == IdleRows::floating && readout.idle_columns == IdleColumns::floating;
  if (two_terminal) return array.taxel_count() * (resistive ? 2 * array.taxel_count() : lines);
  return array.taxel_count() * (resistive ? 2 * lines : lines);
}

}  // namespace

/// Every reading is an affine function of the current I_ds that leaves sensed line s while line d is driven:
/// r = gain_s I_ds + offset_s. "Lines" counts the driven lines first, then the sensed ones; each has a resistance rho
/// at its head: the driver, or what stands between the line and the node that the amplifier holds.
///
/// The base network has those lines tied through their rho that stay tied in all scans: all lines when idle lines are
/// grounded and loaded. `potential` holds, for each tied line, the response to 1 V behind its rho and, for each
/// floating line, to 1 A into its head. A scan ties one driven or one sensed line on top, a rank-1 change of which the
/// potentials are known already (Sherman-Morrison). By reciprocity (Tellegen) a conductance g across the drops f of the
/// scan and h of the response to 1 V behind rho_s moves the current by dI_ds/dg = -f h, and rho_t with the currents i
/// and k into the network moves it by dI_ds/drho_t = i k.
struct CircuitModel::Implementation {
  explicit Implementation(ArrayDescription description);

  void set_resistors();
  void build_network();
  void solve(std::span<const double> siemens);
  void respond();
  void find_currents();
  void find_drops();
  void scan_tied_lines();
  void scan_floating_driven_lines();
  void scan_floating_sensed_lines();
  void scan_two_terminals();
  void drive_floating_line(std::size_t line);
  void clear_isolated_lines(std::size_t driven, Matrix::RowXpr drops) const;
  /// d reading / d taxel for the taxels from `first` on.
  void derive(std::size_t driven, std::size_t sensed, std::size_t first, std::span<double> out) const;
  [[nodiscard]] double two_terminal_drop(std::size_t driven, std::size_t sensed, std::size_t taxel) const;
  void multiply_tied(std::span<const double> change, std::span<double> product);
  void multiply_two_terminals(std::span<const double> change, std::span<double> product);
  [[nodiscard]] double current_by_resistor(std::size_t driven, std::size_t sensed, std::size_t line) const;

  [[nodiscard]] std::size_t reading(std::size_t driven, std::size_t sensed) const {
    return columns_are_driven ? array.index(sensed, driven) : array.index(driven, sensed);
  }
  [[nodiscard]] bool is_tied(std::size_t line) const { return line < driven_lines ? driven_tied : sensed_tied; }
  [[nodiscard]] bool is_held(std::size_t line) const { return is_tied(line) && rho[line] == 0.0; }
  [[nodiscard]] bool is_two_terminal() const { return !driven_tied && !sensed_tied; }
  /// A floating line without a taxel, where the others are tied.
  [[nodiscard]] bool is_isolated(std::size_t line) const {
    return network->root(head[line]) != ResistorNetwork::kGround;
  }
  [[nodiscard]] bool is_joined(std::size_t a, std::size_t b) const { return network->root(a) == network->root(b); }
  /// What the driver of a floating line sees: 1 V less the potential that the amplifiers' offsets leave there.
  [[nodiscard]] double source_of(std::size_t driven) const {
    return is_isolated(driven) ? 1.0 : 1.0 - potential(at(head[driven]), at(lines));
  }
  [[nodiscard]] bool is_row(std::size_t line) const { return (line < driven_lines) != columns_are_driven; }
  /// The line of this taxel on the side that floats.
  [[nodiscard]] std::size_t floating_line(std::size_t taxel) const {
    const bool row = is_row(driven_tied ? driven_lines : 0);
    return (driven_tied ? driven_lines : 0) + (row ? taxel / array.cols : taxel % array.cols);
  }

  ArrayDescription array;
  bool columns_are_driven;
  bool driven_tied;  // idle driven lines
  bool sensed_tied;  // idle sensed lines
  std::size_t driven_lines;
  std::size_t sensed_lines;
  std::size_t lines;
  std::size_t taxels;
  std::vector<double> rho;  // [lines]
  std::vector<SensedLine> sensed_head;
  std::vector<bool> held;  // [lines], as the network was built

  std::unique_ptr<ResistorNetwork> network;
  std::vector<ResistorNetwork::Edge> edges;  // taxels, then segments
  std::vector<double> edge_siemens;
  std::vector<double> ground_siemens;           // [free nodes]
  std::vector<std::size_t> head;                // [lines]
  std::vector<std::vector<std::size_t>> nodes;  // of each line
  std::vector<std::vector<std::size_t>> head_edges;

  // Two terminals: [nodes, readings]. Else the columns are the lines, then the offsets of the amplifiers.
  ResistorNetwork::Potentials potential;
  Matrix current;                  // out of the head of each line [lines, lines + 1]
  Matrix drop;                     // row node - column node at every taxel [lines + 1, taxels]
  Matrix forward;                  // drops of the scan, of the base network where sensed lines float [driven, taxels]
  Matrix adjoint;                  // drops for 1 V at a sensed line, driven lines as in the base [sensed, taxels]
  Matrix square;                   // what the line tied by the scan takes away [driven or sensed, taxels]
  std::vector<double> admittance;  // of the loop through a floating line's rho [lines]
  Matrix scan_current;             // I_ds [driven, sensed]
  std::vector<double> ratio;

  // What products with the Jacobian need.
  Matrix adjoint_by_taxel;  // [taxels, sensed]
  Matrix weighted;          // [driven, taxels]
  Matrix pairs;             // [driven, sensed]
  Eigen::VectorXd squares;
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
      sensed_head(sensed_lines),
      admittance(lines),
      scan_current(at(driven_lines), at(sensed_lines)),
      ratio(taxels) {
  squares.resize(at(taxels));
  if (!is_two_terminal()) {
    current.setZero(at(lines), at(lines + 1));
    drop.resize(at(lines + 1), at(taxels));
    forward.resize(at(driven_lines), at(taxels));
    adjoint.resize(at(sensed_lines), at(taxels));
    square.resize(driven_tied && sensed_tied ? 0 : at(driven_tied ? sensed_lines : driven_lines), at(taxels));
    squares.resize(square.rows());
    adjoint_by_taxel.resize(at(taxels), at(sensed_lines));
    weighted.resize(at(driven_lines), at(taxels));
    pairs.resize(at(driven_lines), at(sensed_lines));
  }
  set_resistors();
}

void CircuitModel::Implementation::set_resistors() {
  const Readout& readout = array.readout;
  std::copy(readout.drive_ohm.begin(), readout.drive_ohm.end(), rho.begin());
  for (std::size_t s = 0; s < sensed_lines; ++s) {
    sensed_head[s] = compensation::sensed_line(readout, s);
    rho[driven_lines + s] = sensed_head[s].rho;
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
  potential.resize(at(keys.size()), at(is_two_terminal() ? taxels : lines + 1));
}

void CircuitModel::Implementation::solve(std::span<const double> siemens) {
  std::copy(siemens.begin(), siemens.end(), edge_siemens.begin());
  std::fill(ground_siemens.begin(), ground_siemens.end(), 0.0);
  for (std::size_t line = 0; line < lines; ++line) {
    if (is_tied(line) && !held[line]) ground_siemens[head[line]] = 1.0 / rho[line];
  }
  network->eliminate(edge_siemens, ground_siemens);
  potential.setZero();
  if (is_two_terminal()) {
    scan_two_terminals();
  } else {
    respond();
    find_currents();
    find_drops();
    if (driven_tied && sensed_tied) scan_tied_lines();
    if (!driven_tied) scan_floating_driven_lines();
    if (!sensed_tied) scan_floating_sensed_lines();
    adjoint_by_taxel = adjoint.transpose();
  }
  for (std::size_t d = 0; d < driven_lines; ++d) {
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      ratio[reading(d, s)] = sensed_head[s].gain * scan_current(at(d), at(s)) + sensed_head[s].offset;
    }
  }
}

void CircuitModel::Implementation::respond() {
  for (std::size_t line = 0; line < lines; ++line) {
    const double source = is_tied(line) && !held[line] ? 1.0 / rho[line] : 1.0;
    potential(at(head[line]), at(line)) = source;
    if (line >= driven_lines) potential(at(head[line]), at(lines)) = source * sensed_head[line - driven_lines].emf;
  }
  network->solve(potential);
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
    if (line >= driven_lines) out(at(lines)) -= sensed_head[line - driven_lines].emf / rho[line];
  }
}

void CircuitModel::Implementation::find_drops() {
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto& [row, col] = edges[taxel];
    drop.col(at(taxel)) = (potential.row(at(row)) - potential.row(at(col))).transpose();
  }
}

void CircuitModel::Implementation::scan_tied_lines() {
  forward = drop.topRows(at(driven_lines)).rowwise() + drop.row(at(lines));
  adjoint = drop.middleRows(at(driven_lines), at(sensed_lines));
  for (std::size_t d = 0; d < driven_lines; ++d) {
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      const Index line = at(driven_lines + s);
      scan_current(at(d), at(s)) = current(line, at(d)) + current(line, at(lines));
    }
  }
}

void CircuitModel::Implementation::scan_floating_driven_lines() {
  adjoint = drop.middleRows(at(driven_lines), at(sensed_lines));
  for (std::size_t d = 0; d < driven_lines; ++d) {
    drive_floating_line(d);
    const double source = source_of(d);
    forward.row(at(d)) = source * drop.row(at(d)) + drop.row(at(lines));
    clear_isolated_lines(d, forward.row(at(d)));
    square.row(at(d)) = forward.row(at(d)).cwiseProduct(drop.row(at(d)));
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      const Index line = at(driven_lines + s);
      scan_current(at(d), at(s)) = source * admittance[d] * current(line, at(d)) + current(line, at(lines));
    }
  }
}

void CircuitModel::Implementation::scan_floating_sensed_lines() {
  forward = drop.topRows(at(driven_lines));
  for (std::size_t s = 0; s < sensed_lines; ++s) {
    const std::size_t line = driven_lines + s;
    drive_floating_line(line);
    adjoint.row(at(s)) = drop.row(at(line));
    clear_isolated_lines(line, adjoint.row(at(s)));
    square.row(at(s)) = adjoint.row(at(s)).cwiseAbs2();
    for (std::size_t d = 0; d < driven_lines; ++d) {
      scan_current(at(d), at(s)) = admittance[line] * current(at(d), at(line));
    }
  }
}

// From the drops for 1 A to those for 1 V behind rho. Nothing flows into a line without a taxel: it stands at 1 V.
void CircuitModel::Implementation::drive_floating_line(std::size_t line) {
  auto drops = drop.row(at(line));
  if (!is_isolated(line)) {
    admittance[line] = 1.0 / (rho[line] + potential(at(head[line]), at(line)));
    drops *= admittance[line];
    return;
  }
  admittance[line] = 0.0;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const bool own = floating_line(taxel) == line;
    drops(at(taxel)) = own ? (is_row(line) ? 1.0 : -1.0) : 0.0;
  }
}

// While another line than a floating one without a taxel is driven, a first taxel on the latter would bring it to the
// potential of the taxel's other end: no drop.
void CircuitModel::Implementation::clear_isolated_lines(std::size_t driven, Matrix::RowXpr drops) const {
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const std::size_t line = floating_line(taxel);
    if (line != driven && is_isolated(line)) drops(at(taxel)) = 0.0;
  }
}

// The potentials of each scan anew, for 1 A from its driven to its sensed line: differences of the responses of single
// lines would lose the parts of the array that hang on each other by weak taxels only.
void CircuitModel::Implementation::scan_two_terminals() {
  for (std::size_t d = 0; d < driven_lines; ++d) {
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      potential(at(head[d]), at(reading(d, s))) = 1.0;
      potential(at(head[driven_lines + s]), at(reading(d, s))) = -1.0;
    }
  }
  network->solve(potential);
  for (std::size_t d = 0; d < driven_lines; ++d) {
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      const std::size_t line = driven_lines + s;
      const Index scan = at(reading(d, s));
      const double ohm = potential(at(head[d]), scan) - potential(at(head[line]), scan);
      scan_current(at(d), at(s)) = is_joined(head[d], head[line]) ? 1.0 / (rho[d] + ohm + rho[line]) : 0.0;
    }
  }
}

void CircuitModel::Implementation::derive(std::size_t driven, std::size_t sensed, std::size_t first,
                                          std::span<double> out) const {
  const Index d = at(driven);
  const Index s = at(sensed);
  const std::size_t line = driven_lines + sensed;
  const double gain = sensed_head[sensed].gain;
  if (driven_tied || sensed_tied) {
    Eigen::Map<Eigen::RowVectorXd> row(out.data(), at(out.size()));
    const auto part = [&](const Matrix& matrix, Index index) {
      return matrix.row(index).segment(at(first), row.size());
    };
    row = -gain * part(forward, d).cwiseProduct(part(adjoint, s));
    if (!driven_tied) row += gain * current(at(line), d) * part(square, d);
    if (!sensed_tied) row += gain * current(d, at(line)) * part(square, s);
    return;
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double volts = two_terminal_drop(driven, sensed, first + k);
    out[k] = gain * volts * volts;
  }
}

// Over the supply. In a scan across two parts of the array without a taxel between them, one stands at 1 V.
double CircuitModel::Implementation::two_terminal_drop(std::size_t driven, std::size_t sensed,
                                                       std::size_t taxel) const {
  const std::size_t from = head[driven];
  const std::size_t to = head[driven_lines + sensed];
  const auto [a, b] = edges[taxel];
  if (!is_joined(from, to)) {
    return (is_joined(a, from) && is_joined(b, to)) || (is_joined(b, from) && is_joined(a, to)) ? 1.0 : 0.0;
  }
  if (!is_joined(a, b)) return 0.0;
  const Index scan = at(reading(driven, sensed));
  return scan_current(at(driven), at(sensed)) * (potential(at(a), scan) - potential(at(b), scan));
}

// As derive() for all readings at once: the taxels' sums of forward and adjoint drops are one matrix product.
void CircuitModel::Implementation::multiply_tied(std::span<const double> change, std::span<double> product) {
  const Eigen::Map<const Eigen::VectorXd> step(change.data(), at(taxels));
  weighted.noalias() = forward * step.asDiagonal();
  multiply({weighted.data(), taxels, 1}, adjoint_by_taxel.data(), driven_lines, taxels, sensed_lines, pairs.data());
  squares.noalias() = square * step;
  for (std::size_t d = 0; d < driven_lines; ++d) {
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      const Index line = at(driven_lines + s);
      double sum = pairs(at(d), at(s));
      if (!driven_tied) sum -= current(line, at(d)) * squares(at(d));
      if (!sensed_tied) sum -= current(at(d), line) * squares(at(s));
      product[reading(d, s)] = -sensed_head[s].gain * sum;
    }
  }
}

void CircuitModel::Implementation::multiply_two_terminals(std::span<const double> change, std::span<double> product) {
  squares.setZero();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto [a, b] = edges[taxel];
    if (!is_joined(a, b)) continue;
    squares += change[taxel] * (potential.row(at(a)) - potential.row(at(b))).cwiseAbs2().transpose();
  }
  for (std::size_t d = 0; d < driven_lines; ++d) {
    for (std::size_t s = 0; s < sensed_lines; ++s) {
      const double amperes = scan_current(at(d), at(s));
      double sum = amperes * amperes * squares(at(reading(d, s)));
      if (!is_joined(head[d], head[driven_lines + s])) {
        sum = 0.0;
        for (std::size_t taxel = 0; taxel < taxels; ++taxel) sum += two_terminal_drop(d, s, taxel) * change[taxel];
      }
      product[reading(d, s)] = sensed_head[s].gain * sum;
    }
  }
}

double CircuitModel::Implementation::current_by_resistor(std::size_t driven, std::size_t sensed,
                                                         std::size_t line) const {
  const Index d = at(driven);
  const Index s = at(driven_lines + sensed);
  const Index t = at(line);
  const double amperes = scan_current(d, at(sensed));
  if (is_two_terminal()) return line == driven || t == s ? -amperes * amperes : 0.0;
  if (driven_tied && sensed_tied) return (current(t, d) + current(t, at(lines))) * current(t, s);
  if (sensed_tied) {
    const double share = current(s, d);
    const double drive = source_of(driven) * admittance[driven];
    if (line < driven_lines) return line == driven ? -drive * admittance[driven] * share : 0.0;
    return (current(t, at(lines)) + drive * current(t, d)) *
           (current(t, s) - share * admittance[driven] * current(t, d));
  }
  const double loop = admittance[driven_lines + sensed];
  if (line >= driven_lines) return t == s ? -amperes * loop : 0.0;
  return loop * current(t, s) * (current(t, d) - current(d, s) * loop * current(t, s));
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
  if (potential_count(array) > kMostPotentials) {
    return bad_input("array: too large to be solved with this readout circuit: divide it into smaller arrays");
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
      implementation_->derive(d, s, 0, jacobian.subspan(implementation_->reading(d, s) * taxels, taxels));
    }
  }
}

void CircuitModel::own_derivatives(std::span<double> derivatives) const noexcept {
  assert(derivatives.size() == implementation_->taxels);
  for (std::size_t d = 0; d < implementation_->driven_lines; ++d) {
    for (std::size_t s = 0; s < implementation_->sensed_lines; ++s) {
      const std::size_t taxel = implementation_->reading(d, s);
      implementation_->derive(d, s, taxel, derivatives.subspan(taxel, 1));
    }
  }
}

void CircuitModel::multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept {
  assert(change.size() == implementation_->taxels && product.size() == implementation_->taxels);
  if (implementation_->driven_tied || implementation_->sensed_tied) {
    implementation_->multiply_tied(change, product);
  } else {
    implementation_->multiply_two_terminals(change, product);
  }
}

void CircuitModel::drive_jacobian(std::span<double> jacobian) const noexcept {
  const std::size_t lines = implementation_->driven_lines;
  assert(jacobian.size() == implementation_->taxels * lines);
  for (std::size_t d = 0; d < lines; ++d) {
    for (std::size_t s = 0; s < implementation_->sensed_lines; ++s) {
      for (std::size_t line = 0; line < lines; ++line) {
        jacobian[implementation_->reading(d, s) * lines + line] =
            implementation_->sensed_head[s].gain * implementation_->current_by_resistor(d, s, line);
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
        entry = implementation_->sensed_head[s].gain * by_rho * implementation_->sensed_head[line].rho_by_load;
        if (line == s)
          entry += implementation_->sensed_head[s].gain_by_load * implementation_->scan_current(at(d), at(s));
      }
    }
  }
}

}  // namespace dermis::compensation
