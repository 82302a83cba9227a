// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/line_faults.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

#include "dermis/bytes/files/config_table.hpp"

namespace dermis::learn::simulation {
namespace {

constexpr double kBeyondAdc = 1e3;
constexpr double kLeakSiemens = 1e-16;  // holds a line that is connected to nothing at 0 V
constexpr double kUnknownCircuitOhm = 100.0;

using Lines = std::vector<std::size_t>;

/// One way in which a line breaks, as files name it.
struct LineBreak {
  const char* name = nullptr;
  Lines BrokenLines::*lines = nullptr;
  std::size_t lines_beside = 0;  // that such a line needs behind it
};

constexpr std::array kLineBreaks{LineBreak{"open", &BrokenLines::open}, LineBreak{"grounded", &BrokenLines::grounded},
                                 LineBreak{"supplied", &BrokenLines::supplied},
                                 LineBreak{"shorted", &BrokenLines::shorted, 1}};

std::string key_of(const LineBreak& kind, const char* side) {
  return std::string("faults.") + kind.name + "_" + side;
}

bool contains(const Lines& lines, std::size_t line) {
  return std::find(lines.begin(), lines.end(), line) != lines.end();
}

Status check(const std::string& key, const Lines& lines, std::size_t size) {
  if (std::all_of(lines.begin(), lines.end(), [size](std::size_t line) { return line < size; })) return Done{};
  return bad_input(key + ": must be below " + std::to_string(size) + ", counted from 0");
}

/// Row-major index of "r3c5", or nothing where the array has no such taxel.
std::optional<std::size_t> taxel_index(const ArrayDescription& array, const std::string& name) {
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (array.taxel_name(taxel) == name) return taxel;
  }
  return std::nullopt;
}

Lines taxel_indices(const ArrayDescription& array, const std::vector<std::string>& names) {
  Lines taxels;
  for (const std::string& name : names) taxels.push_back(*taxel_index(array, name));
  return taxels;
}

Status check_taxels(const char* field, const std::vector<std::string>& names, const ArrayDescription& array) {
  for (const std::string& name : names) {
    if (!taxel_index(array, name)) {
      return bad_input(std::string("faults.") + field + ": the array has no taxel \"" + name + "\"");
    }
  }
  return Done{};
}

/// The connection of a line beside its taxels: a voltage (over the supply) through a conductance, or rigidly.
struct Tie {
  double siemens = 0.0;
  double ratio = 0.0;
  bool rigid = false;
};

/// The lines as nodes: rows first, then columns. Lines shorted together are one node.
class Nodes {
 public:
  Nodes(const ArrayDescription& array, const LineFaults& faults, std::span<const double> siemens,
        const FilmConductances& film)
      : rows_(array.rows), lines_(array.rows + array.cols), node_(lines_) {
    std::iota(node_.begin(), node_.end(), std::size_t{0});
    for (const std::size_t taxel : taxel_indices(array, faults.shorted_taxels)) {
      join(taxel / array.cols, rows_ + taxel % array.cols);
    }
    for (const std::size_t row : faults.rows.shorted) join(row, row + 1);
    for (const std::size_t col : faults.columns.shorted) join(rows_ + col, rows_ + col + 1);
    laplacian_ = Eigen::MatrixXd::Zero(size(), size());
    for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
      connect(node_[taxel / array.cols], node_[rows_ + taxel % array.cols], siemens[taxel]);
    }
    for (std::size_t row = 0; row + 1 < array.rows; ++row) connect(node_[row], node_[row + 1], film.between_rows[row]);
    for (std::size_t col = 0; col + 1 < array.cols; ++col) {
      connect(node_[rows_ + col], node_[rows_ + col + 1], film.between_cols[col]);
    }
  }

  [[nodiscard]] std::size_t lines() const { return lines_; }
  [[nodiscard]] std::size_t of_row(std::size_t row) const { return node_[row]; }
  [[nodiscard]] std::size_t of_column(std::size_t col) const { return node_[rows_ + col]; }

