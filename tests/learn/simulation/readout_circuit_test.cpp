// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/readout_circuit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "dermis/learn/simulation/line_faults.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/reference_array.hpp"
#include "support/simd_targets.hpp"

namespace dermis::learn::simulation {
namespace {

ArrayDescription make_array(std::size_t rows, std::size_t cols, Circuit circuit, IdleRows idle_rows) {
  ArrayDescription array = support::reference_circuit(rows, cols, circuit);
  array.readout.idle_rows = idle_rows;
  return array;
}

void scatter_resistors(ArrayDescription& array, Random& random) {
  for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(1.0, 100.0);
  for (double& ohm : array.readout.load_ohm) ohm = random.log_uniform(50.0, 10e3);
}

/// A circuit with all its parts but the resistance of the lines.
struct CircuitKind {
  const char* name;
  Circuit circuit;
  IdleRows idle_rows = IdleRows::grounded;
  IdleColumns idle_columns = IdleColumns::loaded;
  bool has_real_amplifiers = false;
};

std::ostream& operator<<(std::ostream& out, const CircuitKind& kind) {
  return out << kind.name;
}

constexpr std::array kCircuitKinds{
    CircuitKind{"divider", Circuit::divider},
    CircuitKind{"divider_floating_rows", Circuit::divider, IdleRows::floating},
    CircuitKind{"divider_floating_columns", Circuit::divider, IdleRows::grounded, IdleColumns::floating},
    CircuitKind{"divider_all_floating", Circuit::divider, IdleRows::floating, IdleColumns::floating},
    CircuitKind{"transimpedance", Circuit::transimpedance},
    CircuitKind{"transimpedance_floating_rows", Circuit::transimpedance, IdleRows::floating},
    CircuitKind{"real_transimpedance", Circuit::transimpedance, IdleRows::grounded, IdleColumns::loaded, true},
    CircuitKind{"real_transimpedance_floating_rows", Circuit::transimpedance, IdleRows::floating, IdleColumns::loaded,
                true},
    CircuitKind{"flexitac", Circuit::flexitac}};

std::vector<double> random_list(std::size_t size, double least, double most, Random& random) {
  std::vector<double> values(size);
  for (double& value : values) value = random.uniform(least, most);
  return values;
}

/// Each line with resistors of its own.
ArrayDescription random_array(const CircuitKind& kind, std::size_t rows, std::size_t cols, Random& random) {
  ArrayDescription array = make_array(rows, cols, kind.circuit, kind.idle_rows);
  array.readout.idle_columns = kind.idle_columns;
  scatter_resistors(array, random);
  if (kind.circuit == Circuit::transimpedance) array.readout.supply_v = 3.3;
  if (kind.has_real_amplifiers) {
    array.readout.column_switch_ohm = random_list(cols, 0.0, 50.0, random);
    array.readout.amplifier_offset_v = random_list(cols, -0.005, 0.005, random);
    array.readout.amplifier_gain = 5e3;
  }
  return array;
}

void add_segments(ArrayDescription& array, Random& random) {
  array.readout.row_segment_ohm = random_list(array.rows, 0.1, 50.0, random);
  array.readout.column_segment_ohm = random_list(array.cols, 0.1, 50.0, random);
  array.readout.row_segment_ohm[array.rows / 2] = 0.0;
  array.readout.column_segment_ohm[array.cols / 2] = 0.0;
}

std::vector<double> random_siemens(std::size_t count, Random& random) {
  std::vector<double> siemens(count);
  for (double& value : siemens) value = 1.0 / random.log_uniform(100.0, 200e3);
  return siemens;
}

std::vector<double> ratios(const ArrayDescription& array, const std::vector<double>& siemens) {
  std::vector<double> ratio(siemens.size());
  ReadoutCircuit::create(array)->ratios(siemens, ratio);
  return ratio;
}

using Table = std::vector<std::vector<double>>;

/// Gauss-Jordan elimination with pivoting: matrix^-1 right.
Table solve(Table matrix, Table right) {
  const std::size_t n = matrix.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k])) pivot = i;
    }
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = matrix[i][k] / matrix[k][k];
      for (std::size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
      for (std::size_t j = 0; j < right[i].size(); ++j) right[i][j] -= factor * right[k][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (double& value : right[i]) value /= matrix[i][i];
  }
  return right;
}

/// The whole nodal system of a divider, rows then columns, for one driven row; all voltages over the supply.
std::vector<double> nodal_voltages(const ArrayDescription& array, const std::vector<double>& siemens,
                                   std::size_t driven) {
  const std::size_t rows = array.rows;
  const std::size_t lines = rows + array.cols;
  Table matrix(lines, std::vector<double>(lines, 0.0));
  Table current(lines, std::vector<double>(1, 0.0));
  for (std::size_t i = 0; i < rows; ++i) {
    const bool connected = i == driven || array.readout.idle_rows == IdleRows::grounded;
    if (connected) matrix[i][i] += 1.0 / array.readout.drive_ohm[i];
    for (std::size_t j = 0; j < array.cols; ++j) {
      const double g = siemens[array.index(i, j)];
      matrix[i][i] += g;
      matrix[rows + j][rows + j] += g;
      matrix[i][rows + j] -= g;
      matrix[rows + j][i] -= g;
    }
  }
  for (std::size_t j = 0; j < array.cols; ++j) matrix[rows + j][rows + j] += 1.0 / array.readout.load_ohm[j];
  current[driven][0] = 1.0 / array.readout.drive_ohm[driven];
  std::vector<double> voltages;
  for (const auto& line : solve(matrix, current)) voltages.push_back(line[0]);
  return voltages;
}

TEST(ReadoutCircuit, single_taxel_is_a_voltage_divider) {
  for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
    const ArrayDescription array = make_array(1, 1, Circuit::divider, idle_rows);
    EXPECT_NEAR(ratios(array, {1e-3})[0], 200.0 / (20.0 + 1000.0 + 200.0), 1e-15);
  }
}

