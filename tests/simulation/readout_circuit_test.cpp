// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/simulation/readout_circuit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "dermis/core/random.hpp"

namespace dermis::simulation {
namespace {

ArrayDescription make_array(std::size_t rows, std::size_t cols, Circuit circuit, IdleRows idle_rows) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  array.readout.circuit = circuit;
  array.readout.idle_rows = idle_rows;
  array.readout.drive_ohm.assign(rows, 20.0);
  array.readout.load_ohm.assign(cols, 200.0);
  return array;
}

void scatter_resistors(ArrayDescription& array, Random& random) {
  for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(1.0, 100.0);
  for (double& ohm : array.readout.load_ohm) ohm = random.log_uniform(50.0, 10e3);
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

TEST(ReadoutCircuit, SingleTaxelIsAVoltageDivider) {
  for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
    const ArrayDescription array = make_array(1, 1, Circuit::divider, idle_rows);
    EXPECT_NEAR(ratios(array, {1e-3})[0], 200.0 / (20.0 + 1000.0 + 200.0), 1e-15);
  }
}

TEST(ReadoutCircuit, PressureThatLowersTheReadingGivesTheComplement) {
  ArrayDescription array = make_array(1, 1, Circuit::divider, IdleRows::grounded);
  array.readout.pressure_raises_reading = false;
  EXPECT_NEAR(ratios(array, {1e-3})[0], 1.0 - 200.0 / 1220.0, 1e-15);
}

TEST(ReadoutCircuit, UnknownCircuitReadsConductanceWithoutCrosstalk) {
  ArrayDescription array = make_array(2, 2, Circuit::none, IdleRows::grounded);
  array.readout.drive_ohm.clear();
  array.readout.load_ohm.clear();
  EXPECT_EQ(ratios(array, {1e-3, 2e-3, 0.0, 4e-3}), (std::vector<double>{0.1, 0.2, 0.0, 0.4}));
}

TEST(ReadoutCircuit, FloatingTwoByTwoIsTheSeriesParallelCircuit) {
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

TEST(ReadoutCircuit, FloatingRowWithoutConductanceReadsZero) {
  const ArrayDescription array = make_array(2, 1, Circuit::divider, IdleRows::floating);
  const auto ratio = ratios(array, {0.0, 1e-3});
  EXPECT_EQ(ratio[0], 0.0);
  EXPECT_NEAR(ratio[1], 200.0 / 1220.0, 1e-15);
}

TEST(ReadoutCircuit, AgreesWithTheWholeNodalSystem) {
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

TEST(ReadoutCircuit, GroundedDividerIsTheClosedForm) {
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

TEST(ReadoutCircuit, ReciprocityHoldsWhenTheArrayIsReadAcross) {
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

TEST(ReadoutCircuit, DriversOfZeroOhmAreTheLimitOfSmallOnes) {
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

TEST(ReadoutCircuit, TransimpedanceIsUndoneByTheRowDroopFormula) {
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

TEST(ReadoutCircuit, LargeArraysObeyKirchhoff) {
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

TEST(ReadoutCircuit, RefusesAnArrayWithoutItsResistors) {
  ArrayDescription array = make_array(2, 2, Circuit::divider, IdleRows::grounded);
  array.readout.load_ohm.clear();
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

/// One copy of the array per driven row: copy k has the lines u<k>_<i> and v<k>_<j> and a supply of 1 V. A virtual
/// ground is a source of 0 V that measures its current.
std::string netlist(const ArrayDescription& array, const std::vector<double>& siemens) {
  const bool virtual_ground = array.readout.circuit == Circuit::transimpedance;
  std::ostringstream text;
  text << std::setprecision(17) << "resistive array\n.options reltol=1e-12 vntol=1e-15 abstol=1e-18\nvdd supply 0 1\n";
  std::string wanted;
  for (std::size_t k = 0; k < array.rows; ++k) {
    const std::string copy = std::to_string(k) + "_";
    for (std::size_t i = 0; i < array.rows; ++i) {
      const std::string line = copy + std::to_string(i);
      if (i == k || array.readout.idle_rows == IdleRows::grounded) {
        const char* const driver = i == k ? " supply u" : " 0 u";
        text << "rd" << line << driver << line << " " << array.readout.drive_ohm[i] << "\n";
      }
      for (std::size_t j = 0; j < array.cols; ++j) {
        text << "rt" << line << "_" << j << " u" << line << " v" << copy << j << " " << 1.0 / siemens[array.index(i, j)]
             << "\n";
      }
    }
    for (std::size_t j = 0; j < array.cols; ++j) {
      const std::string column = copy + std::to_string(j);
      if (virtual_ground) {
        text << "vm" << column << " v" << column << " 0 0\n";
        wanted += "print i(vm" + column + ")\n";
      } else {
        text << "rl" << column << " v" << column << " 0 " << array.readout.load_ohm[j] << "\n";
        wanted += "print v(v" + column + ")\n";
      }
    }
  }
  text << ".control\nset numdgt=15\nop\n" << wanted << "quit 0\n.endc\n.end\n";
  return text.str();
}

/// The readings as ngspice computes them: column voltages, or the currents into virtual grounds times the feedback.
std::vector<double> simulate_with_ngspice(const ArrayDescription& array, const std::vector<double>& siemens) {
  const TemporaryFolder folder;
  const auto circuit = folder.path() / "array.cir";
  const auto output = folder.path() / "array.out";
  std::ofstream(circuit) << netlist(array, siemens);
  const std::string command = "ngspice -b '" + circuit.string() + "' > '" + output.string() + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::vector<double> readings;
  std::ifstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const bool is_voltage = line.starts_with("v(v");
    if (!is_voltage && !line.starts_with("i(vm")) continue;
    const double ohm = is_voltage ? 1.0 : array.readout.load_ohm[readings.size() % array.cols];
    readings.push_back(ohm * std::stod(line.substr(line.find('=') + 1)));
  }
  return readings;
}

struct SpiceCase {
  const char* name;
  Circuit circuit;
  IdleRows idle_rows;
};

class AgainstNgspice : public testing::TestWithParam<SpiceCase> {};

TEST_P(AgainstNgspice, AgreesWithinOnePartInAMillion) {
  if (std::system("command -v ngspice > /dev/null") != 0) GTEST_SKIP() << "ngspice is not on the PATH";
  constexpr std::uint64_t kSeed = 16;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  ArrayDescription array = make_array(8, 8, GetParam().circuit, GetParam().idle_rows);
  scatter_resistors(array, random);
  const auto siemens = random_siemens(array.taxel_count(), random);
  const auto expected = simulate_with_ngspice(array, siemens);
  const auto ratio = ratios(array, siemens);
  ASSERT_EQ(expected.size(), ratio.size());
  for (std::size_t i = 0; i < ratio.size(); ++i) EXPECT_NEAR(ratio[i] / expected[i], 1.0, 1e-6) << "reading " << i;
}

INSTANTIATE_TEST_SUITE_P(
    ReadoutCircuit, AgainstNgspice,
    testing::Values(SpiceCase{"divider_grounded", Circuit::divider, IdleRows::grounded},
                    SpiceCase{"divider_floating", Circuit::divider, IdleRows::floating},
                    SpiceCase{"transimpedance_grounded", Circuit::transimpedance, IdleRows::grounded},
                    SpiceCase{"transimpedance_floating", Circuit::transimpedance, IdleRows::floating}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace dermis::simulation