  /// Voltage of every node. A rigid tie wins over one with resistance; between rigid ties the voltage is their mean.
  [[nodiscard]] Eigen::VectorXd voltages(const std::vector<Tie>& ties) const {
    Eigen::MatrixXd matrix = laplacian_;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size());
    Eigen::VectorXd rigid_count = Eigen::VectorXd::Zero(size());
    Eigen::VectorXd rigid_sum = Eigen::VectorXd::Zero(size());
    for (std::size_t line = 0; line < lines_; ++line) {
      const auto node = static_cast<Eigen::Index>(node_[line]);
      matrix(node, node) += ties[line].siemens + kLeakSiemens;
      right(node) += ties[line].siemens * ties[line].ratio;
      if (!ties[line].rigid) continue;
      rigid_count(node) += 1.0;
      rigid_sum(node) += ties[line].ratio;
    }
    for (Eigen::Index node = 0; node < size(); ++node) {
      const bool unused = node_[static_cast<std::size_t>(node)] != static_cast<std::size_t>(node);
      if (!unused && rigid_count(node) == 0.0) continue;
      matrix.row(node).setZero();
      matrix(node, node) = 1.0;
      right(node) = unused ? 0.0 : rigid_sum(node) / rigid_count(node);
    }
    return matrix.partialPivLu().solve(right);
  }

  /// Current that the taxels carry into a node, over the supply [S].
  [[nodiscard]] double current_into(std::size_t node, const Eigen::VectorXd& voltages) const {
    return -laplacian_.row(static_cast<Eigen::Index>(node)).dot(voltages);
  }

 private:
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(lines_); }

  void join(std::size_t line, std::size_t other) {
    const std::size_t from = node_[other];
    std::replace(node_.begin(), node_.end(), from, node_[line]);
  }

  void connect(std::size_t a, std::size_t b, double siemens) {
    const auto i = static_cast<Eigen::Index>(a);
    const auto j = static_cast<Eigen::Index>(b);
    laplacian_(i, i) += siemens;
    laplacian_(j, j) += siemens;
    laplacian_(i, j) -= siemens;
    laplacian_(j, i) -= siemens;
  }

  std::size_t rows_;
  std::size_t lines_;
  std::vector<std::size_t> node_;  // [rows + cols]
  Eigen::MatrixXd laplacian_;
};

/// One array with its faults in one frame, scanned taxel by taxel.
class Scan {
 public:
  Scan(const ArrayDescription& array, const LineFaults& faults, double drift_ohm, std::span<const double> siemens,
       const FilmConductances& film)
      : array_(array), faults_(faults), drift_ohm_(drift_ohm), nodes_(array, faults, siemens, film) {}

  void read(std::span<double> ratio) const {
    const bool columns_driven = array_.readout.circuit == Circuit::flexitac;
    const bool one_loaded = columns_driven || array_.readout.idle_columns == IdleColumns::floating;
    const std::size_t sensed_lines = array_.sensed_lines();
    for (std::size_t driven = 0; driven < array_.driven_lines(); ++driven) {
      Eigen::VectorXd voltages;
      for (std::size_t sensed = 0; sensed < sensed_lines; ++sensed) {
        if (one_loaded || sensed == 0) voltages = nodes_.voltages(ties(driven, sensed, one_loaded));
        const std::size_t taxel = columns_driven ? array_.index(sensed, driven) : array_.index(driven, sensed);
        ratio[taxel] = reading(driven, sensed, voltages);
      }
    }
  }

 private:
  struct Line {
    bool open = false;
    std::optional<double> short_to;
  };

  [[nodiscard]] Line row_line(std::size_t row) const { return line_of(faults_.rows, row); }
  [[nodiscard]] Line column_line(std::size_t col) const { return line_of(faults_.columns, col); }
  static Line line_of(const BrokenLines& broken, std::size_t line) {
    return {contains(broken.open, line), short_of(contains(broken.grounded, line), contains(broken.supplied, line))};
  }
  static std::optional<double> short_of(bool grounded, bool supplied) {
    if (grounded) return 0.0;
    if (supplied) return 1.0;
    return std::nullopt;
  }
  [[nodiscard]] Line driven_line(std::size_t line) const { return flexitac() ? column_line(line) : row_line(line); }
  [[nodiscard]] Line sensed_line(std::size_t line) const { return flexitac() ? row_line(line) : column_line(line); }
  [[nodiscard]] bool flexitac() const { return array_.readout.circuit == Circuit::flexitac; }
  [[nodiscard]] std::size_t sensed_node(std::size_t line) const {
    return flexitac() ? nodes_.of_row(line) : nodes_.of_column(line);
  }

  [[nodiscard]] std::vector<Tie> ties(std::size_t driven, std::size_t sensed, bool one_loaded) const {
    std::vector<Tie> ties(nodes_.lines());
    const std::size_t first_driven = flexitac() ? array_.rows : 0;
    const std::size_t first_sensed = flexitac() ? 0 : array_.rows;
    for (std::size_t line = 0; line < array_.driven_lines(); ++line) {
      ties[first_driven + line] = driver(line, line == driven);
    }
    for (std::size_t line = 0; line < array_.sensed_lines(); ++line) {
      ties[first_sensed + line] = load(line, !one_loaded || line == sensed);
    }
    return ties;
  }