TEST(ReadoutCircuit, pressure_that_lowers_the_reading_gives_the_complement) {
  ArrayDescription array = make_array(1, 1, Circuit::divider, IdleRows::grounded);
  array.readout.pressure_raises_reading = false;
  EXPECT_NEAR(ratios(array, {1e-3})[0], 1.0 - 200.0 / 1220.0, 1e-15);
}

TEST(ReadoutCircuit, unknown_circuit_reads_conductance_without_crosstalk) {
  ArrayDescription array = make_array(2, 2, Circuit::none, IdleRows::grounded);
  array.readout.drive_ohm.clear();
  array.readout.load_ohm.clear();
  EXPECT_EQ(ratios(array, {1e-3, 2e-3, 0.0, 4e-3}), (std::vector<double>{0.1, 0.2, 0.0, 0.4}));
}

TEST(ReadoutCircuit, floating_two_by_two_is_the_series_parallel_circuit) {
  // Row 0 driven through 0 ohm, row 1 floating: r00 to column 0, r01 to column 1, r10 + r11 as a bridge between them.
  ArrayDescription array = make_array(2, 2, Circuit::divider, IdleRows::floating);
  array.readout.drive_ohm = {0.0, 0.0};
  array.readout.load_ohm = {200.0, 300.0};
  const double g00 = 1.0 / 1000.0;
  const double g01 = 1.0 / 500.0;
  const double bridge = 1.0 / (2000.0 + 250.0);
  const double a = g00 + bridge + 1.0 / 200.0;
  const double d = g01 + bridge + 1.0 / 300.0;
  const double determinant = a * d - bridge * bridge;
  const auto ratio = ratios(array, {g00, g01, 1.0 / 2000.0, 1.0 / 250.0});
  EXPECT_NEAR(ratio[0], (d * g00 + bridge * g01) / determinant, 1e-14);
  EXPECT_NEAR(ratio[1], (bridge * g00 + a * g01) / determinant, 1e-14);
}

TEST(ReadoutCircuit, floating_row_without_conductance_reads_zero) {
  const ArrayDescription array = make_array(2, 1, Circuit::divider, IdleRows::floating);
  const auto ratio = ratios(array, {0.0, 1e-3});
  EXPECT_EQ(ratio[0], 0.0);
  EXPECT_NEAR(ratio[1], 200.0 / 1220.0, 1e-15);
}

TEST(ReadoutCircuit, agrees_with_the_whole_nodal_system) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const IdleRows idle_rows = seed % 2 == 0 ? IdleRows::grounded : IdleRows::floating;
    ArrayDescription array = make_array(1 + random.below(10), 1 + random.below(10), Circuit::divider, idle_rows);
    scatter_resistors(array, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto ratio = ratios(array, siemens);
    for (std::size_t row = 0; row < array.rows; ++row) {
      const auto voltages = nodal_voltages(array, siemens, row);
      for (std::size_t col = 0; col < array.cols; ++col) {
        EXPECT_NEAR(ratio[array.index(row, col)] / voltages[array.rows + col], 1.0, 1e-11);
      }
    }
  }
}

TEST(ReadoutCircuit, grounded_divider_is_the_closed_form) {
  // T = D S^-1 G B^-1 with S = A - G B^-1 G^T: the row-side Schur complement, the library uses the column side.
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  ArrayDescription array = make_array(6, 9, Circuit::divider, IdleRows::grounded);
  scatter_resistors(array, random);
  const auto siemens = random_siemens(array.taxel_count(), random);
  std::vector<double> b(array.cols);
  for (std::size_t j = 0; j < array.cols; ++j) {
    b[j] = 1.0 / array.readout.load_ohm[j];
    for (std::size_t i = 0; i < array.rows; ++i) b[j] += siemens[array.index(i, j)];
  }
  Table schur(array.rows, std::vector<double>(array.rows, 0.0));
  Table right(array.rows, std::vector<double>(array.cols));
  for (std::size_t i = 0; i < array.rows; ++i) {
    schur[i][i] += 1.0 / array.readout.drive_ohm[i];
    for (std::size_t j = 0; j < array.cols; ++j) {
      const double g = siemens[array.index(i, j)];
      schur[i][i] += g;
      right[i][j] = g / b[j];
      for (std::size_t k = 0; k < array.rows; ++k) schur[i][k] -= g * siemens[array.index(k, j)] / b[j];
    }
  }
  const Table response = solve(schur, right);
  const auto ratio = ratios(array, siemens);
  for (std::size_t i = 0; i < array.rows; ++i) {
    for (std::size_t j = 0; j < array.cols; ++j) {
      EXPECT_NEAR(ratio[array.index(i, j)] * array.readout.drive_ohm[i] / response[i][j], 1.0, 1e-11);
    }
  }
}

TEST(ReadoutCircuit, reciprocity_holds_when_the_array_is_read_across) {
  // v_j / (gd_k s_k) is a transfer resistance: driving column j and sensing row k gives the same.
  constexpr std::uint64_t kSeed = 12;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  ArrayDescription array = make_array(5, 7, Circuit::divider, IdleRows::grounded);
  scatter_resistors(array, random);
  const auto siemens = random_siemens(array.taxel_count(), random);
  ArrayDescription across = make_array(7, 5, Circuit::divider, IdleRows::grounded);
  across.readout.drive_ohm = array.readout.load_ohm;
  across.readout.load_ohm = array.readout.drive_ohm;
  std::vector<double> transposed(siemens.size());
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 7; ++j) transposed[across.index(j, i)] = siemens[array.index(i, j)];
  }
  const auto ratio = ratios(array, siemens);
  const auto back = ratios(across, transposed);
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 7; ++j) {
      EXPECT_NEAR(ratio[array.index(i, j)] * array.readout.drive_ohm[i],
                  back[across.index(j, i)] * across.readout.drive_ohm[j], 1e-10);
    }
  }
}

TEST(ReadoutCircuit, drivers_of_zero_ohm_are_the_limit_of_small_ones) {
  constexpr std::uint64_t kSeed = 13;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
      Random random(kSeed);
      ArrayDescription array = make_array(4, 4, circuit, idle_rows);
      const auto siemens = random_siemens(array.taxel_count(), random);
      array.readout.drive_ohm.assign(4, 0.0);
      const auto zero = ratios(array, siemens);
      array.readout.drive_ohm.assign(4, 1e-9);
      const auto small = ratios(array, siemens);
      for (std::size_t i = 0; i < zero.size(); ++i) EXPECT_NEAR(zero[i] / small[i], 1.0, 1e-9);
    }
  }
}

TEST(ReadoutCircuit, transimpedance_is_undone_by_the_row_droop_formula) {
  // G = y / (1 - Ron Y): y apparent conductance, Y its sum over the row.
  for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
    constexpr std::uint64_t kSeed = 14;
    SCOPED_TRACE(testing::Message() << "seed " << kSeed);
    Random random(kSeed);
    ArrayDescription array = make_array(16, 16, Circuit::transimpedance, idle_rows);
    scatter_resistors(array, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto ratio = ratios(array, siemens);
    for (std::size_t row = 0; row < 16; ++row) {
      double row_sum = 0.0;
      for (std::size_t col = 0; col < 16; ++col) {
        row_sum += ratio[array.index(row, col)] / array.readout.load_ohm[col];
      }
      for (std::size_t col = 0; col < 16; ++col) {
        const double apparent = ratio[array.index(row, col)] / array.readout.load_ohm[col];
        EXPECT_NEAR(apparent / (1.0 - array.readout.drive_ohm[row] * row_sum) / siemens[array.index(row, col)], 1.0,
                    1e-12);
      }
    }
  }
}

TEST(ReadoutCircuit, large_arrays_obey_kirchhoff) {
  // The current that leaves through the loads is the one that enters: checked from the readings and their row voltages.
  constexpr std::uint64_t kSeed = 15;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  const ArrayDescription array = make_array(32, 32, Circuit::divider, IdleRows::grounded);
  const auto siemens = random_siemens(array.taxel_count(), random);
  const auto ratio = ratios(array, siemens);
  for (std::size_t driven = 0; driven < array.rows; ++driven) {
    const double* const v = ratio.data() + driven * array.cols;
    std::vector<double> u(array.rows);
    for (std::size_t i = 0; i < array.rows; ++i) {
      double into = i == driven ? 1.0 / 20.0 : 0.0;
      double total = 1.0 / 20.0;
      for (std::size_t j = 0; j < array.cols; ++j) {
        into += siemens[array.index(i, j)] * v[j];
        total += siemens[array.index(i, j)];
      }
      u[i] = into / total;
    }
    for (std::size_t j = 0; j < array.cols; ++j) {
      double residual = -v[j] / 200.0;
      for (std::size_t i = 0; i < array.rows; ++i) residual += siemens[array.index(i, j)] * (u[i] - v[j]);
      EXPECT_NEAR(residual, 0.0, 1e-15);
    }
  }
}

TEST(ReadoutCircuit, refuses_an_array_without_its_resistors) {
  ArrayDescription array = make_array(2, 2, Circuit::divider, IdleRows::grounded);
  array.readout.load_ohm.clear();
  EXPECT_EQ(ReadoutCircuit::create(array).error().kind, ErrorKind::bad_input);
}

TEST(ReadoutCircuit, single_taxel_with_real_amplifier_is_a_loop) {
  // Supply - driver - taxel - switch - amplifier input, which stands at e = off a + I load/(1 + gain), a = gain/(1 +
  // gain): I = (1 - e)/(20 + 1000 + 50).
  for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
    ArrayDescription array = make_array(1, 1, Circuit::transimpedance, idle_rows);
    array.readout.supply_v = 5.0;
    array.readout.column_switch_ohm = {50.0};
    array.readout.amplifier_offset_v = {0.01};
    array.readout.amplifier_gain = 99.0;
    const double offset = 0.002;
    const double current = (1.0 - offset * 0.99) / (20.0 + 1000.0 + 50.0 + 200.0 / 100.0);
    EXPECT_NEAR(ratios(array, {1e-3})[0], (current * 200.0 - offset) / (1.0 + 1.0 / 99.0), 1e-15);
  }
}

TEST(ReadoutCircuit, single_taxel_with_one_load_is_a_voltage_divider) {
  for (const CircuitKind& kind : kCircuitKinds) {
    if (kind.circuit == Circuit::transimpedance) continue;
    SCOPED_TRACE(kind.name);
    ArrayDescription array = make_array(1, 1, kind.circuit, kind.idle_rows);
    array.readout.idle_columns = kind.idle_columns;
    EXPECT_NEAR(ratios(array, {1e-3})[0], 200.0 / (20.0 + 1000.0 + 200.0), 1e-15);
  }
}

TEST(ReadoutCircuit, two_terminals_of_two_by_two_see_the_taxel_beside_the_other_three) {
  ArrayDescription array = make_array(2, 2, Circuit::divider, IdleRows::floating);
  array.readout.idle_columns = IdleColumns::floating;
  const double around = 500.0 + 250.0 + 2000.0;
  const double parallel = 1.0 / (1.0 / 1000.0 + 1.0 / around);
  EXPECT_NEAR(ratios(array, {1.0 / 1000.0, 1.0 / 500.0, 1.0 / 2000.0, 1.0 / 250.0})[0],
              200.0 / (20.0 + parallel + 200.0), 1e-15);
}

TEST(ReadoutCircuit, two_terminals_see_a_firm_taxel_beside_weak_ones_to_the_last_digits) {
  // 1 ohm beside a path of 3e12 ohm.
  ArrayDescription array = make_array(2, 2, Circuit::divider, IdleRows::floating);
  array.readout.idle_columns = IdleColumns::floating;
  const auto ratio = ratios(array, {1.0, 1e-12, 1e-12, 1e-12});
  EXPECT_NEAR(ratio[0] * (20.0 + 1.0 / (1.0 + 1e-12 / 3.0) + 200.0) / 200.0, 1.0, 1e-15);
  EXPECT_NEAR(ratio[3] * (20.0 + 1.0 / (1e-12 + 1.0 / (2e12 + 1.0)) + 200.0) / 200.0, 1.0, 1e-15);
}