  [[nodiscard]] Tie driver(std::size_t line, bool driven) const {
    const Line state = driven_line(line);
    if (state.short_to) return {0.0, *state.short_to, true};
    const bool idle_floating = !flexitac() && array_.readout.idle_rows == IdleRows::floating;
    if (state.open || (!driven && idle_floating)) return {};
    const double ohm = array_.readout.drive_ohm[line] + (contains(faults_.drifting_rows, line) ? drift_ohm_ : 0.0);
    const double ratio = driven ? 1.0 : 0.0;
    return ohm > 0.0 ? Tie{1.0 / ohm, ratio, false} : Tie{0.0, ratio, true};
  }

  [[nodiscard]] Tie load(std::size_t line, bool loaded) const {
    const Line state = sensed_line(line);
    if (state.short_to) return {0.0, *state.short_to, true};
    if (state.open || !loaded) return {};
    if (array_.readout.circuit == Circuit::transimpedance) return {0.0, 0.0, true};
    return {1.0 / array_.readout.load_ohm[line], 0.0, false};
  }

  [[nodiscard]] double reading(std::size_t driven, std::size_t sensed, const Eigen::VectorXd& voltages) const {
    const Line state = sensed_line(sensed);
    if (state.open) return 0.0;
    const std::size_t node = sensed_node(sensed);
    if (array_.readout.circuit != Circuit::transimpedance) return voltages(static_cast<Eigen::Index>(node));
    // Amplifiers on one node have one input, so equal outputs: the current divides as the feedback conductances.
    double feedback_siemens = 0.0;
    for (std::size_t line = 0; line < array_.cols; ++line) {
      if (sensed_node(line) != node || column_line(line).open) continue;
      if (column_line(line).short_to) return *column_line(line).short_to * kBeyondAdc;
      feedback_siemens += 1.0 / array_.readout.load_ohm[line];
    }
    return (nodes_.current_into(node, voltages) + driver_current(driven, node)) / feedback_siemens;
  }

  /// Current of the drivers of rows that are shorted to this column at virtual ground, over the supply [S].
  [[nodiscard]] double driver_current(std::size_t driven, std::size_t node) const {
    double current = 0.0;
    for (std::size_t row = 0; row < array_.rows; ++row) {
      if (nodes_.of_row(row) != node) continue;
      const Tie tie = driver(row, row == driven);
      current += tie.rigid ? kBeyondAdc * tie.ratio : tie.siemens * tie.ratio;
    }
    return current;
  }

  const ArrayDescription& array_;
  const LineFaults& faults_;
  double drift_ohm_;
  Nodes nodes_;
};

/// The readings of `circuit = "none"` are no circuit's: what a fault does to them is a convention, 0 on an open line.
void read_unknown(const ArrayDescription& array, const LineFaults& faults, std::span<const double> siemens,
                  std::span<double> ratio) {
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const bool silent =
        contains(faults.rows.open, taxel / array.cols) || contains(faults.columns.open, taxel % array.cols);
    ratio[taxel] = silent ? 0.0 : kUnknownCircuitOhm * siemens[taxel];
  }
}

}  // namespace

bool LineFaults::any() const noexcept {
  const bool is_line_broken = std::any_of(kLineBreaks.begin(), kLineBreaks.end(), [&](const auto& kind) {
    return !(rows.*kind.lines).empty() || !(columns.*kind.lines).empty();
  });
  return is_line_broken || !dead_taxels.empty() || !stuck_taxels.empty() || !shorted_taxels.empty() ||
         !drifting_rows.empty();
}

Status LineFaults::validate(const ArrayDescription& array) const {
  for (const LineBreak& kind : kLineBreaks) {
    for (const auto& [side, lines, size] :
         {std::tuple("rows", &rows, array.rows), std::tuple("columns", &columns, array.cols)}) {
      if (Status valid = check(key_of(kind, side), lines->*kind.lines, size - kind.lines_beside); !valid) return valid;
    }
  }
  if (Status valid = check("faults.drifting_rows", drifting_rows, array.driven_lines()); !valid) return valid;
  if (Status valid = check_taxels("dead_taxels", dead_taxels, array); !valid) return valid;
  if (Status valid = check_taxels("stuck_taxels", stuck_taxels, array); !valid) return valid;
  if (Status valid = check_taxels("shorted_taxels", shorted_taxels, array); !valid) return valid;
  if (!(stuck_ratio >= 0.0 && stuck_ratio <= 1.0)) return bad_input("faults.stuck_ratio: must be 0 to 1");
  if (!(drift_ohm >= 0.0 && std::isfinite(drift_ohm))) return bad_input("faults.drift_ohm: must be 0 or more");
  if (until_frame <= from_frame) return bad_input("faults.until_frame: must be above from_frame");
  return Done{};
}