TEST(ReadoutCircuit, flexitac_with_ideal_drivers_is_undone_by_its_closed_form) {
  // G_rc = T_rc / (load_r (1 - sum_c T_rc)).
  constexpr std::uint64_t kSeed = 17;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  ArrayDescription array = make_array(12, 32, Circuit::flexitac, IdleRows::grounded);
  array.readout.drive_ohm.assign(array.cols, 0.0);
  array.readout.load_ohm = random_list(array.rows, 100.0, 10e3, random);
  const auto siemens = random_siemens(array.taxel_count(), random);
  const auto ratio = ratios(array, siemens);
  for (std::size_t row = 0; row < array.rows; ++row) {
    double sum = 0.0;
    for (std::size_t col = 0; col < array.cols; ++col) sum += ratio[array.index(row, col)];
    for (std::size_t col = 0; col < array.cols; ++col) {
      const std::size_t taxel = array.index(row, col);
      EXPECT_NEAR(ratio[taxel] / (array.readout.load_ohm[row] * (1.0 - sum)) / siemens[taxel], 1.0, 1e-10);
    }
  }
}

TEST(ReadoutCircuit, flexitac_is_the_divider_with_floating_columns_read_across) {
  constexpr std::uint64_t kSeed = 18;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  ArrayDescription flexitac = random_array({"", Circuit::flexitac}, 5, 7, random);
  add_segments(flexitac, random);
  ArrayDescription divider = make_array(7, 5, Circuit::divider, IdleRows::grounded);
  divider.readout.idle_columns = IdleColumns::floating;
  divider.readout.drive_ohm = flexitac.readout.drive_ohm;
  divider.readout.load_ohm = flexitac.readout.load_ohm;
  divider.readout.row_segment_ohm = flexitac.readout.column_segment_ohm;
  divider.readout.column_segment_ohm = flexitac.readout.row_segment_ohm;
  const auto siemens = random_siemens(flexitac.taxel_count(), random);
  std::vector<double> transposed(siemens.size());
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 7; ++j) transposed[divider.index(j, i)] = siemens[flexitac.index(i, j)];
  }
  const auto ratio = ratios(flexitac, siemens);
  const auto across = ratios(divider, transposed);
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 7; ++j) EXPECT_EQ(ratio[flexitac.index(i, j)], across[divider.index(j, i)]);
  }
}

TEST(ReadoutCircuit, segment_of_a_row_line_stands_before_the_second_taxel) {
  ArrayDescription array = make_array(1, 2, Circuit::divider, IdleRows::grounded);
  array.readout.row_segment_ohm = {30.0};
  const double first = 1.0 / (1000.0 + 200.0);
  const double second = 1.0 / (30.0 + 500.0 + 200.0);
  const double line = 1.0 / (1.0 + 20.0 * (first + second));
  const auto ratio = ratios(array, {1.0 / 1000.0, 1.0 / 500.0});
  EXPECT_NEAR(ratio[0], line * 200.0 * first, 1e-15);
  EXPECT_NEAR(ratio[1], line * 200.0 * second, 1e-15);
}

TEST(ReadoutCircuit, segment_of_a_column_line_stands_before_the_second_taxel) {
  ArrayDescription array = make_array(2, 1, Circuit::divider, IdleRows::grounded);
  array.readout.column_segment_ohm = {30.0};
  const double first = 1.0 / (1000.0 + 20.0);
  const double second = 1.0 / (500.0 + 20.0 + 30.0);
  const double total = first + second + 1.0 / 200.0;
  const auto ratio = ratios(array, {1.0 / 1000.0, 1.0 / 500.0});
  EXPECT_NEAR(ratio[0], first / total, 1e-15);
  EXPECT_NEAR(ratio[1], second / total, 1e-15);
}

void expect_same_readings(const std::vector<double>& readings, const std::vector<double>& expected) {
  for (std::size_t k = 0; k < expected.size(); ++k) {
    ASSERT_NEAR(readings[k], expected[k], 1e-12 * expected[k]) << "taxel " << k;
  }
}

TEST(ReadoutCircuit, fast_solution_of_the_grounded_divider_is_the_general_one_on_every_machine) {
  support::for_each_simd_target([] {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed);
      Random random(seed);
      const CircuitKind divider{"divider", Circuit::divider};
      ArrayDescription array = random_array(divider, 1 + random.below(64), 1 + random.below(64), random);
      array.readout.drive_ohm[0] = 0.0;
      array.readout.pressure_raises_reading = seed % 4 != 0;
      auto siemens = random_siemens(array.taxel_count(), random);
      siemens[random.below(siemens.size())] = 0.0;
      const auto fast = ratios(array, siemens);
      const std::vector<float> single_siemens(siemens.begin(), siemens.end());
      std::vector<float> single(siemens.size());
      ReadoutCircuit::create(array)->ratios(single_siemens, single);
      array.readout.row_segment_ohm.assign(array.rows, 0.0);  // the general solution
      const auto general = ratios(array, siemens);
      expect_same_readings(fast, general);
      for (std::size_t k = 0; k < single.size(); ++k) {
        ASSERT_NEAR(static_cast<double>(single[k]), general[k], 1e-5 * general[k]) << "taxel " << k;
      }
    }
  });
}

TEST(ReadoutCircuit, single_precision_readings_of_any_circuit_are_those_of_double) {
  constexpr std::uint64_t kSeed = 31;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  for (const CircuitKind& kind : kCircuitKinds) {
    SCOPED_TRACE(kind.name);
    Random random(kSeed);
    const ArrayDescription array = random_array(kind, 6, 5, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const std::vector<float> single_siemens(siemens.begin(), siemens.end());
    std::vector<float> single(siemens.size());
    ReadoutCircuit::create(array)->ratios(single_siemens, single);
    const auto expected = ratios(array, siemens);
    for (std::size_t k = 0; k < single.size(); ++k) {
      EXPECT_NEAR(static_cast<double>(single[k]), expected[k], 1e-5 * std::abs(expected[k])) << "taxel " << k;
    }
  }
}

TEST(ReadoutCircuit, fast_solution_allocates_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(1);
  const ArrayDescription array = random_array({"divider", Circuit::divider}, 16, 16, random);
  const auto siemens = random_siemens(array.taxel_count(), random);
  const auto circuit = ReadoutCircuit::create(array);
  std::vector<double> ratio(siemens.size());
  const support::AllocationGuard guard;
  circuit->ratios(siemens, ratio);
  EXPECT_EQ(guard.count(), 0U);
}

TEST(ReadoutCircuit, divider_is_an_amplifier_behind_a_switch_of_its_load) {
  constexpr std::uint64_t kSeed = 19;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
    Random random(kSeed);
    ArrayDescription array = random_array({"", Circuit::divider, idle_rows}, 6, 5, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto divider = ratios(array, siemens);
    array.readout.circuit = Circuit::transimpedance;
    array.readout.column_switch_ohm = array.readout.load_ohm;
    expect_same_readings(ratios(array, siemens), divider);
  }
}

TEST(ReadoutCircuit, readings_are_linear_in_the_offsets) {
  constexpr std::uint64_t kSeed = 20;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
    Random random(kSeed);
    ArrayDescription array =
        random_array({"", Circuit::transimpedance, idle_rows, IdleColumns::loaded, true}, 6, 5, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto once = ratios(array, siemens);
    for (double& offset : array.readout.amplifier_offset_v) offset *= 3.0;
    const auto thrice = ratios(array, siemens);
    array.readout.amplifier_offset_v.clear();
    const auto without = ratios(array, siemens);
    for (std::size_t i = 0; i < once.size(); ++i) {
      EXPECT_NEAR(thrice[i] - without[i], 3.0 * (once[i] - without[i]), 1e-13);
    }
  }
}

TEST(ReadoutCircuit, small_defects_tend_to_the_ideal_circuit) {
  constexpr std::uint64_t kSeed = 21;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  for (const CircuitKind& kind : kCircuitKinds) {
    SCOPED_TRACE(kind.name);
    Random random(kSeed);
    ArrayDescription array = random_array(kind, 6, 5, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto ideal = ratios(array, siemens);
    array.readout.row_segment_ohm.assign(array.rows, 0.0);
    array.readout.column_segment_ohm.assign(array.cols, 0.0);
    expect_same_readings(ratios(array, siemens), ideal);
    array.readout.row_segment_ohm.assign(array.rows, 1e-9);
    array.readout.column_segment_ohm.assign(array.cols, 1e-9);
    if (kind.circuit == Circuit::transimpedance && !kind.has_real_amplifiers) {
      array.readout.column_switch_ohm.assign(array.cols, 1e-9);
      array.readout.amplifier_offset_v.assign(array.cols, 1e-14);
      array.readout.amplifier_gain = 1e12;
    }
    const auto real = ratios(array, siemens);
    for (std::size_t i = 0; i < ideal.size(); ++i) EXPECT_NEAR(real[i] / ideal[i], 1.0, 1e-8);
  }
}

TEST(ReadoutCircuit, resistive_lines_lower_the_readings_towards_the_far_corner) {
  // Equal taxels read the same on lines without resistance, and less and less along lines with it.
  for (const CircuitKind& kind : kCircuitKinds) {
    if (kind.has_real_amplifiers) continue;
    SCOPED_TRACE(kind.name);
    ArrayDescription array = make_array(4, 4, kind.circuit, kind.idle_rows);
    array.readout.idle_columns = kind.idle_columns;
    array.readout.row_segment_ohm.assign(4, 5.0);
    array.readout.column_segment_ohm.assign(4, 5.0);
    const auto ratio = ratios(array, std::vector<double>(16, 1e-4));
    EXPECT_GT(ratio[array.index(0, 0)], ratio[array.index(3, 3)]);
    EXPECT_GT(ratio[array.index(3, 0)], ratio[array.index(3, 3)]);
    EXPECT_GT(ratio[array.index(0, 3)], ratio[array.index(3, 3)]);
  }
}

TEST(ReadoutCircuit, taxels_that_are_open_read_as_the_array_without_them) {
  // An array that is open but for the corner of r1c1 to r3c2 reads what that corner alone reads, and 0 elsewhere.
  constexpr std::uint64_t kSeed = 22;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  for (const CircuitKind& kind : kCircuitKinds) {
    if (kind.has_real_amplifiers) continue;
    SCOPED_TRACE(kind.name);
    Random random(kSeed);
    const ArrayDescription small = random_array(kind, 3, 2, random);
    const auto small_siemens = random_siemens(6, random);
    ArrayDescription large = make_array(5, 5, kind.circuit, kind.idle_rows);
    large.readout.idle_columns = kind.idle_columns;
    const bool is_flexitac = kind.circuit == Circuit::flexitac;
    std::copy(small.readout.drive_ohm.begin(), small.readout.drive_ohm.end(), large.readout.drive_ohm.begin() + 1);
    std::copy(small.readout.load_ohm.begin(), small.readout.load_ohm.end(), large.readout.load_ohm.begin() + 1);
    ASSERT_EQ(small.readout.drive_ohm.size(), is_flexitac ? 2U : 3U);
    std::vector<double> siemens(25, 0.0);
    std::vector<double> expected(25, 0.0);
    const auto small_ratio = ratios(small, small_siemens);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        siemens[large.index(i + 1, j + 1)] = small_siemens[small.index(i, j)];
        expected[large.index(i + 1, j + 1)] = small_ratio[small.index(i, j)];
      }
    }
    const auto ratio = ratios(large, siemens);
    for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(ratio[i], expected[i], 1e-15) << "reading " << i;
    for (const double reading : ratios(large, std::vector<double>(25, 0.0))) EXPECT_NEAR(reading, 0.0, 1e-90);
  }
}