void read_line_faults(bytes::files::ConfigFile& file, LineFaults& faults) {
  for (const LineBreak& kind : kLineBreaks) {
    file.counts(key_of(kind, "rows"), faults.rows.*kind.lines);
    file.counts(key_of(kind, "columns"), faults.columns.*kind.lines);
  }
  file.texts("faults.dead_taxels", faults.dead_taxels);
  file.texts("faults.stuck_taxels", faults.stuck_taxels);
  file.number("faults.stuck_ratio", faults.stuck_ratio);
  file.texts("faults.shorted_taxels", faults.shorted_taxels);
  file.counts("faults.drifting_rows", faults.drifting_rows);
  file.number("faults.drift_ohm", faults.drift_ohm);
  file.count("faults.drift_frames", faults.drift_frames);
  file.count("faults.from_frame", faults.from_frame);
  file.count("faults.until_frame", faults.until_frame);
}

Result<FaultyCircuit> FaultyCircuit::create(const ArrayDescription& array, const LineFaults& faults) {
  if (Status valid = array.validate(); !valid) return valid.error();
  if (array.has_unknown_circuit()) {
    return bad_input("readout: the circuit or some of its resistances are to be fitted; a simulation needs numbers");
  }
  if (Status valid = faults.validate(array); !valid) return valid.error();
  const Readout& readout = array.readout;
  if (!readout.row_segment_ohm.empty() || !readout.column_segment_ohm.empty() || !readout.column_switch_ohm.empty() ||
      !readout.amplifier_offset_v.empty() || readout.amplifier_gain || readout.supply_ohm.value_or(0.0) > 0.0) {
    return bad_input("faults: are not simulated with resistive lines, column switches, real amplifiers or supply_ohm");
  }
  return FaultyCircuit(array, faults);
}

FaultyCircuit::FaultyCircuit(const ArrayDescription& array, const LineFaults& faults)
    : array_(array),
      faults_(faults),
      dead_taxels_(taxel_indices(array, faults.dead_taxels)),
      stuck_taxels_(taxel_indices(array, faults.stuck_taxels)) {}

void FaultyCircuit::ratios(std::span<const double> siemens, std::size_t frame, std::span<double> ratio) const {
  ratios(siemens, std::vector<double>(siemens.size()), frame, ratio);
}

void FaultyCircuit::ratios(std::span<const double> siemens, std::span<const double> newtons, std::size_t frame,
                           std::span<double> ratio) const {
  assert(siemens.size() == array_.taxel_count() && ratio.size() == siemens.size());
  const LineFaults none;
  const LineFaults& faults = present(frame) ? faults_ : none;
  std::vector<double> left(siemens.begin(), siemens.end());
  if (present(frame)) {
    for (const std::size_t taxel : dead_taxels_) left[taxel] = 0.0;
  }
  if (array_.readout.circuit == Circuit::none) {
    read_unknown(array_, faults, left, ratio);
  } else {
    double share = 1.0;
    if (present(frame) && frame - faults.from_frame < faults.drift_frames) {
      share = static_cast<double>(frame - faults.from_frame) / static_cast<double>(faults.drift_frames);
    }
    FilmConductances film(array_.rows, array_.cols);
    if (array_.readout.film) film.set(*array_.readout.film, newtons);
    Scan(array_, faults, share * faults.drift_ohm, left, film).read(ratio);
  }
  if (array_.readout.pressure_raises_reading) return;
  for (double& reading : ratio) reading = 1.0 - reading;
}

void FaultyCircuit::stick(std::span<float> counts) const {
  const double rising = array_.readout.pressure_raises_reading ? faults_.stuck_ratio : 1.0 - faults_.stuck_ratio;
  const double count = std::round(rising * array_.readout.full_scale_counts());
  for (const std::size_t taxel : stuck_taxels_) counts[taxel] = static_cast<float>(count);
}

}  // namespace dermis::learn::simulation