TEST(ReadoutCircuit, refuses_a_circuit_that_is_not_known) {
  ArrayDescription array = make_array(2, 2, Circuit::divider, IdleRows::grounded);
  array.readout.load_ohm[1] = kFitOhm;
  EXPECT_EQ(ReadoutCircuit::create(array).error().kind, ErrorKind::bad_input);
  array.readout.circuit = Circuit::automatic;
  EXPECT_EQ(ReadoutCircuit::create(array).error().kind, ErrorKind::bad_input);
}

/// A folder of its own that goes away with the test.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() / ("dermis_" + std::to_string(std::random_device{}()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// An array as an ngspice netlist that scans itself: between the operating points `alter` moves the supply from driver
/// to driver and the load from line to line. A line that floats ends in 1e15 ohm.
class SpiceNetlist {
 public:
  SpiceNetlist(const ArrayDescription& array, const std::vector<double>& siemens, const std::vector<double>& newtons)
      : array_(array), readout_(array.readout) {
    text_ << std::setprecision(17) << "resistive array\n.options reltol=1e-12 vntol=1e-15 abstol=1e-18\n";
    if (readout_.circuit == Circuit::transimpedance) text_ << "vsupply supply 0 " << *readout_.supply_v << "\n";
    for (std::size_t i = 0; i < array.rows; ++i) {
      for (std::size_t j = 0; j < array.cols; ++j) {
        resistor("rt", i, j, row_node(i, j), col_node(i, j), 1.0 / siemens[array.index(i, j)]);
        if (j > 0 && row_segment_ohm(i) > 0.0) {
          resistor("ru", i, j, row_node(i, j - 1), row_node(i, j), row_segment_ohm(i));
        }
        if (i > 0 && column_segment_ohm(j) > 0.0) {
          resistor("rv", i, j, col_node(i - 1, j), col_node(i, j), column_segment_ohm(j));
        }
        if (!newtons.empty()) add_film(i, j, newtons);
      }
    }
    for (std::size_t line = 0; line < array.driven_lines(); ++line) add_driver(line);
    for (std::size_t line = 0; line < array.sensed_lines(); ++line) add_sink(line);
    add_scans();
  }

  [[nodiscard]] std::string text() const { return text_.str() + ".end\n"; }

 private:
  static constexpr double kOpenOhm = 1e15;

  [[nodiscard]] bool is_flexitac() const { return readout_.circuit == Circuit::flexitac; }
  [[nodiscard]] double row_segment_ohm(std::size_t row) const {
    return readout_.row_segment_ohm.empty() ? 0.0 : readout_.row_segment_ohm[row];
  }
  [[nodiscard]] double column_segment_ohm(std::size_t col) const {
    return readout_.column_segment_ohm.empty() ? 0.0 : readout_.column_segment_ohm[col];
  }
  [[nodiscard]] bool idle_drivers_float() const { return !is_flexitac() && readout_.idle_rows == IdleRows::floating; }
  [[nodiscard]] bool has_one_load() const { return is_flexitac() || readout_.idle_columns == IdleColumns::floating; }
  [[nodiscard]] double supply_v() const {
    return readout_.circuit == Circuit::transimpedance ? *readout_.supply_v : 1.0;
  }

  [[nodiscard]] std::string row_node(std::size_t i, std::size_t j) const {
    return "u" + std::to_string(i) + (row_segment_ohm(i) > 0.0 ? "_" + std::to_string(j) : "");
  }
  [[nodiscard]] std::string col_node(std::size_t i, std::size_t j) const {
    return "v" + std::to_string(j) + (column_segment_ohm(j) > 0.0 ? "_" + std::to_string(i) : "");
  }
  [[nodiscard]] std::string driven_node(std::size_t line) const {
    return is_flexitac() ? col_node(0, line) : row_node(line, 0);
  }
  [[nodiscard]] std::string sensed_node(std::size_t line) const {
    return is_flexitac() ? row_node(line, 0) : col_node(0, line);
  }

  void resistor(const char* kind, std::size_t i, std::size_t j, const std::string& a, const std::string& b,
                double ohm) {
    text_ << kind << i << "_" << j << " " << a << " " << b << " " << ohm << "\n";
  }

  /// Its own reading of the law: from the taxel to those before it.
  void add_film(std::size_t i, std::size_t j, const std::vector<double>& newtons) {
    const auto ohm = [&](std::size_t a, std::size_t b, std::size_t pairs) {
      const Film& film = *readout_.film;
      const double load = std::min((newtons[a] + newtons[b]) / 2.0, film.loaded_newtons) / film.loaded_newtons;
      const double change = 1.0 / film.loaded_ohm - 1.0 / film.unloaded_ohm;
      return 1.0 / (1.0 / film.unloaded_ohm / static_cast<double>(pairs) + change * std::pow(load, 0.9));
    };
    const std::size_t own = array_.index(i, j);
    if (i > 0) resistor("rx", i, j, row_node(i - 1, j), row_node(i, j), ohm(own - array_.cols, own, array_.cols));
    if (j > 0) resistor("ry", i, j, col_node(i, j - 1), col_node(i, j), ohm(own - 1, own, array_.rows));
  }

  void add_driver(std::size_t line) {
    text_ << "vd" << line << " s" << line << " 0 0\n"
          << "rd" << line << " s" << line << " " << driven_node(line) << " "
          << (idle_drivers_float() ? kOpenOhm : readout_.drive_ohm[line]) << "\n";
  }

  /// A load to ground, or an amplifier behind its switch: its feedback goes from the input to the output, which is at
  /// gain times (offset - input); one of infinite gain is a source that measures its current.
  void add_sink(std::size_t line) {
    if (has_one_load() && !readout_.column_switch_ohm.empty()) {
      text_ << "rl" << line << " " << sensed_node(line) << " m" << line << " " << kOpenOhm << "\n"
            << "rm" << line << " m" << line << " 0 " << readout_.load_ohm[line] << "\n";
      return;
    }
    if (readout_.circuit != Circuit::transimpedance) {
      text_ << "rl" << line << " " << sensed_node(line) << " 0 "
            << (has_one_load() ? kOpenOhm : readout_.load_ohm[line]) << "\n";
      return;
    }
    std::string input = sensed_node(line);
    if (!readout_.column_switch_ohm.empty()) {
      text_ << "rc" << line << " " << input << " n" << line << " " << readout_.column_switch_ohm[line] << "\n";
      input = "n" + std::to_string(line);
    }
    if (!readout_.amplifier_gain) {
      text_ << "vm" << line << " " << input << " 0 " << offset_v(line) << "\n";
      return;
    }
    text_ << "vo" << line << " p" << line << " 0 " << offset_v(line) << "\n"
          << "ea" << line << " o" << line << " 0 p" << line << " " << input << " " << *readout_.amplifier_gain << "\n"
          << "rf" << line << " " << input << " o" << line << " " << readout_.load_ohm[line] << "\n";
  }

  [[nodiscard]] double offset_v(std::size_t line) const {
    return readout_.amplifier_offset_v.empty() ? 0.0 : readout_.amplifier_offset_v[line];
  }

  void add_scans() {
    text_ << ".control\nset numdgt=16\n";
    for (std::size_t driven = 0; driven < array_.driven_lines(); ++driven) {
      text_ << "alter vd" << driven << " dc = " << supply_v() << "\n";
      const double drive_ohm = readout_.drive_ohm[driven];
      text_ << "alter rd" << driven << " = " << drive_ohm + readout_.supply_ohm.value_or(0.0) << "\n";
      has_one_load() ? scan_with_one_load() : scan_all_lines();
      text_ << "alter rd" << driven << " = " << (idle_drivers_float() ? kOpenOhm : drive_ohm) << "\n";
      text_ << "alter vd" << driven << " dc = 0\n";
    }
    text_ << "quit 0\n.endc\n";
  }

  void scan_with_one_load() {
    const bool has_switches = !readout_.column_switch_ohm.empty();
    for (std::size_t line = 0; line < array_.sensed_lines(); ++line) {
      const double closed_ohm = has_switches ? readout_.column_switch_ohm[line] : readout_.load_ohm[line];
      const std::string adc = has_switches ? "m" + std::to_string(line) : sensed_node(line);
      text_ << "alter rl" << line << " = " << closed_ohm << "\nop\nlet reading = v(" << adc
            << ")\nprint reading\ndestroy\nalter rl" << line << " = " << kOpenOhm << "\n";
    }
  }

  void scan_all_lines() {
    text_ << "op\n";
    for (std::size_t line = 0; line < array_.sensed_lines(); ++line) {
      text_ << "let reading = " << reading(line) << "\nprint reading\n";
    }
    text_ << "destroy\n";
  }

  [[nodiscard]] std::string reading(std::size_t line) const {
    const std::string number = std::to_string(line);
    if (readout_.circuit != Circuit::transimpedance) return "v(" + sensed_node(line) + ")";
    std::ostringstream text;
    text << std::setprecision(17);
    if (readout_.amplifier_gain) {
      text << "-v(o" << number << ")/" << supply_v();
    } else {
      text << "(i(vm" << number << ")*" << readout_.load_ohm[line] << "-" << offset_v(line) << ")/" << supply_v();
    }
    return text.str();
  }

  const ArrayDescription& array_;
  const Readout& readout_;
  std::ostringstream text_;
};

/// The readings [rows, cols] as ngspice computes them.
std::vector<double> simulate_with_ngspice(const ArrayDescription& array, const std::vector<double>& siemens,
                                          const std::vector<double>& newtons = {}) {
  const TemporaryFolder folder;
  const auto circuit = folder.path() / "array.cir";
  const auto output = folder.path() / "array.out";
  std::ofstream(circuit) << SpiceNetlist(array, siemens, newtons).text();
  const std::string command = "ngspice -b '" + circuit.string() + "' > '" + output.string() + "' 2> /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::vector<double> scans;
  std::ifstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("reading = ")) scans.push_back(std::stod(line.substr(line.find('=') + 1)));
  }
  if (array.readout.circuit != Circuit::flexitac || scans.size() != array.taxel_count()) return scans;
  std::vector<double> readings(scans.size());
  for (std::size_t i = 0; i < array.rows; ++i) {
    for (std::size_t j = 0; j < array.cols; ++j) readings[array.index(i, j)] = scans[j * array.rows + i];
  }
  return readings;
}

using SpiceCase = std::tuple<CircuitKind, bool, std::size_t>;

class AgainstNgspice : public testing::TestWithParam<SpiceCase> {};

TEST_P(AgainstNgspice, agrees_within_one_part_in_a_billion) {
  if (std::system("command -v ngspice > /dev/null") != 0) GTEST_SKIP() << "ngspice is not on the PATH";
  constexpr std::uint64_t kSeed = 16;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  const auto [kind, has_segments, size] = GetParam();
  ArrayDescription array = random_array(kind, size, size, random);
  if (has_segments) add_segments(array, random);
  const auto siemens = random_siemens(array.taxel_count(), random);
  const auto expected = simulate_with_ngspice(array, siemens);
  const auto ratio = ratios(array, siemens);
  ASSERT_EQ(expected.size(), ratio.size());
  for (std::size_t i = 0; i < ratio.size(); ++i) EXPECT_NEAR(ratio[i] / expected[i], 1.0, 1e-9) << "reading " << i;
}

/// Forces of up to 60 N on a third of the taxels, below which no film conducts more.
TEST(Film, agrees_with_ngspice_in_every_circuit) {
  if (std::system("command -v ngspice > /dev/null") != 0) GTEST_SKIP() << "ngspice is not on the PATH";
  constexpr std::uint64_t kSeed = 23;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (const CircuitKind& kind : kCircuitKinds) {
    for (const bool has_segments : {false, true}) {
      SCOPED_TRACE(testing::Message() << kind.name << (has_segments ? ", resistive lines" : ""));
      ArrayDescription array = random_array(kind, 7, 9, random);
      if (has_segments) add_segments(array, random);
      array.readout.film = Film{50e3, 2e3, 20.0};
      const auto siemens = random_siemens(array.taxel_count(), random);
      std::vector<double> newtons(siemens.size());
      for (double& force : newtons) force = random.below(3) == 0 ? random.uniform(0.0, 60.0) : 0.0;
      const auto expected = simulate_with_ngspice(array, siemens, newtons);
      std::vector<double> ratio(siemens.size());
      ReadoutCircuit::create(array)->ratios(siemens, newtons, ratio);
      ASSERT_EQ(expected.size(), ratio.size());
      for (std::size_t i = 0; i < ratio.size(); ++i) EXPECT_NEAR(ratio[i] / expected[i], 1.0, 1e-9) << "reading " << i;
    }
  }
}

TEST(Film, is_unloaded_without_forces) {
  Random random(24);
  for (const CircuitKind& kind : kCircuitKinds) {
    SCOPED_TRACE(testing::Message() << kind.name << ", seed 24");
    ArrayDescription array = random_array(kind, 4, 5, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto without = ratios(array, siemens);
    array.readout.film = Film{5e3, 1e3, 20.0};
    const auto unloaded = ratios(array, siemens);
    array.readout.film = Film{5e3, 5e3, 20.0};
    std::vector<double> constant(siemens.size());
    ReadoutCircuit::create(array)->ratios(siemens, std::vector<double>(siemens.size(), 10.0), constant);
    EXPECT_EQ(unloaded, constant);
    EXPECT_NE(unloaded, without);
  }
}

TEST(Film, stays_beside_faults_of_lines) {
  Random random(25);
  for (const CircuitKind& kind : kCircuitKinds) {
    if (kind.has_real_amplifiers) continue;
    SCOPED_TRACE(testing::Message() << kind.name << ", seed 25");
    ArrayDescription array = random_array(kind, 4, 5, random);
    array.readout.film = Film{5e3, 1e3, 20.0};
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto newtons = random_list(siemens.size(), 0.0, 30.0, random);
    std::vector<double> healthy(siemens.size());
    std::vector<double> faulty(siemens.size());
    ReadoutCircuit::create(array)->ratios(siemens, newtons, healthy);
    FaultyCircuit::create(array, {}).value().ratios(siemens, newtons, 0, faulty);
    for (std::size_t i = 0; i < healthy.size(); ++i) EXPECT_NEAR(faulty[i] / healthy[i], 1.0, 1e-9) << "reading " << i;
  }
}

/// While a line is driven, its source stands behind the supply's own resistance; sensed lines have switches of their
/// own where they share a load.
TEST(Instrument, supply_and_switches_agree_with_ngspice_in_every_circuit) {
  if (std::system("command -v ngspice > /dev/null") != 0) GTEST_SKIP() << "ngspice is not on the PATH";
  constexpr std::uint64_t kSeed = 18;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (const CircuitKind& kind : kCircuitKinds) {
    SCOPED_TRACE(kind.name);
    ArrayDescription array = random_array(kind, 8, 6, random);
    array.readout.amplifier_offset_v.clear();
    array.readout.supply_ohm = random.uniform(2.0, 40.0);
    const bool has_one_load = kind.circuit == Circuit::flexitac || kind.idle_columns == IdleColumns::floating;
    if (has_one_load) array.readout.column_switch_ohm = random_list(array.sensed_lines(), 20.0, 200.0, random);
    const auto siemens = random_siemens(array.taxel_count(), random);
    const auto expected = simulate_with_ngspice(array, siemens);
    const auto ratio = ratios(array, siemens);
    ASSERT_EQ(expected.size(), ratio.size());
    for (std::size_t i = 0; i < ratio.size(); ++i) EXPECT_NEAR(ratio[i] / expected[i], 1.0, 1e-9) << "reading " << i;
  }
}

/// ngspice has a resistor of 10 nanoohm there.
TEST(ShortedCrossing, agrees_with_ngspice_in_every_circuit) {
  if (std::system("command -v ngspice > /dev/null") != 0) GTEST_SKIP() << "ngspice is not on the PATH";
  constexpr std::uint64_t kSeed = 17;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (const CircuitKind& kind : kCircuitKinds) {
    if (kind.has_real_amplifiers) continue;
    SCOPED_TRACE(kind.name);
    const ArrayDescription array = random_array(kind, 8, 8, random);
    auto siemens = random_siemens(array.taxel_count(), random);
    LineFaults faults;
    faults.shorted_taxels = {"r2c5", "r6c1"};
    std::vector<double> ratio(siemens.size());
    FaultyCircuit::create(array, faults).value().ratios(siemens, 0, ratio);
    siemens[array.index(2, 5)] = siemens[array.index(6, 1)] = 1e8;
    const auto expected = simulate_with_ngspice(array, siemens);
    ASSERT_EQ(expected.size(), ratio.size());
    for (std::size_t i = 0; i < ratio.size(); ++i) {
      EXPECT_NEAR(ratio[i], expected[i], 1e-4 * std::abs(expected[i]) + 1e-7) << "reading " << i;
    }
  }
}

std::string name_of(const testing::TestParamInfo<SpiceCase>& info) {
  const auto& [kind, has_segments, size] = info.param;
  const std::string side = std::to_string(size);
  return std::string(kind.name) + (has_segments ? "_resistive_lines_" : "_") + side + "x" + side;
}

INSTANTIATE_TEST_SUITE_P(ReadoutCircuit, AgainstNgspice,
                         testing::Combine(testing::ValuesIn(kCircuitKinds), testing::Bool(), testing::Values(8U, 16U)),
                         name_of);

}  // namespace
}  // namespace dermis::learn::simulation
